// log, log1p, expm1, pow, sin, cos, tanh and erf of packs, beside exp and sqrt in pack.hpp.
//
// Every function gives the same bits for each instruction set and at each place of a pack: products are kept apart from
// the sums they go into, so that no compiler makes one fused operation of both. (exp and an author's own formula have
// no such promise: there the compiler may fuse.) NaN in is NaN out. Numbers of packs of float are computed in double
// and rounded once. Accuracy is the largest error in units of the last place (ulp) that tests/unit/sdk/functions.cpp
// finds; it holds these limits. Error of float: 0.51 ulp everywhere.
//
//             method                                                        ulp     range
//   log       fdlibm, e_log.c: polynomial of degree 7 in (f / (2 + f))^2    1       all
//   log1p     log of 1 + x, and what rounding has left out of that            2       all
//   expm1     exp without its 1                                              2       all
//   pow       log in two numbers, then exp; the split is that of e_pow.c    1       all
//   sin, cos  fdlibm, k_sin.c, k_cos.c; pi/2 in three parts, e_rem_pio2.c   1       |x| <= 1e6, NaN beyond
//   tanh      Cephes, tanh.c: rational below 0.625, then exp                2       all
//   erf       fdlibm, s_erf.c: rational, beyond 1.25 with exp               1       all
//
// fdlibm: (C) 1993 Sun Microsystems, freely granted. Cephes: S. L. Moshier, Methods and Programs for Mathematical
// Functions, 1989. Both: netlib.org. Coefficients are theirs, the code is not.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "pack.hpp"

