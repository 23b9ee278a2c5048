#include "error.hpp"

#include "wording.hpp"

namespace rouleau::host {

std::string to_string(const Place& place) {
  std::string text = printable(place.file);
  if (place.line > 0) {
    text += ':' + std::to_string(place.line);
    if (place.column > 0) text += ':' + std::to_string(place.column);
  }
  if (!place.pointer.empty()) text += (text.empty() ? "" : " ") + printable(place.pointer);
  return text;
}

}  // namespace rouleau::host
