// Kernels of the immersed boundary: how a node's force is spread over the lattice, and its velocity read from it.
#pragma once

#include <rouleau/pack.hpp>

#include "kernel_kind.hpp"

namespace rouleau::core {

/// A kernel is a type with
///   shift                   the base node of a coordinate X is floor(X + shift), its fraction X + shift - base
///   keep(fraction, p, q)    two numbers that are all that needs to be kept of the fraction, 0 <= fraction < 1
///   constant, by_p, by_q    weights of nodes base - 1 ... base + 2: constant[k] + by_p[k] p + by_q[k] q
///   halved                  whether weights 0 and 2 sum to 1/2, and so do 1 and 3
/// Weights sum to 1.

/// Peskin's 4-point kernel in its square-root form, which has no first moment: p = g, q = sqrt(1 + 4 g (1 - g)).
/// Peskin, Acta Numerica 11 (2002), eq. 6.27 and 6.28.
struct Peskin4 {
  static constexpr double shift = 0;
  template <class S>
  ROULEAU_ALWAYS_INLINE static void keep(const S& fraction, S& p, S& q) {
    p = fraction;
    q = sqrt_and_inverse(1.0 + 4.0 * fraction * (1.0 - fraction)).root;
  }
  static constexpr double constant[4] = {0.375, 0.375, 0.125, 0.125};
  static constexpr double by_p[4] = {-0.25, -0.25, 0.25, 0.25};
  static constexpr double by_q[4] = {-0.125, 0.125, 0.125, -0.125};
  static constexpr bool halved = true;
};

/// Peskin's first 4-point kernel, (1 + cos(pi r / 2)) / 4: p = sin(pi g / 2), q = cos(pi g / 2). Its first moment
/// reaches 0.021 spacings. Peskin, J. Comput. Phys. 25 (1977).
struct Cosine4 {
  static constexpr double shift = 0;
  template <class S>
  ROULEAU_ALWAYS_INLINE static void keep(const S& fraction, S& p, S& q) {
    constexpr double quarter_turn = 1.57079632679489661923;
    for (int i = 0; i < S::size; ++i) {
      p.vector[i] = __builtin_sin(quarter_turn * fraction.vector[i]);
      q.vector[i] = __builtin_cos(quarter_turn * fraction.vector[i]);
    }
  }
  static constexpr double constant[4] = {0.25, 0.25, 0.25, 0.25};
  static constexpr double by_p[4] = {-0.25, 0, 0.25, 0};
  static constexpr double by_q[4] = {0, 0.25, 0, -0.25};
  static constexpr bool halved = true;
};

/// The 3-point kernel about the nearest node: p = r, q = sqrt(1 - 3 r^2) with r from -1/2 to 1/2. It has no first
/// moment. Roma, Peskin and Berger, J. Comput. Phys. 153 (1999).
struct Roma3 {
  static constexpr double shift = 0.5;
  template <class S>
  ROULEAU_ALWAYS_INLINE static void keep(const S& fraction, S& p, S& q) {
    p = fraction - 0.5;
    q = sqrt_and_inverse(1.0 - 3.0 * p * p).root;
  }
  static constexpr double constant[4] = {1.0 / 3, 1.0 / 3, 1.0 / 3, 0};
  static constexpr double by_p[4] = {-0.5, 0, 0.5, 0};
  static constexpr double by_q[4] = {-1.0 / 6, 1.0 / 3, -1.0 / 6, 0};
  static constexpr bool halved = false;
};

/// Linear interpolation between two nodes. It has no first moment.
struct Linear2 {
  static constexpr double shift = 0;
  template <class S>
  ROULEAU_ALWAYS_INLINE static void keep(const S& fraction, S& p, S& q) {
    p = fraction;
    q = 0.0;
  }
  static constexpr double constant[4] = {0, 1, 0, 0};
  static constexpr double by_p[4] = {0, -1, 1, 0};
  static constexpr double by_q[4] = {0, 0, 0, 0};
  static constexpr bool halved = false;
};

/// The four weights side by side.
template <class Kernel, class T>
struct KernelWeights {
  rouleau::Pack<T, 4> weight;
  ROULEAU_ALWAYS_INLINE KernelWeights(T p, T q) {
    using Vector = typename rouleau::Pack<T, 4>::Vector;
    constexpr auto four = [](const double(&a)[4]) { return Vector{T(a[0]), T(a[1]), T(a[2]), T(a[3])}; };
    weight.vector = four(Kernel::constant) + four(Kernel::by_p) * p + four(Kernel::by_q) * q;
  }
};

/// The four weights one by one, each in all four places.
template <class Kernel, class T>
struct SpreadWeights {
  rouleau::Pack<T, 4> weight[4];
  ROULEAU_ALWAYS_INLINE SpreadWeights(T p, T q) {
    using Four = rouleau::Pack<T, 4>;
    const Four kept_p = p, kept_q = q;
    for (int k = 0; k < (Kernel::halved ? 2 : 4); ++k) {
      weight[k] =
          (Four(T(Kernel::constant[k])) + Four(T(Kernel::by_p[k])) * kept_p) + Four(T(Kernel::by_q[k])) * kept_q;
    }
    if constexpr (Kernel::halved) {
      weight[2] = Four(T(0.5)) - weight[0];
      weight[3] = Four(T(0.5)) - weight[1];
    }
  }
};

/// function(kernel) with the kernel of a kind, for its type.
template <class Function>
auto with_kernel(KernelKind kind, Function function) {
  switch (kind) {
    case KernelKind::cosine4:
      return function(Cosine4{});
    case KernelKind::roma3:
      return function(Roma3{});
    case KernelKind::linear2:
      return function(Linear2{});
    case KernelKind::peskin4:
      break;
  }
  return function(Peskin4{});
}

}  // namespace rouleau::core
