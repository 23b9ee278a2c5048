// Numbers that carry their first and second derivative along: an author gives the energy, the SDK forms force and
// stiffness from it, exactly to rounding (forward mode, second order; no difference quotients).
//
// A model that has `energy` and no operator() is computed with them:
//
//     struct LogarithmicSpring {
//       double E;
//       explicit LogarithmicSpring(const rouleau::Parameters& p) : E{p["stretching_modulus"]} {}
//
//       template <class S>
//       S energy(const rouleau::Segment<S>& segment) const {
//         const S e = segment.stretch;
//         return 0.25 * E * (e * e - 1.0 - 2.0 * log(e));
//       }
//     };
//     ROULEAU_MEMBRANE(LogarithmicSpring, "org.example.logarithmic-spring", "1.0.0")
//
// The argument is the distance of an interaction (`S energy(const S& distance)`), or a membrane's Segment, Vertex or
// Cell; what the energy does not change with (stretch_rate, rest_curvature, ...) is constant. Models with state or with
// forces that have no energy write operator() instead. What it costs stands in share/rouleau/sdk/README.md.
#pragma once

#include "functions.hpp"

namespace rouleau {

/// A value and its derivatives by the model's argument. S is a pack, or a plain number.
/// Where a function has no derivative (sqrt at 0, a fractional power at 0), the derivative is infinite or NaN; abs,
/// min, max and select have the derivative of the side that is taken.
template <class S>
struct Dual {
  S value;
  S first = S(0.0);   ///< d value / d argument
  S second = S(0.0);  ///< d^2 value / d argument^2

  Dual() = default;
  /// A constant.
  template <class A, class = std::enable_if_t<std::is_arithmetic_v<A>>>
  ROULEAU_ALWAYS_INLINE Dual(A constant) : value(constant) {}
  ROULEAU_ALWAYS_INLINE Dual(const S& v, const S& by_argument, const S& second_derivative)
      : value(v), first(by_argument), second(second_derivative) {}

  /// A constant with a value of its own for each element.
  ROULEAU_ALWAYS_INLINE static Dual constant(const S& v) { return {v, S(0.0), S(0.0)}; }
  /// What is derived by.
  ROULEAU_ALWAYS_INLINE static Dual argument(const S& v) { return {v, S(1.0), S(0.0)}; }
  /// f(x) from the values of f and its first two derivatives at x.
  ROULEAU_ALWAYS_INLINE static Dual chain(const Dual& x, const S& f, const S& df, const S& ddf) {
    return {f, df * x.first, ddf * (x.first * x.first) + df * x.second};
  }

