#include "frame_choice.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "base/error.hpp"

namespace rouleau::report {

namespace {

constexpr double same_strain = 1e-9;

std::size_t nearest(const std::vector<double>& strains, double wanted) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < strains.size(); ++i)
    if (std::abs(strains[i] - wanted) <= std::abs(strains[best] - wanted) + same_strain) best = i;
  return best;
}

std::string text(double value) {
  std::ostringstream words;
  words << value;
  return words.str();
}

}  // namespace

bool OutputTimes::sheared() const {
  return !strain.empty() && *std::max_element(strain.begin(), strain.end()) > strain.front() + same_strain;
}

std::vector<std::size_t> outputs_at(const OutputTimes& outputs, const std::vector<double>& strains) {
  if (!outputs.sheared())
    throw Error(Cause::bad_input, "the strain does not grow in this run",
                {"let its frames be chosen by time, and name no strain"});
  std::set<std::size_t> chosen;
  for (const double strain : strains) {
    const std::size_t i = nearest(outputs.strain, strain);
    // Outputs come at the first step at or after their time: what was asked may lie half an interval away.
    const double before = i > 0 ? outputs.strain[i] - outputs.strain[i - 1] : 0;
    const bool beyond = strain < outputs.strain.front() - same_strain ||
                        (i + 1 == outputs.strain.size() && strain > outputs.strain[i] + std::max(before, 1e-3) / 2);
    if (beyond)
      throw Error(Cause::bad_input, "the run has no strain " + text(strain) + "; its strains go from " +
                                        text(outputs.strain.front()) + " to " + text(outputs.strain.back()));
    chosen.insert(i);
  }
  return {chosen.begin(), chosen.end()};
}

std::vector<std::size_t> even_outputs(const OutputTimes& outputs, std::size_t count) {
  std::set<std::size_t> chosen;
  const std::size_t total = outputs.time_s.size();
  if (total == 0) return {};
  const double first = outputs.strain.front(), last = outputs.strain.back();
  for (std::size_t k = 0; k < count; ++k) {
    const double share = count > 1 ? double(k) / double(count - 1) : 0;
    chosen.insert(outputs.sheared() ? nearest(outputs.strain, first + share * (last - first))
                                    : static_cast<std::size_t>(std::lround(share * double(total - 1))));
  }
  return {chosen.begin(), chosen.end()};
}

}  // namespace rouleau::report