// Defined by gcc 12 and later. clang never fuses operations that stand in different functions, as those of packs do.
#if defined(__has_builtin)
#if __has_builtin(__builtin_assoc_barrier)
#define ROULEAU_UNFUSED(product) __builtin_assoc_barrier(product)
#endif
#endif
#ifndef ROULEAU_UNFUSED
#define ROULEAU_UNFUSED(product) (product)
#endif

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace rouleau {

namespace detail {

/// a * b, rounded before anything is added to it.
template <class S>
ROULEAU_ALWAYS_INLINE S times(const S& a, const S& b) {
  return S(typename S::Vector(ROULEAU_UNFUSED(a.vector * b.vector)));
}

/// c[0] + c[1] x + c[2] x^2 + ...
template <class S, class C, int n>
ROULEAU_ALWAYS_INLINE S polynomial(const S& x, const C (&c)[n]) {
  S sum = c[n - 1];
#pragma GCC unroll 32
  for (int i = n - 2; i >= 0; --i) sum = times(sum, x) + c[i];
  return sum;
}

/// Two numbers whose unevaluated sum is meant.
template <class S>
struct Sum {
  S high, low;
};
/// a + b exactly, where |a| >= |b| or a is 0.
template <class S>
ROULEAU_ALWAYS_INLINE Sum<S> exact_sum(const S& a, const S& b) {
  const S high = a + b;
  return {high, b - (high - a)};
}
/// The number without the lower 27 bits of its mantissa: the product of two such is exact.
template <class S>
ROULEAU_ALWAYS_INLINE S upper(const S& a) {
  return S((typename S::Vector)((typename S::Bits)a.vector & ~std::int64_t{0x7ffffff}));
}
/// a * b to about 100 bits.
template <class S>
ROULEAU_ALWAYS_INLINE Sum<S> product(const Sum<S>& a, const Sum<S>& b) {
  const S u = upper(a.high), v = upper(b.high), high = times(u, v);
  const S rest = times(u, (b.high - v) + b.low) + times((a.high - u) + a.low, b.high);
  return exact_sum(high, rest);
}

/// 2^n of integers -1022 <= n <= 1023.
template <class S>
ROULEAU_ALWAYS_INLINE S power_of_two(const S& n) {
  const S shifted = n + 6755399441055744.0;  // 1.5 * 2^52: the integer is in the low bits
  return S((typename S::Vector)(((typename S::Bits)shifted.vector + 1023) << 52));
}
/// The nearest integer of |x| < 2^51.
template <class S>
ROULEAU_ALWAYS_INLINE S nearest(const S& x) {
  return (x + 6755399441055744.0) - 6755399441055744.0;
}
template <class S>
ROULEAU_ALWAYS_INLINE typename S::Mask equal(const S& a, const S& b) {
  return (a <= b) & (a >= b);
}
/// |x| with the sign bit of `sign`; of zeros and NaN too.
template <class S>
ROULEAU_ALWAYS_INLINE S with_sign(const S& x, const S& sign) {
  constexpr std::int64_t bit = std::numeric_limits<std::int64_t>::min();
  using Bits = typename S::Bits;
  return S((typename S::Vector)(((Bits)x.vector & ~bit) | ((Bits)sign.vector & bit)));
}

/// x = 2^exponent * mantissa with sqrt(1/2) < mantissa <= sqrt(2), of positive finite numbers, subnormal ones too.
template <class S>
struct Parts {
  S exponent, mantissa;
};
template <class S>
ROULEAU_ALWAYS_INLINE Parts<S> parts_of(const S& x) {
  using Bits = typename S::Bits;
  using Vector = typename S::Vector;
  using Unsigned __attribute__((vector_size(sizeof(Vector)))) = std::uint64_t;
  const auto subnormal = x < S(2.2250738585072014e-308);
  const Bits bits = (Bits)select(subnormal, times(x, S(18014398509481984.0)), x).vector;  // 2^54
  const S biased((Vector)((Bits)((Unsigned)bits >> 52) | 0x4330000000000000));            // 2^52 + exponent + 1023
  const S mantissa((Vector)((bits & 0x000fffffffffffff) | 0x3ff0000000000000));
  const S exponent = (biased - 4503599627371519.0) - select(subnormal, S(54.0), S(0.0));
  const auto large = mantissa > S(1.4142135623730951);
  return {exponent + select(large, S(1.0), S(0.0)), select(large, times(mantissa, S(0.5)), mantissa)};
}

/// e^(x.high + x.low) = 2^n (1 + rest) with |rest| < 0.42, for |x.high| < 760.
template <class S>
struct Scaled {
  S n, rest;
};
template <class S>
ROULEAU_ALWAYS_INLINE Scaled<S> scaled_exp(const Sum<S>& x) {
  constexpr double inverse_factorials[] = {1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                                           1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                           1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
  const S n = nearest(times(x.high, S(1.4426950408889634)));
  const S t = x.high - times(n, S(6.93145751953125e-1)), w = times(n, S(1.42860682030941723212e-6));
  const S rest = t - w;
  const Sum<S> reduced = exact_sum(rest, ((t - rest) - w) + x.low);
  const S r = reduced.high, low = reduced.low;
  return {n, r + (low + times(times(r, r), polynomial(r, inverse_factorials)))};
}

/// e^(x.high + x.low) for |x.high| < 760, subnormal results too: 0.6 ulp.
template <class S>
ROULEAU_ALWAYS_INLINE S exp_of(const Sum<S>& x) {
  const Scaled<S> scaled = scaled_exp(x);
  const S n = scaled.n, p = 1.0 + scaled.rest;
  // In two steps where one power of two would not do: the last product is the only one that may round.
  const auto large = n > S(1000.0), small = n < S(-1000.0);
  const S aside = select(large, S(100.0), select(small, S(-100.0), S(0.0)));
  return times(times(p, power_of_two(n - aside)), power_of_two(aside));
}
template <class S>
ROULEAU_ALWAYS_INLINE S exp_of(const S& x) {
  return exp_of(Sum<S>{x, S(0.0)});
}

template <class S>
ROULEAU_ALWAYS_INLINE S log_of(const S& x) {
  constexpr double c[] = {0.0,
                          6.666666666666735130e-01,
                          3.999999999940941908e-01,
                          2.857142874366239149e-01,
                          2.222219843214978396e-01,
                          1.818357216161805012e-01,
                          1.531383769920937332e-01,
                          1.479819860511658591e-01};
  const Parts<S> parts = parts_of(x);
  const S k = parts.exponent, f = parts.mantissa - 1.0, s = f / (2.0 + f), half = times(S(0.5), times(f, f));
  const S correction = times(s, half + polynomial(times(s, s), c)) + times(k, S(1.90821492927058770002e-10));
  const S result = times(k, S(6.93147180369123816490e-01)) - ((half - correction) - f);
  const S infinity = __builtin_huge_val(), nan = __builtin_nan("");
  return select(x > S(0.0), select(x < infinity, result, x), select(x < S(0.0), nan, select(x <= x, -infinity, x)));
}

template <class S>
ROULEAU_ALWAYS_INLINE S expm1_of(const S& x) {
  const Scaled<S> scaled = scaled_exp(Sum<S>{min(max(x, S(-40.0)), S(40.0)), S(0.0)});
  const S scale = power_of_two(scaled.n), near_zero = times(scale, scaled.rest) + (scale - 1.0);
  const S result = select(x > S(40.0), exp_of(min(x, S(750.0))), near_zero);
  return select(with_sign(x, S(0.0)) < S(1e-17), x, select(x <= x, result, x));  // keeps -0 and subnormal numbers
}

template <class S>
ROULEAU_ALWAYS_INLINE S log1p_of(const S& x) {
  const S u = 1.0 + x, left_out = select(x > S(1.0), 1.0 - (u - x), x - (u - 1.0)), log_u = log_of(u);
  const S result = select((u > S(0.0)) & (x < S(__builtin_huge_val())), log_u + left_out / u, log_u);
  return select(with_sign(x, S(0.0)) < S(1e-17), x, result);
}

/// log of positive finite numbers to 2^-66 of itself.
template <class S>
ROULEAU_ALWAYS_INLINE Sum<S> precise_log(const S& x) {
  // atanh(s) = s (1 + z/3 + z^2 (1/5 + z/7 + ...)), z = s^2 < 0.0295: the terms left out are below 2^-70.
  constexpr double c[] = {1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13, 1.0 / 15,
                          1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23, 1.0 / 25, 1.0 / 27};
  const Parts<S> parts = parts_of(x);
  const S f = parts.mantissa - 1.0, quotient = f / (2.0 + f);
  // What the quotient's rounding and that of 2 + f left out: f - quotient (2 + f), exactly, over 2 + f.
  const Sum<S> below = exact_sum(S(2.0), f), back = product({quotient, S(0.0)}, below);
  const Sum<S> s{quotient, ((f - back.high) - back.low) / below.high};
  const Sum<S> z = product(s, s), third = product(z, {S(1.0 / 3), S(1.850371707708594e-17)});
  const S far = times(times(z.high, z.high), polynomial(z.high, c));
  const Sum<S> near_one = exact_sum(S(1.0), third.high);
  const Sum<S> series = exact_sum(near_one.high, near_one.low + (third.low + far));
  const Sum<S> half_log = product(s, series);
  const S k = parts.exponent, upper_part = times(k, S(6.93147180369123816490e-01));
  const Sum<S> sum = exact_sum(upper_part, 2.0 * half_log.high);  // 0, or the larger of both
  return exact_sum(sum.high, sum.low + (times(k, S(1.90821492927058770002e-10)) + 2.0 * half_log.low));
}

template <class S>
ROULEAU_ALWAYS_INLINE S pow_of(const S& x, const S& y) {
  const S infinity = __builtin_huge_val(), zero = 0.0, one = 1.0;
  const S size = with_sign(x, zero), log_size = log_of(size);
  const auto usual = (size > zero) & (size < infinity);
  // Beyond these the result is 0 or infinite, whatever the digits of the logarithm.
  const S rough = times(y, log_size);
  const auto over = rough > S(710.0), under = rough < S(-746.0);
  const auto plain = usual & !(over | under);
  const S base = select(plain, size, one), exponent = select(plain, y, one);
  S power = exp_of(product(precise_log(base), {exponent, zero}));
  power = select(over, infinity, select(under, zero, power));
  power = select(equal(size, one) | equal(y, zero), one, power);
  // Odd integers keep the sign of x. Numbers from 2^53 on are even; rounding by adding 2^52 is exact below it.
  const S magnitude = with_sign(y, zero), half = times(magnitude, S(0.5)), whole = 4503599627370496.0;
  const auto integer = (magnitude >= whole) | equal((magnitude + whole) - whole, magnitude);
  const auto even = (half >= whole) | equal((half + whole) - whole, half);
  power = select(integer & !even, with_sign(power, x), power);
  power = select((x < zero) & (x > -infinity) & !integer, S(__builtin_nan("")), power);
  return select((x <= x) & (y <= y), power, x + y);
}

/// x = n pi/2 + (high + low), |x| <= 1e6: n has 20 bits at most, and each product of it with a part of 33 bits is
/// exact.
template <class S>
struct Turned {
  S quarter;  ///< n modulo 4: 0, 1, 2 or 3
  Sum<S> rest;
};
template <class S>
ROULEAU_ALWAYS_INLINE Turned<S> turn(const S& x) {
  const S n = nearest(times(x, S(6.36619772367581382433e-01)));
  const S first = x - times(n, S(1.57079632673412561417e+00));
  const S second = times(n, S(6.07710050630396597660e-11)), rest = first - second;
  const S third = times(n, S(2.02226624871116645580e-21)), high = rest - third;
  const S low = ((rest - high) - third) + ((first - rest) - second) - times(n, S(8.47842766036889956997e-32));
  return {n - times(S(4.0), nearest(times(n, S(0.25)) - 0.375)), exact_sum(high, low)};
}

/// sin(x + shift pi/2).
template <class S>
ROULEAU_ALWAYS_INLINE S wave(const S& x, double shift) {
  constexpr double odd[] = {8.33333333332248946124e-03, -1.98412698298579493134e-04, 2.75573137070700676789e-06,
                            -2.50507602534068634195e-08, 1.58969099521155010221e-10};
  constexpr double even[] = {4.16666666666666019037e-02,  -1.38888888888741095749e-03, 2.48015872894767294178e-05,
                             -2.75573143513906633035e-07, 2.08757232129817482790e-09,  -1.13596475577881948265e-11};
  const auto inside = with_sign(x, S(0.0)) <= S(1e6);
  const Turned<S> turned = turn(select(inside, x, S(0.0)));
  const S r = turned.rest.high, low = turned.rest.low, z = times(r, r), cube = times(z, r);
  const S sine = r - ((times(z, times(S(0.5), low) - times(cube, polynomial(z, odd))) - low) -
                      times(cube, S(-1.66666666666666324348e-01)));
  const S half = times(S(0.5), z), main = 1.0 - half;
  const S cosine = main + (((1.0 - main) - half) + (times(times(z, z), polynomial(z, even)) - times(r, low)));
  S quarter = turned.quarter + shift;
  quarter = select(quarter > S(3.5), quarter - 4.0, quarter);
  const auto is_sine = (quarter < S(0.5)) | ((quarter > S(1.5)) & (quarter < S(2.5)));
  const S size = select(is_sine, sine, cosine), value = select(quarter > S(1.5), -size, size);
  return select(inside, value, S(__builtin_nan("")));
}
template <class S>
ROULEAU_ALWAYS_INLINE S sin_of(const S& x) {
  return select(with_sign(x, S(0.0)) < S(1e-9), x, wave(x, 0));  // keeps -0 and subnormal numbers
}
template <class S>
ROULEAU_ALWAYS_INLINE S cos_of(const S& x) {
  return wave(x, 1);
}

template <class S>
ROULEAU_ALWAYS_INLINE S tanh_of(const S& x) {
  constexpr double p[] = {-1.61468768441708447952e3, -9.92877231001918586564e1, -9.64399179425052238628e-1};
  constexpr double q[] = {4.84406305325125486048e3, 2.23548839060100448583e3, 1.12811678491632931402e2, 1.0};
  const S size = with_sign(x, S(0.0)), z = times(x, x);
  const S near_zero = x + times(x, times(z, polynomial(z, p) / polynomial(z, q)));
  const S far = 1.0 - 2.0 / (exp_of(min(2.0 * size, S(50.0))) + 1.0);
  const S result = with_sign(select(size < S(0.625), near_zero, far), x);  // near_zero: -0 too
  return select(x <= x, result, x);
}

template <class S>
ROULEAU_ALWAYS_INLINE S erf_of(const S& x) {
  // Each interval's rational function: up to 0.84375 in x^2, to 1.25 in x - 1, to 1/0.35 and beyond in 1/x^2.
  constexpr double p[4][8] = {
      {1.28379167095512558561e-01, -3.25042107247001499370e-01, -2.84817495755985104766e-02,
       -5.77027029648944159157e-03, -2.37630166566501626084e-05, 0, 0, 0},
      {-2.36211856075265944077e-03, 4.14856118683748331666e-01, -3.72207876035701323847e-01, 3.18346619901161753674e-01,
       -1.10894694282396677476e-01, 3.54783043256182359371e-02, -2.16637559486879084300e-03, 0},
      {-9.86494403484714822705e-03, -6.93858572707181764372e-01, -1.05586262253232909814e+01,
       -6.23753324503260060396e+01, -1.62396669462573470355e+02, -1.84605092906711035994e+02,
       -8.12874355063065934246e+01, -9.81432934416914548592e+00},
      {-9.86494292470009928597e-03, -7.99283237680523006574e-01, -1.77579549177547519889e+01,
       -1.60636384855821916062e+02, -6.37566443368389627722e+02, -1.02509513161107724954e+03,
       -4.83519191608651397019e+02, 0}};
  constexpr double q[4][9] = {
      {1, 3.97917223959155352819e-01, 6.50222499887672944485e-02, 5.08130628187576562776e-03,
       1.32494738004321644526e-04, -3.96022827877536812320e-06, 0, 0, 0},
      {1, 1.06420880400844228286e-01, 5.40397917702171048937e-01, 7.18286544141962662868e-02,
       1.26171219808761642112e-01, 1.36370839120290507362e-02, 1.19844998467991074170e-02, 0, 0},
      {1, 1.96512716674392571292e+01, 1.37657754143519042600e+02, 4.34565877475229228821e+02,
       6.45387271733267880336e+02, 4.29008140027567833386e+02, 1.08635005541779435134e+02, 6.57024977031928170135e+00,
       -6.04244152148580987438e-02},
      {1, 3.03380607434824582924e+01, 3.25792512996573918826e+02, 1.53672958608443695994e+03,
       3.19985821950859553908e+03, 2.55305040643316442583e+03, 4.74528541206955367215e+02, -2.24409524465858183362e+01,
       0}};
  const S size = with_sign(x, S(0.0)), bounded = min(size, S(6.0));
  const auto first = bounded < S(0.84375), second = bounded < S(1.25), third = bounded < S(1 / 0.35);
  const S square = times(bounded, bounded);
  const S argument = select(first, square, select(second, bounded - 1.0, 1.0 / square));
  const auto fitting = [&](const auto& c, int i) __attribute__((always_inline)) {
    return select(first, S(c[0][i]), select(second, S(c[1][i]), select(third, S(c[2][i]), S(c[3][i]))));
  };
  S above = fitting(p, 7), below = fitting(q, 8);
#pragma GCC unroll 8
  for (int i = 6; i >= 0; --i) above = times(above, argument) + fitting(p, i);
#pragma GCC unroll 8
  for (int i = 7; i >= 0; --i) below = times(below, argument) + fitting(q, i);
  const S ratio = above / below;
  const S tail = 1.0 - exp_of(ratio - 0.5625 - square) / bounded;
  const S far = with_sign(select(second, 8.45062911510467529297e-01 + ratio, tail), x);
  // 2 / sqrt(pi) = 1 + 0.128...; the product that might be subnormal is made eight times too large at first.
  const S tiny = times(S(0.125), times(S(8.0), x) + times(S(1.02703333676410069053), x));
  const S near_zero = select(size < S(1e-300), tiny, x + times(x, ratio));
  return select(x <= x, select(first, near_zero, far), x);
}

/// Calls a function of packs of double. Packs of float go through it in two halves, as wide as they are together.
template <class S, class F, class... More>
ROULEAU_ALWAYS_INLINE S in_double(F function, const S& x, const More&... more) {
  using T = typename S::Number;
  constexpr int N = S::size;
  if constexpr (sizeof(T) == 8) {
    return function(x, more...);
  } else {
    using Half = Pack<double, N / 2>;
    Half halves[2];
#pragma GCC unroll 2
    for (int h = 0; h < 2; ++h) {
      const auto half = [h](const S& a) __attribute__((always_inline)) {
        Half wide;
#pragma GCC unroll 8
        for (int i = 0; i < N / 2; ++i) wide.vector[i] = a.vector[h * N / 2 + i];
        return wide;
      };
      halves[h] = function(half(x), half(more)...);
    }
    S result;
#pragma GCC unroll 16
    for (int i = 0; i < N; ++i) result.vector[i] = static_cast<T>(halves[2 * i / N].vector[i % (N / 2)]);
    return result;
  }
}

}  // namespace detail

/// Natural logarithm: -infinity of 0, NaN of negative numbers.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> log(const Pack<T, N>& x) {
  return detail::in_double(
      [](const auto& a) __attribute__((always_inline)) { return detail::log_of(a); }, x);
}
/// Logarithm of 1 + x: exact where x is small, and log would see nothing but 1.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> log1p(const Pack<T, N>& x) {
  return detail::in_double(
      [](const auto& a) __attribute__((always_inline)) { return detail::log1p_of(a); }, x);
}
/// exp(x) - 1: exact where x is small, and both would cancel.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> expm1(const Pack<T, N>& x) {
  return detail::in_double(
      [](const auto& a) __attribute__((always_inline)) { return detail::expm1_of(a); }, x);
}
/// Sine of |x| <= 1e6; NaN beyond, where a law that turns so often has gone wrong.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> sin(const Pack<T, N>& x) {
  return detail::in_double(
      [](const auto& a) __attribute__((always_inline)) { return detail::sin_of(a); }, x);
}
/// Cosine of |x| <= 1e6; NaN beyond.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> cos(const Pack<T, N>& x) {
  return detail::in_double(
      [](const auto& a) __attribute__((always_inline)) { return detail::cos_of(a); }, x);
}
/// Hyperbolic tangent.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> tanh(const Pack<T, N>& x) {
  return detail::in_double(
      [](const auto& a) __attribute__((always_inline)) { return detail::tanh_of(a); }, x);
}
/// Error function, 2/sqrt(pi) times the integral of exp(-t^2) from 0 to x.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> erf(const Pack<T, N>& x) {
  return detail::in_double(
      [](const auto& a) __attribute__((always_inline)) { return detail::erf_of(a); }, x);
}
/// x^y as std::pow has it, but for one thing: NaN in either is NaN out, also NaN^0 and 1^NaN. Either may be a number.
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> pow(const Pack<T, N>& x, const Pack<T, N>& y) {
  return detail::in_double(
      [](const auto& a, const auto& b) __attribute__((always_inline)) { return detail::pow_of(a, b); }, x, y);
}
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> pow(const Pack<T, N>& x, double y) {
  return pow(x, Pack<T, N>(y));
}
template <class T, int N>
ROULEAU_ALWAYS_INLINE Pack<T, N> pow(double x, const Pack<T, N>& y) {
  return pow(Pack<T, N>(x), y);
}

/// The same names for plain numbers, so that one formula serves both.
using std::cos;
using std::erf;
using std::expm1;
using std::log;
using std::log1p;
using std::pow;
using std::sin;
using std::tanh;

}  // namespace rouleau

#undef ROULEAU_UNFUSED
#pragma GCC diagnostic pop