  ROULEAU_ALWAYS_INLINE friend Dual operator-(const Dual& a) { return {-a.value, -a.first, -a.second}; }
  ROULEAU_ALWAYS_INLINE friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.first + b.first, a.second + b.second};
  }
  ROULEAU_ALWAYS_INLINE friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.first - b.first, a.second - b.second};
  }
  ROULEAU_ALWAYS_INLINE friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + 2.0 * (a.first * b.first) + a.value * b.second};
  }
  ROULEAU_ALWAYS_INLINE friend Dual operator/(const Dual& a, const Dual& b) {
    const S inverse = 1.0 / b.value, quotient = a.value / b.value, slope = (a.first - quotient * b.first) * inverse;
    return {quotient, slope, (a.second - 2.0 * (slope * b.first) - quotient * b.second) * inverse};
  }
  // With plain numbers, whose derivatives need no arithmetic.
  ROULEAU_ALWAYS_INLINE friend Dual operator+(const Dual& a, double b) { return {a.value + b, a.first, a.second}; }
  ROULEAU_ALWAYS_INLINE friend Dual operator+(double a, const Dual& b) { return b + a; }
  ROULEAU_ALWAYS_INLINE friend Dual operator-(const Dual& a, double b) { return {a.value - b, a.first, a.second}; }
  ROULEAU_ALWAYS_INLINE friend Dual operator-(double a, const Dual& b) { return {a - b.value, -b.first, -b.second}; }
  ROULEAU_ALWAYS_INLINE friend Dual operator*(const Dual& a, double b) {
    return {a.value * b, a.first * b, a.second * b};
  }
  ROULEAU_ALWAYS_INLINE friend Dual operator*(double a, const Dual& b) { return b * a; }
  ROULEAU_ALWAYS_INLINE friend Dual operator/(const Dual& a, double b) {
    return {a.value / b, a.first / b, a.second / b};
  }
  ROULEAU_ALWAYS_INLINE friend Dual operator/(double a, const Dual& b) {
    const S inverse = 1.0 / b.value, square = inverse * inverse;
    return chain(b, a * inverse, -a * square, 2.0 * a * (square * inverse));
  }
  ROULEAU_ALWAYS_INLINE Dual& operator+=(const Dual& b) { return *this = *this + b; }
  ROULEAU_ALWAYS_INLINE Dual& operator-=(const Dual& b) { return *this = *this - b; }
  ROULEAU_ALWAYS_INLINE Dual& operator*=(const Dual& b) { return *this = *this * b; }

  ROULEAU_ALWAYS_INLINE friend auto operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  ROULEAU_ALWAYS_INLINE friend auto operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  ROULEAU_ALWAYS_INLINE friend auto operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
  ROULEAU_ALWAYS_INLINE friend auto operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }
  template <class Mask>
  ROULEAU_ALWAYS_INLINE friend Dual select(const Mask& mask, const Dual& a, const Dual& b) {
    return {select(mask, a.value, b.value), select(mask, a.first, b.first), select(mask, a.second, b.second)};
  }
  ROULEAU_ALWAYS_INLINE friend Dual min(const Dual& a, const Dual& b) { return select(a < b, a, b); }
  ROULEAU_ALWAYS_INLINE friend Dual max(const Dual& a, const Dual& b) { return select(a > b, a, b); }
  ROULEAU_ALWAYS_INLINE friend Dual abs(const Dual& a) { return select(a.value < S(0.0), -a, a); }

  ROULEAU_ALWAYS_INLINE friend Dual sqrt(const Dual& a) { return sqrt_and_inverse(a).root; }
  ROULEAU_ALWAYS_INLINE friend SquareRoot<Dual> sqrt_and_inverse(const Dual& a) {
    const S root = sqrt(a.value), y = 1.0 / root, cube = y * (y * y);
    return {chain(a, root, 0.5 * y, -0.25 * cube), chain(a, y, -0.5 * cube, 0.75 * (cube * (y * y)))};
  }
  ROULEAU_ALWAYS_INLINE friend Dual exp(const Dual& a) {
    const S f = exp(a.value);
    return chain(a, f, f, f);
  }
  ROULEAU_ALWAYS_INLINE friend Dual log(const Dual& a) {
    const S inverse = 1.0 / a.value;
    return chain(a, log(a.value), inverse, -(inverse * inverse));
  }
  ROULEAU_ALWAYS_INLINE friend Dual expm1(const Dual& a) {
    const S f = exp(a.value);
    return chain(a, expm1(a.value), f, f);
  }
  ROULEAU_ALWAYS_INLINE friend Dual log1p(const Dual& a) {
    const S inverse = 1.0 / (1.0 + a.value);
    return chain(a, log1p(a.value), inverse, -(inverse * inverse));
  }
  ROULEAU_ALWAYS_INLINE friend Dual sin(const Dual& a) {
    const S f = sin(a.value);
    return chain(a, f, cos(a.value), -f);
  }
  ROULEAU_ALWAYS_INLINE friend Dual cos(const Dual& a) {
    const S f = cos(a.value);
    return chain(a, f, -sin(a.value), -f);
  }
  ROULEAU_ALWAYS_INLINE friend Dual tanh(const Dual& a) {
    const S f = tanh(a.value), slope = (1.0 - f) * (1.0 + f);
    return chain(a, f, slope, -2.0 * (f * slope));
  }
  ROULEAU_ALWAYS_INLINE friend Dual erf(const Dual& a) {
    const S slope = 1.1283791670955126 * exp(-(a.value * a.value));  // 2 / sqrt(pi)
    return chain(a, erf(a.value), slope, -2.0 * (a.value * slope));
  }
  /// A power with one exponent for all elements; of 0 too, where it is 1 or 2 or more.
  ROULEAU_ALWAYS_INLINE friend Dual pow(const Dual& a, double exponent) {
    const S f = pow(a.value, exponent);
    const auto is_zero = (a.value <= S(0.0)) & (a.value >= S(0.0));
    const double factor = exponent * (exponent - 1.0);
    const S at = select(is_zero, S(1.0), a.value), df = exponent * f / at, ddf = (exponent - 1.0) * df / at;
    return chain(a, f, select(is_zero, S(power_of_zero(exponent, exponent - 1.0)), df),
                 select(is_zero, S(power_of_zero(factor, exponent - 2.0)), ddf));
  }
  /// A power of positive numbers.
  ROULEAU_ALWAYS_INLINE friend Dual pow(const Dual& a, const Dual& b) {
    const Dual u = b * log(a);
    const S f = pow(a.value, b.value);
    return {f, f * u.first, f * (u.second + u.first * u.first)};
  }
  ROULEAU_ALWAYS_INLINE friend Dual pow(double a, const Dual& b) {
    const S f = pow(S(a), b.value);
    const double logarithm = std::log(a);
    return chain(b, f, logarithm * f, logarithm * logarithm * f);
  }

 private:
  /// factor times 0^exponent, where a factor of 0 makes it 0.
  static constexpr double power_of_zero(double factor, double exponent) {
    return factor == 0 || exponent > 0 ? 0 : exponent < 0 ? factor * __builtin_huge_val() : factor;
  }
};

namespace detail {

/// Whether a model gives an energy of this argument with derivatives, and is to be derived.
template <class Model, class Argument, class = void>
struct GivesEnergy : std::false_type {};
template <class Model, class Argument>
struct GivesEnergy<Model, Argument,
                   std::void_t<decltype(std::declval<const Model&>().energy(std::declval<Argument>()))>>
    : std::true_type {};

}  // namespace detail

}  // namespace rouleau
