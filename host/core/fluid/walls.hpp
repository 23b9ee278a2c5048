// Solid walls along an axis across x: half-way bounce-back. Those below and above, along y, may move along x.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/domain/exact_sum.hpp"
#include "core/domain/ranks.hpp"
#include "field.hpp"
#include "lattice.hpp"

namespace rouleau::core {

/// Velocity along x of the walls across y, lattice units. Not used when y is periodic. Walls across z stand still.
struct WallVelocity {
  double lower = 0, upper = 0;
};

/// Forces on the walls across y, and on all others: walls across z and solid nodes. Lattice units.
template <int D>
struct WallForces {
  std::array<double, D> lower{}, upper{}, other{};

  WallForces& operator+=(const WallForces& more) {
    for (int k = 0; k < D; ++k) lower[k] += more.lower[k], upper[k] += more.upper[k], other[k] += more.other[k];
    return *this;
  }
  [[nodiscard]] double all(int axis) const { return lower[axis] + upper[axis] + other[axis]; }
};

/// Sums of what many nodes do to walls, on any ranks.
template <int D>
class WallForceSums {
 public:
  enum Wall { lower, upper, other };
  void add(Wall wall, int axis, double force) { sums_[static_cast<std::size_t>(wall * D + axis)].add(force); }
  [[nodiscard]] WallForces<D> total(const Ranks<D>& ranks) {
    add_up(ranks, sums_);
    WallForces<D> forces;
    for (int k = 0; k < D; ++k) {
      const auto sum = [&](Wall wall) { return sums_[static_cast<std::size_t>(wall * D + k)].value(); };
      forces.lower[k] = sum(lower), forces.upper[k] = sum(upper), forces.other[k] = sum(other);
    }
    return forces;
  }

 private:
  std::vector<ExactSum> sums_ = std::vector<ExactSum>(3 * D);
};

/// Adds to the populations of a row of the block what a moving wall beside it gives: f_q += 6 w_q c_q . u_wall for
/// every q that comes from the wall (Ladd, J. Fluid Mech. 271, 1994). To be called after every collision of the row, at
/// either parity.
template <class T, class Set>
void add_wall_momentum(Lattice<T, Set>& lattice, int i, const typename Lattice<T, Set>::Row& row,
                       const WallVelocity& walls);

/// What a row beyond a wall is made of: the node of the fluid that it mirrors, and the wall's velocity. A force spread
/// there acts on that node with reversed sign, and the velocity there is 2 u_wall - u: each is the other's adjoint, so
/// that spreading and interpolation stay adjoint near walls too. The wall takes twice that force
/// (core/coupling/wall_share.hpp).
constexpr int mirrored(int y, int height) { return y < 0 ? -1 - y : 2 * height - 1 - y; }

}  // namespace rouleau::core
