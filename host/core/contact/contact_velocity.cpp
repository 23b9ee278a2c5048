#include "contact_velocity.hpp"

#include <cmath>

namespace rouleau::core {

void ContactVelocities::measure(const ContactList& list, const std::vector<NeighbourList::Pair>& pairs,
                                const Membranes& membranes) {
  const auto count = static_cast<std::size_t>(list.count);
  normal.resize(count);
  tangential.resize(count);
  sliding.resize(count);
  const std::vector<double>&u = membranes.velocity[0], &v = membranes.velocity[1];
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const CellRange& other = membranes.cells[pairs[p].other];
    for (auto i = static_cast<std::size_t>(list.ranges[p].begin); i < static_cast<std::size_t>(list.ranges[p].end);
         ++i) {
      const auto node = static_cast<std::size_t>(list.node[i]), begin = static_cast<std::size_t>(list.segment[i]);
      const std::size_t end = list.segment[i] + 1 == other.end() ? static_cast<std::size_t>(other.first) : begin + 1;
      const double along = list.along[i];
      const double du = u[node] - ((1 - along) * u[begin] + along * u[end]);
      const double dv = v[node] - ((1 - along) * v[begin] + along * v[end]);
      const double nx = list.direction_x[i], ny = list.direction_y[i];  // from the other cell to this one
      normal[i] = du * nx + dv * ny;
      tangential[i] = du * ny - dv * nx;
      sliding[i] = std::abs(tangential[i]);
    }
  }
}

}  // namespace rouleau::core
