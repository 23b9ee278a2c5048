// A pack of numbers that computes like one number: what a model's formula is written in.
//
// Pack<T, N> holds N values of T in one vector register; every operation acts on each value alone. A formula written as
// a template over its number type runs with float, double or any pack, and the SDK picks the width when the plugin
// loads.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#define ROULEAU_ALWAYS_INLINE inline __attribute__((always_inline))

// Packs wider than the registers of the default target appear only inside functions that are inlined into one compiled
// for a wider target, so the calling convention this warns about is never used.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace rouleau {

/// What sqrt_and_inverse() returns.
template <class S>
struct SquareRoot {
  S root, inverse;
};

template <class T, int N>
struct Pack {
  using Number = T;
  using Integer = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  using Vector __attribute__((vector_size(N * sizeof(T)))) = T;
  using Bits __attribute__((vector_size(N * sizeof(T)))) = Integer;
  static constexpr int size = N;

  /// One truth value for each number, as the comparisons give it and select() takes it.
  struct Mask {
    Bits bits;
    ROULEAU_ALWAYS_INLINE friend Mask operator&(const Mask& a, const Mask& b) { return {a.bits & b.bits}; }
    ROULEAU_ALWAYS_INLINE friend Mask operator|(const Mask& a, const Mask& b) { return {a.bits | b.bits}; }
    ROULEAU_ALWAYS_INLINE friend Mask operator!(const Mask& a) { return {~a.bits}; }
  };

  Vector vector;

  Pack() = default;
  /// All values equal. Any arithmetic type converts, so that double parameters mix with packs of float. Adding zero
  /// keeps g++ 12 from building the pack element by element, as it does of what it can simplify early; -0 becomes 0.
  template <class A, class = std::enable_if_t<std::is_arithmetic_v<A>>>
  ROULEAU_ALWAYS_INLINE Pack(A value) : vector(Vector{} + static_cast<T>(value)) {}
  ROULEAU_ALWAYS_INLINE explicit Pack(const Vector& values) : vector(values) {}

  /// Reads N values from any address.
  ROULEAU_ALWAYS_INLINE static Pack load(const T* from) {
    Pack p;
    std::memcpy(&p.vector, from, sizeof(Vector));
    return p;
  }
  /// The number at an address, N times. With AVX-512 the load does it alone, while a number that is in a register costs
  /// an addition (see above) and a shuffle.
  ROULEAU_ALWAYS_INLINE static Pack broadcast(const T* from) {
#if defined(__x86_64__)
    if constexpr (sizeof(Vector) == 64) {  // only in functions for AVX-512 are packs so wide
      Pack p;
      if constexpr (sizeof(T) == 8) {
        asm("vbroadcastsd %1, %0" : "=v"(p.vector) : "m"(*from));
      } else {
        asm("vbroadcastss %1, %0" : "=v"(p.vector) : "m"(*from));
      }
      return p;
    }
#endif
    return Pack(*from);
  }
  /// Writes N values to any address.
  ROULEAU_ALWAYS_INLINE void store(T* to) const { std::memcpy(to, &vector, sizeof(Vector)); }

