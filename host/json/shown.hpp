// How a JSON value is written in messages, and a number that JSON may not be able to hold.
#pragma once

#include <cmath>
#include <string>

#include "base/text.hpp"
#include "json.hpp"

namespace rouleau::json {

/// JSON has neither infinity nor NaN: what is undefined is null.
inline nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

/// A JSON value as one would write it, shortened when long.
inline std::string shown(const nlohmann::json& value) {
  if (value.is_string()) return in_quotes(value.get_ref<const std::string&>());
  return shortened(printable(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

}  // namespace rouleau::json
