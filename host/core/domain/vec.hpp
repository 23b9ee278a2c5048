// A vector in the space of the lattice.
#pragma once

#include <Eigen/Core>

namespace rouleau::core {

/// Components along the lattice's axes, in spacings unless something else is said.
template <int D>
using Vec = Eigen::Matrix<double, D, 1>;

/// The i-th vector of arrays for each component.
template <int D>
Vec<D> vector_at(const auto& arrays, int i) {
  Vec<D> vector;
  for (int k = 0; k < D; ++k) vector[k] = arrays[k][i];
  return vector;
}

}  // namespace rouleau::core