  ROULEAU_ALWAYS_INLINE friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.vector + b.vector); }
  ROULEAU_ALWAYS_INLINE friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.vector - b.vector); }
  ROULEAU_ALWAYS_INLINE friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.vector * b.vector); }
  ROULEAU_ALWAYS_INLINE friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.vector / b.vector); }
  ROULEAU_ALWAYS_INLINE friend Pack operator-(const Pack& a) { return Pack(-a.vector); }
  ROULEAU_ALWAYS_INLINE Pack& operator+=(const Pack& b) { return vector += b.vector, *this; }
  ROULEAU_ALWAYS_INLINE Pack& operator-=(const Pack& b) { return vector -= b.vector, *this; }
  ROULEAU_ALWAYS_INLINE Pack& operator*=(const Pack& b) { return vector *= b.vector, *this; }

  ROULEAU_ALWAYS_INLINE friend Mask operator<(const Pack& a, const Pack& b) { return {a.vector < b.vector}; }
  ROULEAU_ALWAYS_INLINE friend Mask operator>(const Pack& a, const Pack& b) { return {a.vector > b.vector}; }
  ROULEAU_ALWAYS_INLINE friend Mask operator<=(const Pack& a, const Pack& b) { return {a.vector <= b.vector}; }
  ROULEAU_ALWAYS_INLINE friend Mask operator>=(const Pack& a, const Pack& b) { return {a.vector >= b.vector}; }

  /// `a` where the mask is true, `b` elsewhere.
  ROULEAU_ALWAYS_INLINE friend Pack select(const Mask& mask, const Pack& a, const Pack& b) {
    return Pack(mask.bits ? a.vector : b.vector);
  }
  ROULEAU_ALWAYS_INLINE friend Pack min(const Pack& a, const Pack& b) { return select(a < b, a, b); }
  ROULEAU_ALWAYS_INLINE friend Pack max(const Pack& a, const Pack& b) { return select(a > b, a, b); }
  ROULEAU_ALWAYS_INLINE friend Pack abs(const Pack& a) { return select(a < Pack(0), -a, a); }
  /// Smallest and largest of the values.
  ROULEAU_ALWAYS_INLINE friend T least(const Pack& a) {
    return fold(a, [](const Pack& l, const Pack& r) { return min(l, r); });
  }
  ROULEAU_ALWAYS_INLINE friend T largest(const Pack& a) {
    return fold(a, [](const Pack& l, const Pack& r) { return max(l, r); });
  }
  ROULEAU_ALWAYS_INLINE friend Pack sqrt(const Pack& a) {
    Pack root;
#pragma GCC unroll 64  // without it, g++ 12 sometimes makes several narrow instructions of the loop
    for (int i = 0; i < N; ++i) root.vector[i] = std::sqrt(a.vector[i]);
    return root;
  }
  /// sqrt(a) and 1 / sqrt(a), each to 2 units in the last place, of normal positive numbers; of 0 they may be NaN.
  /// Method: with AVX-512 Newton's for y^-2 = a from the processor's estimate to 14 bits, an eighth of the time that
  /// the root and the quotient take.
  ROULEAU_ALWAYS_INLINE friend SquareRoot<Pack> sqrt_and_inverse(const Pack& a) {
#if defined(__x86_64__)
    if constexpr (sizeof(Vector) == 64) {
      constexpr bool in_double = sizeof(T) == 8;
      Pack y;
      if constexpr (in_double) {
        asm("vrsqrt14pd %1, %0" : "=v"(y.vector) : "v"(a.vector));
      } else {
        asm("vrsqrt14ps %1, %0" : "=v"(y.vector) : "v"(a.vector));
      }
      const Pack half = 0.5 * a;
      if constexpr (in_double) y += y * (0.5 - (half * y) * y);
      y += y * (0.5 - (half * y) * y);
      return {a * y, y};
    }
#endif
    const Pack root = sqrt(a);
    return {root, 1.0 / root};
  }

  /// e^x to 2 units in the last place; 0 below -708, infinite above 709. Double precision only.
  /// Method: x = n ln 2 + r with |r| <= ln(2)/2, Taylor polynomial of degree 13 in r (remainder below 2e-17), times
  /// 2^n.
  ROULEAU_ALWAYS_INLINE friend Pack exp(const Pack& argument) {
    static_assert(std::is_same_v<T, double>, "exp is for packs of double: laws and potentials compute in double");
    const Pack x = min(max(argument, Pack(-745.0)), Pack(710.0));
    const Pack round_to_integer = 6755399441055744.0;  // 1.5 * 2^52: adding it leaves the integer in the low bits
    const Pack shifted = x * 1.4426950408889634 + round_to_integer;
    const Pack n = shifted - round_to_integer;
    const Pack r = (x - n * 6.93145751953125e-1) - n * 1.42860682030941723212e-6;
    Pack p = 1.0 / 6227020800.0;
    p = p * r + 1.0 / 479001600.0;
    p = p * r + 1.0 / 39916800.0;
    p = p * r + 1.0 / 3628800.0;
    p = p * r + 1.0 / 362880.0;
    p = p * r + 1.0 / 40320.0;
    p = p * r + 1.0 / 5040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    p = p * r + 1.0;
    p = p * r + 1.0;
    const Bits exponent = ((Bits)shifted.vector + 1023) << 52;
    const Pack scaled = p * Pack((Vector)exponent);
    const Pack tame = select(argument < Pack(-708.0), Pack(0.0), scaled);
    const Pack bounded = select(argument > Pack(709.0), Pack(__builtin_huge_val()), tame);
    return select(argument <= argument, bounded, argument);  // NaN stays NaN
  }

 private:
  template <int step = N / 2, class Operation>
  ROULEAU_ALWAYS_INLINE static T fold(const Pack& a, Operation operation) {
    if constexpr (step == 0) {
      return a.vector[0];
    } else {
      return fold<step / 2>(operation(a, partners<step>(a, std::make_integer_sequence<int, N>())), operation);
    }
  }
  /// Every value changes places with the one `step` from it.
  template <int step, int... i>
  ROULEAU_ALWAYS_INLINE static Pack partners(const Pack& a, std::integer_sequence<int, i...>) {
    return Pack(Vector(__builtin_shufflevector(a.vector, a.vector, (i ^ step)...)));
  }
};

/// The same names for plain numbers, so that one formula serves both.
using std::abs;
using std::exp;
using std::sqrt;
ROULEAU_ALWAYS_INLINE SquareRoot<double> sqrt_and_inverse(double a) { return {std::sqrt(a), 1 / std::sqrt(a)}; }
ROULEAU_ALWAYS_INLINE double select(bool mask, double a, double b) { return mask ? a : b; }
ROULEAU_ALWAYS_INLINE double min(double a, double b) { return a < b ? a : b; }
ROULEAU_ALWAYS_INLINE double max(double a, double b) { return a > b ? a : b; }

}  // namespace rouleau

#pragma GCC diagnostic pop
