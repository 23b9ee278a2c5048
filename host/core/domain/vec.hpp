// A vector in the space of the lattice.
#pragma once

#include <Eigen/Core>

namespace rouleau::core {

/// Components along the lattice's axes, in spacings unless something else is said.
template <int D>
using Vec = Eigen::Matrix<double, D, 1>;

}  // namespace rouleau::core
