#include "shown.hpp"

#include "base/text.hpp"

namespace rouleau::json {

std::string shown(const nlohmann::json& value) {
  if (value.is_string()) return in_quotes(value.get_ref<const std::string&>());
  return shortened(printable(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

}  // namespace rouleau::json
