#include "walls.hpp"

namespace rouleau::core {

template <class T>
void add_wall_momentum(Lattice<T, D2Q9>& lattice, int y, const WallVelocity& walls) {
  const auto add = [&](int normal, double speed) {
    if (speed == 0) return;
    d2q9::for_each_velocity([&](auto q) {
      const int along = d2q9::velocity[q][0];
      if (d2q9::velocity[q][1] != normal || along == 0) return;
      const T momentum = static_cast<T>(6 * d2q9::weight[q] * along * speed);
      T* slot = lattice.slot(q, {y});
      for (int x = 0; x < lattice.size(0); ++x) slot[x] += momentum;
    });
  };
  if (y == 0 && lattice.domain().wall_below(1)) add(+1, walls.lower);
  if (y == lattice.size(1) - 1 && lattice.domain().wall_above(1)) add(-1, walls.upper);
}

template void add_wall_momentum<float>(Lattice<float, D2Q9>&, int, const WallVelocity&);
template void add_wall_momentum<double>(Lattice<double, D2Q9>&, int, const WallVelocity&);

}  // namespace rouleau::core
