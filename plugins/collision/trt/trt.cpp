// Two-relaxation-time collision: even and odd parts of a velocity pair relax at rates omega and omega_odd, with
// (1/omega - 1/2)(1/omega_odd - 1/2) = magic. Ginzburg, Verhaeghe and d'Humieres (Commun. Comput. Phys. 3, 2008).
#include <rouleau/collision.hpp>

struct Trt {
  double magic;
  explicit Trt(const rouleau::Parameters& p) : magic{p["magic"]} {}

  template <class Node, class S>
  void operator()(const Node& node, S (&after)[9]) const {
    const S omega = node.relaxation_rate;
    const S omega_odd = 2.0 * (2.0 - omega) / (4.0 * magic * omega + (2.0 - omega));
    after[0] = node.f[0] - omega * (node.f[0] - node.even_equilibrium(0));
    if constexpr (Node::forced && Node::inertia) after[0] += (1.0 - 0.5 * omega) * node.even_source(0);
    rouleau::d2q9::for_each_pair([&](auto q) {
      constexpr int opposite = rouleau::d2q9::opposite[q];
      S even = omega * (0.5 * (node.f[q] + node.f[opposite]) - node.even_equilibrium(q));
      S odd = omega_odd * (0.5 * (node.f[q] - node.f[opposite]) - node.odd_equilibrium(q));
      if constexpr (Node::forced) odd -= (1.0 - 0.5 * omega_odd) * node.odd_source(q);
      if constexpr (Node::forced && Node::inertia) even -= (1.0 - 0.5 * omega) * node.even_source(q);
      after[q] = node.f[q] - even - odd;
      after[opposite] = node.f[opposite] - even + odd;
    });
  }
};
ROULEAU_COLLISION(Trt, "trt", "1.0.0")
