#include "walls.hpp"

namespace rouleau::core {

template <class T, class Set>
void add_wall_momentum(Lattice<T, Set>& lattice, int i, const typename Lattice<T, Set>::Row& row,
                       const WallVelocity& walls) {
  const auto add = [&](int normal, double speed) {
    if (speed == 0) return;
    Set::for_each_velocity([&](auto q) {
      const int along = Set::velocity[q][0];
      if (Set::velocity[q][1] != normal || along == 0) return;
      const T momentum = static_cast<T>(6 * Set::weight[q] * along * speed);
      lattice.for_pieces(i, [&](const RowPiece& piece, std::size_t) {
        T* slot = lattice.slot(q, row, piece.begin);
        for (int x = piece.begin; x < piece.end; ++x) slot[x] += momentum;
      });
    });
  };
  if (row[0] == 0 && lattice.domain().wall_below(1)) add(+1, walls.lower);
  if (row[0] == lattice.size(1) - 1 && lattice.domain().wall_above(1)) add(-1, walls.upper);
}

#define ROULEAU_INSTANTIATE(T, Set) \
  template void add_wall_momentum(Lattice<T, Set>&, int, const Lattice<T, Set>::Row&, const WallVelocity&);
ROULEAU_INSTANTIATE(float, D2Q9)
ROULEAU_INSTANTIATE(double, D2Q9)
ROULEAU_INSTANTIATE(float, D3Q19)
ROULEAU_INSTANTIATE(double, D3Q19)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::core
