// The loop that looks for the largest speed and sums the mass, for any width of vector registers.
#pragma once

#include <algorithm>
#include <rouleau/collision.hpp>

#include "core/domain/exact_sum.hpp"
#include "lattice.hpp"

namespace rouleau::core {

/// Nodes of one span of a row, and what was found.
template <class T, class Set>
struct MassAndSpeedTask {
  const T* in[Set::velocity_count];
  const T* force[Set::dimension];  // per node, or null
  T body_force[Set::dimension];
  int count;
  double mass[2];  // parts of an exact sum of the densities (ExactSum)
  double speed_square, zero;
};

/// Sum of the densities, largest speed; `zero` becomes NaN with the first value that is not finite.
template <class T, class Set>
struct FindMassAndSpeed {
  using Task = MassAndSpeedTask<T, Set>;
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(Task* task) {
    constexpr int width = register_bytes / sizeof(T);
    const Task t = *task;
    const int whole = t.count / width * width;
    sweep<Pack<T, width>>(t, 0, whole, *task);
    sweep<Pack<T, 1>>(t, whole, t.count, *task);
  }

 private:
  template <class S>
  ROULEAU_ALWAYS_INLINE static void sweep(const Task& t, int begin, int end, Task& result) {
    using Wide = typename Pack<double, S::size>::Vector;
    Wide mass_high{}, mass_low{};
    S fastest = 0, zero = 0;
    for (int x = begin; x < end; x += S::size) {
      Node<Set, S, true, false> node;
      Set::for_each_velocity([&](auto q) { node.f[q] = S::load(t.in[q] + x); });
      for (int k = 0; k < Set::dimension; ++k)
        node.force[k] = t.force[k] != nullptr ? S::load(t.force[k] + x) : S(t.body_force[k]);
      node.compute_moments();
      const S square = node.dot(node.velocity, node.velocity);
      const Wide density = __builtin_convertvector(node.density.vector, Wide);
      const Wide part = ExactSum::high_part(density);
      mass_high += part;
      mass_low += ExactSum::low_part(Wide(density - part));
      fastest = max(fastest, square);
      zero += (square - square) + (node.density - node.density);
    }
    for (int k = 0; k < S::size; ++k) {
      result.mass[0] += mass_high[k];
      result.mass[1] += mass_low[k];
      result.speed_square = std::max(result.speed_square, static_cast<double>(fastest.vector[k]));
      result.zero += static_cast<double>(zero.vector[k]);
    }
  }
};

}  // namespace rouleau::core
