// Multiple relaxation times: energy, energy square and heat flux relax at rates of their own, the stresses at omega.
// Lallemand and Luo (Phys. Rev. E 61:6546, 2000), their moments; moment k of Guo's source is multiplied by 1 - s_k/2.
#include <rouleau/collision.hpp>

struct Mrt {
  double energy, energy_square, heat_flux, magic;
  explicit Mrt(const rouleau::Parameters& p)
      : energy{p["energy_rate"]},
        energy_square{p["energy_square_rate"]},
        heat_flux{p["heat_flux_rate"]},
        magic{p["magic"]} {
    if (heat_flux > 0 && magic > 0) throw std::invalid_argument("a heat_flux_rate is used with \"magic\": 0 only");
  }

  template <class S>
  struct Rates {
    S shear, energy, energy_square, heat_flux;
  };
  template <class S>
  Rates<S> rates(const S& omega) const {
    const auto own = [&](double rate) { return rate > 0 ? S(rate) : omega; };
    return {omega, own(energy), own(energy_square),
            magic > 0 ? 2.0 * (2.0 - omega) / (4.0 * magic * omega + (2.0 - omega)) : own(heat_flux)};
  }

  template <class Node, class S>
  ROULEAU_ALWAYS_INLINE void operator()(const Node& node, const Rates<S>& rate, S (&after)[9]) const {
    const auto& f = node.f;
    // e - e_eq + S_e/2, the same of epsilon, and what they give beyond relaxation at the shear rate.
    const S axes = (f[1] + f[3]) + (f[2] + f[4]), diagonals = (f[5] + f[7]) + (f[6] + f[8]);
    S e = 4.0 * diagonals + axes - 2.0 * f[0], epsilon = 3.0 * (f[0] - axes);
    if constexpr (Node::inertia) {
      S speeds = node.velocity[0] * node.velocity[0] + node.velocity[1] * node.velocity[1];
      if constexpr (Node::forced) speeds -= node.velocity[0] * node.force[0] + node.velocity[1] * node.force[1];
      e -= 3.0 * speeds;
      epsilon += 3.0 * speeds;
    }
    e *= (rate.shear - rate.energy) * (1.0 / 36.0);
    epsilon *= (rate.shear - rate.energy_square) * (1.0 / 36.0);
    const S on_axes = -(e + 2.0 * epsilon), on_diagonals = 2.0 * e + epsilon;

    const S keep_even = 0.5 - 0.5 * rate.shear, keep_odd = 0.5 - 0.5 * rate.heat_flux;
    after[0] = 2.0 * keep_even * f[0] + node.even_gain(0, rate.shear) + 4.0 * (epsilon - e);
    rouleau::d2q9::for_each_pair([&](auto q) {
      constexpr int opposite = rouleau::d2q9::opposite[q];
      const S even =
          keep_even * (f[q] + f[opposite]) + node.even_gain(q, rate.shear) + (q < 5 ? on_axes : on_diagonals);
      const S odd = keep_odd * (f[q] - f[opposite]) + node.odd_gain(q, rate.heat_flux);
      after[q] = even + odd;
      after[opposite] = even - odd;
    });
  }
};
ROULEAU_COLLISION(Mrt, "mrt", "1.0.0")
