// Kernels of the immersed boundary: how a node's force is spread over the lattice, and its velocity read from it.
#pragma once

#include <array>
#include <cstdint>
#include <rouleau/pack.hpp>

#include "kernel_kind.hpp"

namespace rouleau::core {

/// A kernel is a type with
///   shift                   the base node of a coordinate X is floor(X + shift), its fraction X + shift - base
///   keep(fraction, p, q)    two numbers that are all that needs to be kept of the fraction, 0 <= fraction < 1
///   first, points           nodes base + first ... base + first + points - 1 have weights; 4 or 6 points
///   constant, by_p, by_q    the weights: constant[k] + by_p[k] p + by_q[k] q
///   response                how a membrane's forces come back to it, for the semi-implicit step
///   halved                  whether weights 0 and 2 of four sum to 1/2, and so do 1 and 3
/// Weights sum to 1.

/// Peskin's 4-point kernel in its square-root form, which has no first moment: p = g, q = sqrt(1 + 4 g (1 - g)).
/// Peskin, Acta Numerica 11 (2002), eq. 6.27 and 6.28.
struct Peskin4 {
  static constexpr int first = -1, points = 4;
  static constexpr KernelResponse response{};
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
  static constexpr int first = -1, points = 4;
  static constexpr KernelResponse response{};
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
  static constexpr int first = -1, points = 4;
  static constexpr KernelResponse response{};
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
  static constexpr int first = -1, points = 4;
  static constexpr KernelResponse response{};
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

/// Numbers, less a share of their second difference, from one place before the first of them to one after the last.
constexpr std::array<double, 6> sharpened(const double (&of)[4], double share) {
  std::array<double, 6> sharp{};
  for (int k = 0; k < 4; ++k) {
    sharp[k] -= share * of[k];
    sharp[k + 1] += (1 + 2 * share) * of[k];
    sharp[k + 2] -= share * of[k];
  }
  return sharp;
}

/// Peskin4 less 0.262 times its second difference. Peskin4 has a second moment, in the mean over places 0.524
/// spacings^2 (0.500 to 0.543), by which it smooths all that varies along a membrane and across it; that mean is 0
/// here. There is no first moment, and even and odd nodes share as in Peskin4, which keeps the pressure from leaking.
/// Weights reach -0.071.
struct Sharp6 : Peskin4 {
  static constexpr int first = -2, points = 6;
  static constexpr KernelResponse response{.gain = 1.43, .stretching = 1.43, .bending = 4.54};
  static constexpr double share = 0.262;
  static constexpr std::array<double, 6> constant = sharpened(Peskin4::constant, share),
                                         by_p = sharpened(Peskin4::by_p, share), by_q = sharpened(Peskin4::by_q, share);
  static constexpr bool halved = false;
};

/// Numbers side by side, at least as many as a kernel has points: six lie in eight lanes, so that a row takes one load
/// and one store of a register, or few of registers of `register_bytes`. What lies beside the points is read and
/// written back, but is part of no sum.
template <class T, int points, int register_bytes = 64>
struct Line {
  static constexpr int size = points <= 4 ? 4 : 8, spare = size - points;
  static constexpr int width =
      size * static_cast<int>(sizeof(T)) <= register_bytes ? size : register_bytes / static_cast<int>(sizeof(T));
  static constexpr int parts = size / width;
  using Lanes = rouleau::Pack<T, width>;
  Lanes lanes[parts];
  ROULEAU_ALWAYS_INLINE static Line load(const T* from) {
    Line line;
    for (int p = 0; p < parts; ++p) line.lanes[p] = Lanes::load(from + p * width);
    return line;
  }
  ROULEAU_ALWAYS_INLINE static Line all(T value) {
    Line line;
    for (int p = 0; p < parts; ++p) line.lanes[p] = Lanes(value);
    return line;
  }
  ROULEAU_ALWAYS_INLINE void store(T* to) const {
    for (int p = 0; p < parts; ++p) lanes[p].store(to + p * width);
  }
  /// `b`: the same number in all lanes.
  ROULEAU_ALWAYS_INLINE friend Line operator*(const Line& a, const Lanes& b) {
    Line line;
    for (int p = 0; p < parts; ++p) line.lanes[p] = a.lanes[p] * b;
    return line;
  }
  ROULEAU_ALWAYS_INLINE friend Line operator*(const Line& a, const Line& b) {
    Line line;
    for (int p = 0; p < parts; ++p) line.lanes[p] = a.lanes[p] * b.lanes[p];
    return line;
  }
  ROULEAU_ALWAYS_INLINE friend Line operator+(const Line& a, const Line& b) {
    Line line;
    for (int p = 0; p < parts; ++p) line.lanes[p] = a.lanes[p] + b.lanes[p];
    return line;
  }
  [[nodiscard]] ROULEAU_ALWAYS_INLINE T at(int k) const { return lanes[k / width].vector[k % width]; }
  /// How many of the spare lanes are to lie before a kernel's first point, which is there: so many that a line of the
  /// cache holds all, if it holds the points. What crosses a border of these takes twice as long.
  [[nodiscard]] ROULEAU_ALWAYS_INLINE static int lanes_before(const T* first_point) {
    if constexpr (spare == 0) return 0;
    constexpr int cached = 64 / sizeof(T);
    const int beyond =
        static_cast<int>(reinterpret_cast<std::uintptr_t>(first_point) / sizeof(T) % cached) + size - cached;
    return beyond > 0 && beyond <= spare ? beyond : 0;
  }
  /// Four numbers with the same sum, of a line that has so many spare lanes before its points.
  [[nodiscard]] ROULEAU_ALWAYS_INLINE rouleau::Pack<T, 4> folded(int before = 0) const {
    using Four = rouleau::Pack<T, 4>;
    if constexpr (points == 4 && parts == 1) {
      return lanes[0];
    } else {
      T all[size + spare] = {};
      store(all);
      if constexpr (points == 4) return Four::load(all);
      const T rest[4] = {all[before + 4], all[before + 5]};
      return Four::load(all + before) + Four::load(rest);
    }
  }
};

/// The weights side by side, and none beside them; `before`: Line.
template <class Kernel, class T, int register_bytes = 64>
struct KernelWeights {
  using Weights = Line<T, Kernel::points, register_bytes>;
  Weights weight;
  ROULEAU_ALWAYS_INLINE KernelWeights(T p, T q, int before = 0) {
    static constexpr auto constant = filled_up(Kernel::constant), by_p = filled_up(Kernel::by_p),
                          by_q = filled_up(Kernel::by_q);
    const int from = Weights::spare - before;
    weight = (Weights::load(constant.data() + from) + Weights::load(by_p.data() + from) * Lanes(p)) +
             Weights::load(by_q.data() + from) * Lanes(q);
  }

