#include "error.hpp"

#include "text.hpp"

namespace rouleau {

namespace {

std::string words_of(const std::string& problem, const Remedy& remedy) {
  return printable_lines(remedy.words.empty() ? problem : problem + "\n  " + remedy.words);
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
