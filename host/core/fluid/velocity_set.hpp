// The velocity sets of lattices, as types. Their numbers are the SDK's, where models find them, too.
#pragma once

#include <rouleau/d2q9.hpp>
#include <utility>

namespace rouleau::core {

struct D2Q9 {
  static constexpr int dimension = 2, velocity_count = d2q9::velocity_count;
  static constexpr const auto& velocity = d2q9::velocity;
  static constexpr const auto& weight = d2q9::weight;
  static constexpr const auto& opposite = d2q9::opposite;

  /// Calls function(q) with every q as a compile-time constant.
  template <class Function>
  [[gnu::always_inline]] static void for_each_velocity(Function&& function) {
    d2q9::for_each_velocity(std::forward<Function>(function));
  }
};

}  // namespace rouleau::core
