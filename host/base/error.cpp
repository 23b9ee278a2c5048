#include "error.hpp"

#include <algorithm>
#include <utility>

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

/// Finding a place takes a walk through the text, and nobody reads as many.
constexpr std::size_t most_kept = 200;

std::string message_of_all(const std::vector<Error>& faults, bool at_least) {
  std::string message;
  const std::size_t shown = std::min(faults.size(), SeveralFaults::most_shown);
  for (std::size_t i = 0; i < shown; ++i) message += (i == 0 ? "" : "\n") + std::string(faults[i].what());
  const std::size_t more = faults.size() - shown;
  if (more == 0) return message;
  return message + "\nand " + (at_least ? "at least " : "") + std::to_string(more) +
         (more == 1 ? " fault" : " faults") + " more";
}

bool stands_before(const Error& a, const Error& b) {
  const Place &p = a.place(), &q = b.place();
  if ((p.line > 0) != (q.line > 0)) return p.line > 0;
  return std::pair(p.line, p.column) < std::pair(q.line, q.column);
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

SeveralFaults::SeveralFaults(std::vector<Error> faults, bool at_least)
    : Error(faults.front()),
      faults_(std::move(faults)),
      at_least_(at_least),
      message_(message_of_all(faults_, at_least)) {}

SeveralFaults SeveralFaults::with(const std::function<Error(const Error&)>& other) const {
  std::vector<Error> faults;
  for (const Error& fault : faults_) faults.push_back(other(fault));
  return {std::move(faults), at_least_};
}

void throw_as(const Error& fault, const std::function<Error(const Error&)>& other) {
  if (const auto* several = dynamic_cast<const SeveralFaults*>(&fault)) throw several->with(other);
  throw other(fault);
}

void Faults::add(const Error& fault) {
  const auto* several = dynamic_cast<const SeveralFaults*>(&fault);
  // When there are too many, whoever else collects along the way may give them back.
  if (faults_.size() < most_kept) {
    if (several != nullptr)
      faults_.insert(faults_.end(), several->faults().begin(), several->faults().end());
    else
      faults_.push_back(fault);
  }
  if (faults_.size() >= most_kept) raise_all(true);
}

void Faults::raise_all(bool at_least) const {
  if (faults_.empty()) return;
  std::vector<Error> sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(), stands_before);
  if (sorted.size() == 1) throw Error(sorted.front());
  throw SeveralFaults(std::move(sorted), at_least);
}

}  // namespace rouleau
