#include "study_target.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"

namespace rouleau::study {

StudyTarget read_target(const std::string& text, const std::vector<Quantity>& quantities) {
  const auto refuse = [&](const std::string& problem) {
    throw Error(Cause::bad_input, "the target " + in_quotes(text) + ": " + problem);
  };
  // A name may hold an '=', a number does not.
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) refuse("wants NAME=VALUE, for example deformation=1%");
  const std::string name = text.substr(0, equals);
  std::vector<std::string> names;
  names.reserve(quantities.size());
  for (const Quantity& quantity : quantities) names.push_back(quantity.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    refuse("the study measures no " + in_quotes(name) + did_you_mean(name, names) + "; it measures " + listed(names));
  const auto index = static_cast<std::size_t>(found - names.begin());
  const Quantity& quantity = quantities[index];

  double error = NAN;
  const char *begin = text.data() + equals + 1, *end = text.data() + text.size();
  const auto [rest, fault] = std::from_chars(begin, end, error);
  const std::string unit(std::find_if(rest, end, [](char c) { return c != ' '; }), end);
  const bool relative = quantity.error == ErrorKind::relative;
  if (relative && unit == "%") error /= 100;
  const bool known_unit = unit.empty() || unit == (relative ? "%" : quantity.unit);
  if (fault != std::errc() || !known_unit || !(error > 0) || !std::isfinite(error))
    refuse(std::string("wants an error above zero, ") +
           (relative ? "as 1% or 0.01" : "as 0.5" + (quantity.unit.empty() ? "" : ' ' + quantity.unit)));
  return {index, error};
}

}  // namespace rouleau::study
