// What the packings of two and of three dimensions share: places, random numbers, and a rigid cell somewhere.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace rouleau::shape {

// Everything here is made of additions, products, quotients and square roots of numbers that were rounded to multiples
// of a power of two, and compiled without contraction: the same on every machine, whatever its libm and instruction set
// (a cosine's last digit differs between libraries). Plain structures instead of Eigen's vectors, whose functions the
// linker may take from a file that was compiled with contraction.

template <int D>
using Place = std::array<double, D>;

inline Place<3> minus(const Place<3>& a, const Place<3>& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Place<3>& a, const Place<3>& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double norm(const Place<3>& a) { return std::sqrt(dot(a, a)); }

struct Pair {
  double x, y;
};

/// To a multiple of 2^-24.
inline double rounded(double value) { return std::ldexp(std::round(std::ldexp(value, 24)), -24); }

/// Cosine and sine rounded to multiples of 2^-24.
inline Pair direction_of(double angle) { return {rounded(std::cos(angle)), rounded(std::sin(angle))}; }

/// Angles are multiples of 2 pi over this.
inline constexpr std::uint32_t whole_turn = 1U << 20;
inline double radians(std::uint32_t angle) { return angle * (2 * std::numbers::pi / whole_turn); }
/// An angle and a part of a whole turn more.
inline std::uint32_t turned_by(std::uint32_t angle, double turn) {
  return static_cast<std::uint32_t>(angle + static_cast<std::int64_t>(turn * whole_turn)) % whole_turn;
}

/// Uniform numbers with the same bits everywhere: std::uniform_real_distribution is each library's own.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::seed_seq& seeds) : engine_(seeds) {}
  double below_one() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double either_side(double most) { return most * (2 * below_one() - 1); }
  std::uint32_t angle() { return static_cast<std::uint32_t>(engine_() >> 44); }

 private:
  std::mt19937_64 engine_;
};

/// A cell's solid (RigidOutline, RigidSurface) somewhere: point p of it lies at center + scale (turned p).
template <class Solid>
struct RigidBody {
  const Solid* solid;
  Place<Solid::dimension> center;
  typename Solid::Orientation orientation;
  double scale = 1;
  [[nodiscard]] double radius() const { return scale * solid->radius(); }
};

}  // namespace rouleau::shape
