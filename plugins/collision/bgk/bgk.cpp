// Single-relaxation-time collision: f' = f - omega (f - f_eq) + (1 - omega/2) S.
// Bhatnagar, Gross and Krook (Phys. Rev. 94, 1954); Qian, d'Humieres and Lallemand (Europhys. Lett. 17, 1992).
#include <rouleau/collision.hpp>

struct Bgk {
  explicit Bgk(const rouleau::Parameters&) {}

  template <class Node, class S>
  void operator()(const Node& node, const S& omega, S (&after)[9]) const {
    const S keep = 1.0 - omega;
    rouleau::d2q9::for_each_velocity(
        [&](auto q) { after[q] = keep * node.f[q] + node.even_gain(q, omega) + node.odd_gain(q, omega); });
  }
};
ROULEAU_COLLISION(Bgk, "bgk", "1.0.0")
