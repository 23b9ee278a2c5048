#include "flow_rate.hpp"

#include <cstddef>

namespace rouleau::core {

namespace {

/// What the sum of a profile between walls misses of its integral.
double end_correction(const std::vector<double>& profile, double lower_wall, double upper_wall) {
  // Slopes at the walls of parabolas through the wall and the two rows nearest to it, rows at 1/2 and 3/2.
  const auto slope = [](double wall, double first, double second) { return -8 * wall / 3 + 3 * first - second / 3; };
  const std::size_t last = profile.size() - 1;
  const double lower = slope(lower_wall, profile[0], profile[1]);
  const double upper = -slope(upper_wall, profile[last], profile[last - 1]);
  return (upper - lower) / 24;
}

}  // namespace

template <int D>
double flow_rate(const std::vector<double>& row_velocities, const WallVelocity& walls, const Domain<D>& domain,
                 bool solid) {
  double sum = 0;
  for (const double velocity : row_velocities) sum += velocity;
  const double of_sum = static_cast<double>(domain.size[0]) / domain.size[domain.flow_axis()];
  if (solid) return of_sum * sum;
  const auto rows = static_cast<int>(row_velocities.size());
  double corrected = sum;
  for (int axis = 1, apart = 1; axis < D; apart *= domain.size[axis++]) {
    if (!domain.walled(axis)) continue;
    // The velocity by the place along this axis, summed over the other one.
    const int size = domain.size[axis];
    std::vector<double> profile(static_cast<std::size_t>(size));
    for (int i = 0; i < rows; ++i) profile[i / apart % size] += row_velocities[i];
    const int others = rows / size;
    corrected += end_correction(profile, axis == 1 ? others * walls.lower : 0, axis == 1 ? others * walls.upper : 0);
  }
  return of_sum * corrected;
}

template double flow_rate(const std::vector<double>&, const WallVelocity&, const Domain<2>&, bool);
template double flow_rate(const std::vector<double>&, const WallVelocity&, const Domain<3>&, bool);

}  // namespace rouleau::core
