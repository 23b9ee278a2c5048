// Regularised collision: f' = w (rho + 3 c.(u + F/2) + 9/2 (cc - I/3):A), A = omega uu + (1 - omega/2)(uF + Fu) +
// (1 - omega)(sum f cc - rho I/3): all that is neither density, momentum nor stress is projected out before relaxation.
// Latt and Chopard (Math. Comput. Simul. 72:165, 2006); u holds F/2, and (uF + Fu)/2 is no part of the stress that
// stays.
#include <rouleau/collision.hpp>

struct Regularised {
  explicit Regularised(const rouleau::Parameters&) {}

  template <class Node, class S>
  ROULEAU_ALWAYS_INLINE void operator()(const Node& node, const S& omega, S (&after)[9]) const {
    const auto& f = node.f;
    const S keep = 1.0 - omega, pressure = node.density * (1.0 / 3.0);
    const S rising = f[5] + f[7], falling = f[6] + f[8];
    S xx = keep * ((f[1] + f[3]) + (rising + falling) - pressure), xy = keep * (rising - falling);
    S yy = keep * ((f[2] + f[4]) + (rising + falling) - pressure);
    S momentum[2] = {node.momentum[0], node.momentum[1]};
    if constexpr (Node::inertia) {
      // omega uu + (1 - omega/2)(uF + Fu) = (h u)v + (v h)u with h = omega u/2 + (1 - omega/2) F and v = u.
      S half[2] = {0.5 * omega * node.velocity[0], 0.5 * omega * node.velocity[1]};
      if constexpr (Node::forced) {
        half[0] += (1.0 - 0.5 * omega) * node.force[0];
        half[1] += (1.0 - 0.5 * omega) * node.force[1];
      }
      xx += 2.0 * half[0] * node.velocity[0];
      xy += half[0] * node.velocity[1] + half[1] * node.velocity[0];
      yy += 2.0 * half[1] * node.velocity[1];
    }
    if constexpr (Node::forced) {
      momentum[0] += node.force[0];
      momentum[1] += node.force[1];
    }
    const S even = node.density - 1.5 * (xx + yy);
    after[0] = rouleau::d2q9::weight[0] * even;
    rouleau::d2q9::for_each_pair([&](auto q) {
      const S sum = even + 4.5 * node.project(q, {node.project(q, {xx, xy}), node.project(q, {xy, yy})});
      const S difference = 3.0 * node.project(q, momentum);
      after[q] = rouleau::d2q9::weight[q] * (sum + difference);
      after[rouleau::d2q9::opposite[q]] = rouleau::d2q9::weight[q] * (sum - difference);
    });
  }
};
ROULEAU_COLLISION(Regularised, "regularised", "1.0.0")
