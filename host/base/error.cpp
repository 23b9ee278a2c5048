#include "error.hpp"

#include <algorithm>
#include <string_view>

#include "text.hpp"

namespace rouleau {

namespace {

/// Escapes control characters but for the ends of lines.
std::string safe_lines(const std::string& message) {
  std::string safe;
  for (std::size_t at = 0; at <= message.size();) {
    const std::size_t end = std::min(message.find('\n', at), message.size());
    safe += (at == 0 ? "" : "\n") + printable(std::string_view(message).substr(at, end - at));
    at = end + 1;
  }
  return safe;
}

std::string words_of(const std::string& problem, const Remedy& remedy) {
  return safe_lines(remedy.words.empty() ? problem : problem + "\n  " + remedy.words);
}

std::string message(const Place& place, const std::string& words) {
  const std::string where = to_string(place);
  return where.empty() ? words : where + "\n  " + words;
}

}  // namespace

std::string to_string(const Place& place) {
  std::string text = printable(place.file);
  if (place.line > 0) {
    text += ':' + std::to_string(place.line);
    if (place.column > 0) text += ':' + std::to_string(place.column);
  }
  if (!place.pointer.empty()) text += (text.empty() ? "" : " ") + printable(place.pointer);
  return text;
}

Error::Error(Cause cause, const Place& place, const std::string& problem, const Remedy& remedy)
    : std::runtime_error(message(place, words_of(problem, remedy))),
      cause_(cause),
      place_(place),
      problem_(problem),
      remedy_(remedy) {}

std::string Error::words() const { return words_of(problem_, remedy_); }

}  // namespace rouleau