 private:
  using Lanes = typename Weights::Lanes;
  template <class Numbers>
  static constexpr std::array<T, Weights::size + Weights::spare> filled_up(const Numbers& numbers) {
    std::array<T, Weights::size + Weights::spare> all{};
    for (int k = 0; k < Kernel::points; ++k) all[Weights::spare + k] = static_cast<T>(numbers[k]);
    return all;
  }
};

/// The weights one by one, each in all lanes of a line.
template <class Kernel, class T, int register_bytes = 64>
struct SpreadWeights {
  using Lanes = typename Line<T, Kernel::points, register_bytes>::Lanes;
  Lanes weight[Kernel::points];
  ROULEAU_ALWAYS_INLINE SpreadWeights(T p, T q) {
    const Lanes kept_p = p, kept_q = q;
    for (int k = 0; k < (Kernel::halved ? 2 : Kernel::points); ++k) {
      weight[k] =
          (Lanes(T(Kernel::constant[k])) + Lanes(T(Kernel::by_p[k])) * kept_p) + Lanes(T(Kernel::by_q[k])) * kept_q;
    }
    if constexpr (Kernel::halved) {
      weight[2] = Lanes(T(0.5)) - weight[0];
      weight[3] = Lanes(T(0.5)) - weight[1];
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
    case KernelKind::sharp6:
      return function(Sharp6{});
    case KernelKind::peskin4:
      break;
  }
  return function(Peskin4{});
}

}  // namespace rouleau::core
