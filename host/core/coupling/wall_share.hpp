// What of the forces that membranes spread never reaches the fluid: it acts on the walls beside them.
#pragma once

#include <array>

#include "core/domain/domain.hpp"
#include "core/fluid/walls.hpp"
#include "kernel.hpp"

namespace rouleau::core {

/// Along one axis: the first node of a stencil and the weights from there on, as spreading has them.
struct StencilAlong {
  int first = 0, points = 0;
  std::array<double, 6> weight{};

  template <class Kernel, class T>
  static StencilAlong of(int base, T p, T q) {
    StencilAlong along{base + Kernel::first, Kernel::points, {}};
    const SpreadWeights<Kernel, T> weights(p, q);
    for (int k = 0; k < Kernel::points; ++k) along.weight[k] = weights.weight[k].vector[0];
    return along;
  }
};

/// A force F spread with the weight w beyond a plane wall comes back as -w F: the fluid lacks 2 w F, which the wall
/// takes. For the fluid's velocity there is 2 u_wall - u, so that moving the node costs the wall's motion just that
/// force. The walls' stress is then exact for any kernel without first moment: a force at the height h acts on the
/// lower wall by 1 - h/H. Beyond walls across y and z the velocity is u - 2 u_wall: that share is taken from the wall
/// across y.
template <int D>
void add_wall_share(const std::array<double, D>& force, const std::array<StencilAlong, D>& stencil,
                    const Domain<D>& domain, WallForceSums<D>& sums) {
  using Sums = WallForceSums<D>;
  double below[D] = {}, above[D] = {};  // twice the weight there
  for (int k = 1; k < D; ++k) {
    const StencilAlong& along = stencil[k];
    for (int i = 0; i < along.points && domain.walled(k); ++i) {
      if (along.first + i < 0) below[k] += 2 * along.weight[i];
      if (along.first + i >= domain.size[k]) above[k] += 2 * along.weight[i];
    }
  }
  const double beyond_z = D == 3 ? below[D - 1] + above[D - 1] : 0;
  const double lower = below[1] * (1 - beyond_z), upper = above[1] * (1 - beyond_z);
  for (int k = 0; k < D; ++k) {
    if (lower != 0) sums.add(Sums::lower, k, lower * force[k]);
    if (upper != 0) sums.add(Sums::upper, k, upper * force[k]);
    if (beyond_z != 0) sums.add(Sums::other, k, beyond_z * force[k]);
  }
}

}  // namespace rouleau::core
