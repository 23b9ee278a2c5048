// Multiple relaxation times: energy, energy square and heat flux relax at rates of their own, the stresses at omega.
// Lallemand and Luo (Phys. Rev. E 61:6546, 2000), and d'Humieres and others (Phil. Trans. R. Soc. A 360:437, 2002) in
// three dimensions, their moments; there the fourth-order moments pi relax as the stresses do, and the third-order
// moments m as the heat flux. Moment k of Guo's source is multiplied by 1 - s_k/2.
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
  ROULEAU_ALWAYS_INLINE void operator()(const Node& node, const Rates<S>& rate,
                                        S (&after)[Node::velocity_count]) const {
    const auto& f = node.f;
    // e - e_eq + S_e/2, the same of epsilon, and what they give beyond relaxation at the shear rate.
    S axes = f[1] + f[3], diagonals = f[5] + f[7];
    axes += f[2] + f[4], diagonals += f[6] + f[8];
    S speeds = S(0);
    if constexpr (Node::inertia) {
      speeds = node.dot(node.velocity, node.velocity);
      if constexpr (Node::forced) speeds -= node.dot(node.velocity, node.force);
    }
    S e, epsilon, at_rest, on_axes, on_diagonals;
    if constexpr (Node::dimension == 2) {
      e = 4.0 * diagonals + axes - 2.0 * f[0], epsilon = 3.0 * (f[0] - axes);
      if constexpr (Node::inertia) e -= 3.0 * speeds, epsilon += 3.0 * speeds;
      e *= (rate.shear - rate.energy) * (1.0 / 36.0);
      epsilon *= (rate.shear - rate.energy_square) * (1.0 / 36.0);
      at_rest = 4.0 * (epsilon - e), on_axes = -(e + 2.0 * epsilon), on_diagonals = 2.0 * e + epsilon;
    } else {
      axes += f[9] + f[10];
      for (int q = 11; q < 19; ++q) diagonals += f[q];
      e = 19.0 * (diagonals - f[0]), epsilon = 9.0 * f[0] - 7.0 * axes - 2.0 * diagonals;
      if constexpr (Node::inertia) e -= 19.0 * speeds, epsilon += 5.5 * speeds;
      e *= (rate.shear - rate.energy) * (1.0 / 2394.0);
      epsilon *= (rate.shear - rate.energy_square) * (1.0 / 252.0);
      at_rest = 12.0 * epsilon - 30.0 * e, on_axes = -(11.0 * e + 4.0 * epsilon), on_diagonals = 8.0 * e + epsilon;
    }

    const S keep_even = 0.5 - 0.5 * rate.shear, keep_odd = 0.5 - 0.5 * rate.heat_flux;
    after[0] = 2.0 * keep_even * f[0] + node.even_gain(0, rate.shear) + at_rest;
    Node::for_each_pair([&](auto q) {
      constexpr int opposite = Node::opposite[q];
      const S even = keep_even * (f[q] + f[opposite]) + node.even_gain(q, rate.shear) +
                     (is_axis<Node>(q) ? on_axes : on_diagonals);
      const S odd = keep_odd * (f[q] - f[opposite]) + node.odd_gain(q, rate.heat_flux);
      after[q] = even + odd;
      after[opposite] = even - odd;
    });
  }

 private:
  template <class Node>
  static constexpr bool is_axis(int q) {
    return q < 5 || q == 9;  // of each pair
  }
};
ROULEAU_COLLISION(Mrt, "mrt", "1.0.0")
