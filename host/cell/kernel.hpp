// Peskin's 4-point kernel in its square-root form: weights that sum to 1 and have no first moment.
// Peskin, Acta Numerica 11 (2002), eq. 6.27 and 6.28.
#pragma once

#include <rouleau/pack.hpp>

namespace rouleau::host {

/// A coordinate X = base + fraction, 0 <= fraction < 1, gets the weights of nodes base - 1 ... base + 2,
///     (3 - 2 g - q, 3 - 2 g + q, 1 + 2 g + q, 1 + 2 g - q) / 8,  g = fraction, q = sqrt(1 + 4 g (1 - g)),
/// so that g and q are all that needs to be kept of it.
template <class S>
ROULEAU_ALWAYS_INLINE S kernel_root(const S& fraction) {
  return sqrt(1.0 + 4.0 * fraction * (1.0 - fraction));
}

/// The four weights side by side.
template <class T>
struct KernelWeights {
  rouleau::Pack<T, 4> weight;
  ROULEAU_ALWAYS_INLINE KernelWeights(T fraction, T root) {
    using Vector = typename rouleau::Pack<T, 4>::Vector;
    constexpr Vector constant{T(0.375), T(0.375), T(0.125), T(0.125)};
    constexpr Vector linear{T(-0.25), T(-0.25), T(0.25), T(0.25)};
    constexpr Vector rooted{T(-0.125), T(0.125), T(0.125), T(-0.125)};
    weight.vector = constant + linear * fraction + rooted * root;
  }
};

/// The four weights one by one, each in all four places: the first and the third sum to 1/2, and so do the others.
template <class T>
struct SpreadWeights {
  rouleau::Pack<T, 4> weight[4];
  ROULEAU_ALWAYS_INLINE SpreadWeights(T fraction, T root) {
    using Four = rouleau::Pack<T, 4>;
    const Four line = Four(T(0.375)) - Four(T(0.25)) * Four(fraction), half_root = Four(T(0.125)) * Four(root);
    weight[0] = line - half_root;
    weight[1] = line + half_root;
    weight[2] = Four(T(0.5)) - weight[0];
    weight[3] = Four(T(0.5)) - weight[1];
  }
};

}  // namespace rouleau::host
