// Solid walls along an axis across x: half-way bounce-back. Those below and above, along y, may move along x.
#pragma once

#include "core/domain/domain.hpp"
#include "field.hpp"
#include "lattice.hpp"

namespace rouleau::core {

/// Velocity along x of the walls across y, lattice units. Not used when y is periodic. Walls across z stand still.
struct WallVelocity {
  double lower = 0, upper = 0;
};

/// Adds to the populations of a row of the block what a moving wall beside it gives: f_q += 6 w_q c_q . u_wall for
/// every q that comes from the wall (Ladd, J. Fluid Mech. 271, 1994). To be called after every collision of the row, at
/// either parity.
template <class T, class Set>
void add_wall_momentum(Lattice<T, Set>& lattice, const typename Lattice<T, Set>::Row& row, const WallVelocity& walls);

/// What a row beyond a wall is made of: the node of the fluid that it mirrors, and the wall's velocity. A force spread
/// there acts on that node with reversed sign, and the velocity there is 2 u_wall - u: each is the other's adjoint, so
/// that spreading and interpolation stay adjoint near walls too.
constexpr int mirrored(int y, int height) { return y < 0 ? -1 - y : 2 * height - 1 - y; }

}  // namespace rouleau::core
