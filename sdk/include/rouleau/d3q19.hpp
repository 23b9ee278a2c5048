// The D3Q19 velocity set: order, weights, opposites. The first nine velocities are those of D2Q9, with z = 0.
#pragma once

#include <type_traits>
#include <utility>

namespace rouleau::d3q19 {

inline constexpr int velocity_count = 19;
inline constexpr double sound_speed_squared = 1.0 / 3.0;

/// Components of each velocity: those of D2Q9; +z and -z; the diagonals across y, then those across x,
/// counter-clockwise from (1, 0, 1) and (0, 1, 1).
inline constexpr int velocity[19][3] = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0},   {-1, 0, 0},  {0, -1, 0},
                                        {1, 1, 0},  {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0},  {0, 0, 1},
                                        {0, 0, -1}, {1, 0, 1},  {-1, 0, 1},  {-1, 0, -1}, {1, 0, -1},
                                        {0, 1, 1},  {0, -1, 1}, {0, -1, -1}, {0, 1, -1}};
inline constexpr double weight[19] = {1.0 / 3.0,  1.0 / 18.0, 1.0 / 18.0, 1.0 / 18.0, 1.0 / 18.0,
                                      1.0 / 36.0, 1.0 / 36.0, 1.0 / 36.0, 1.0 / 36.0, 1.0 / 18.0,
                                      1.0 / 18.0, 1.0 / 36.0, 1.0 / 36.0, 1.0 / 36.0, 1.0 / 36.0,
                                      1.0 / 36.0, 1.0 / 36.0, 1.0 / 36.0, 1.0 / 36.0};
/// velocity[opposite[q]] == -velocity[q].
inline constexpr int opposite[19] = {0, 3, 4, 1, 2, 7, 8, 5, 6, 10, 9, 13, 14, 11, 12, 17, 18, 15, 16};

namespace detail {
template <class Function, int... q>
inline __attribute__((always_inline)) void for_each(Function& function, std::integer_sequence<int, q...>) {
  (function(std::integral_constant<int, q>{}), ...);
}
}  // namespace detail

/// Calls function(q) with q = 0..18 as compile-time constants, so that populations stay in registers.
template <class Function>
inline __attribute__((always_inline)) void for_each_velocity(Function&& function) {
  detail::for_each(function, std::make_integer_sequence<int, velocity_count>{});
}

/// Calls function(q) for one velocity q of each pair of opposites.
template <class Function>
inline __attribute__((always_inline)) void for_each_pair(Function&& function) {
  detail::for_each(function, std::integer_sequence<int, 1, 2, 5, 6, 9, 11, 12, 15, 16>{});
}

}  // namespace rouleau::d3q19

namespace rouleau {

/// The same as a type, for what is written for several velocity sets.
struct D3Q19 {
  static constexpr int dimension = 3, velocity_count = d3q19::velocity_count;
  static constexpr const auto& velocity = d3q19::velocity;
  static constexpr const auto& weight = d3q19::weight;
  static constexpr const auto& opposite = d3q19::opposite;

  template <class Function>
  __attribute__((always_inline)) static void for_each_velocity(Function&& function) {
    d3q19::for_each_velocity(std::forward<Function>(function));
  }
  template <class Function>
  __attribute__((always_inline)) static void for_each_pair(Function&& function) {
    d3q19::for_each_pair(std::forward<Function>(function));
  }
};

}  // namespace rouleau
