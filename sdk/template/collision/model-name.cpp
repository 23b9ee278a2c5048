// Collision with one rate for the shear stress, omega = 1/tau, and another for what changes its sign with the velocity:
// the even and odd parts of opposite populations relax each with its own. With the same rate for both it is that of
// Bhatnagar, Gross and Krook. After Ginzburg, Verhaeghe and d'Humieres (Commun. Comput. Phys. 3, 2008).
#include <rouleau/collision.hpp>

struct ModelType {
  double odd_rate;
  explicit ModelType(const rouleau::Parameters& p) : odd_rate{p["odd_rate"]} {}

  template <class Node, class S>
  void operator()(const Node& node, const S& omega, S (&after)[Node::velocity_count]) const {
    const S odd = odd_rate;
    Node::for_each_velocity([&](auto q) {
      const S& f = node.f[q];
      const S& opposite = node.f[Node::opposite[q]];
      after[q] = 0.5 * (1.0 - omega) * (f + opposite) + node.even_gain(q, omega) + 0.5 * (1.0 - odd) * (f - opposite) +
                 node.odd_gain(q, odd);
    });
  }
};
ROULEAU_COLLISION(ModelType, "model-id", "1.0.0")
