#include "flow_rate.hpp"

#include <cstddef>

namespace rouleau::core {

double flow_rate(const std::vector<double>& row_velocities, const WallVelocity& walls, bool periodic) {
  double sum = 0;
  for (const double velocity : row_velocities) sum += velocity;
  if (periodic) return sum;
  // Slopes at the walls of parabolas through the wall and the two rows nearest to it, rows at 1/2 and 3/2.
  const auto slope = [](double wall, double first, double second) { return -8 * wall / 3 + 3 * first - second / 3; };
  const std::size_t last = row_velocities.size() - 1;
  const double lower = slope(walls.lower, row_velocities[0], row_velocities[1]);
  const double upper = -slope(walls.upper, row_velocities[last], row_velocities[last - 1]);
  return sum + (upper - lower) / 24;
}

}  // namespace rouleau::core
