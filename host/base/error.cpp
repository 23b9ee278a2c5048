#include "error.hpp"

#include <algorithm>
#include <string_view>

#include "text.hpp"

namespace rouleau {

std::string to_string(const Place& place) {
  std::string text = printable(place.file);
  if (place.line > 0) {
    text += ':' + std::to_string(place.line);
    if (place.column > 0) text += ':' + std::to_string(place.column);
  }
  if (!place.pointer.empty()) text += (text.empty() ? "" : " ") + printable(place.pointer);
  return text;
}

std::string safe_lines(const std::string& message) {
  std::string safe;
  for (std::size_t at = 0; at <= message.size();) {
    const std::size_t end = std::min(message.find('\n', at), message.size());
    safe += (at == 0 ? "" : "\n") + printable(std::string_view(message).substr(at, end - at));
    at = end + 1;
  }
  return safe;
}

}  // namespace rouleau
