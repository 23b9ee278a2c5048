#include "history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rouleau::study {

Dissociation dissociation(const std::vector<CountChange>& changes, const Column& output_strain, double start_time,
                          double start_strain, int count, bool for_good) {
  constexpr double not_a_value = std::numeric_limits<double>::quiet_NaN();
  double found = not_a_value;  // over all stages, as in the tables
  bool at_start = false;
  for (const CountChange& change : changes) {
    const bool enough = change.count >= count;
    if (change.time <= start_time) {
      at_start = enough;
    } else if (!enough && for_good) {
      found = not_a_value;
      at_start = false;  // they met: what was apart when shear began can come apart
    } else if (enough && std::isnan(found)) {
      found = change.strain;
    }
  }
  if (at_start) return {not_a_value, not_a_value, true};
  double before = start_strain;
  for (const double strain : output_strain)
    if (strain < found) before = std::max(before, strain);
  return {found - start_strain, found - before, false};
}

}  // namespace rouleau::study
