// Two-relaxation-time collision: even and odd parts of a velocity pair relax at rates omega and omega_odd, with
// (1/omega - 1/2)(1/omega_odd - 1/2) = magic. Ginzburg, Verhaeghe and d'Humieres (Commun. Comput. Phys. 3, 2008).
#include <rouleau/collision.hpp>

struct Trt {
  double magic;
  explicit Trt(const rouleau::Parameters& p) : magic{p["magic"]} {}

  template <class S>
  struct Rates {
    S even, odd;
  };
  template <class S>
  Rates<S> rates(const S& omega) const {
    return {omega, 2.0 * (2.0 - omega) / (4.0 * magic * omega + (2.0 - omega))};
  }

  template <class Node, class S>
  void operator()(const Node& node, const Rates<S>& rate, S (&after)[9]) const {
    const S keep_even = 0.5 - 0.5 * rate.even, keep_odd = 0.5 - 0.5 * rate.odd;
    after[0] = 2.0 * keep_even * node.f[0] + node.even_gain(0, rate.even);
    rouleau::d2q9::for_each_pair([&](auto q) {
      constexpr int opposite = rouleau::d2q9::opposite[q];
      const S even = keep_even * (node.f[q] + node.f[opposite]) + node.even_gain(q, rate.even);
      const S odd = keep_odd * (node.f[q] - node.f[opposite]) + node.odd_gain(q, rate.odd);
      after[q] = even + odd;
      after[opposite] = even - odd;
    });
  }
};
ROULEAU_COLLISION(Trt, "trt", "1.0.0")
