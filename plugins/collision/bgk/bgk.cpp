// Single-relaxation-time collision: f' = f - omega (f - f_eq) + (1 - omega/2) S.
// Bhatnagar, Gross and Krook (Phys. Rev. 94, 1954); Qian, d'Humieres and Lallemand (Europhys. Lett. 17, 1992).
#include <rouleau/collision.hpp>

struct Bgk {
  explicit Bgk(const rouleau::Parameters&) {}

  template <class Node, class S>
  void operator()(const Node& node, S (&after)[9]) const {
    const S omega = node.relaxation_rate, source_factor = 1.0 - 0.5 * omega;
    rouleau::d2q9::for_each_velocity([&](auto q) {
      after[q] = node.f[q] - omega * (node.f[q] - node.even_equilibrium(q) - node.odd_equilibrium(q));
      if constexpr (Node::forced) after[q] += source_factor * node.odd_source(q);
      if constexpr (Node::forced && Node::inertia) after[q] += source_factor * node.even_source(q);
    });
  }
};
ROULEAU_COLLISION(Bgk, "bgk", "1.0.0")
