// Central moments: n = f - f_eq + S/2 relaxes in the frame that moves with the fluid; f' = f_eq + S/2 + what is left of
// n. f_eq and S have the moments of a Maxwellian and of its shift by the force. Geier, Greiner and Korvink (Phys. Rev.
// E 73:066705, 2006); Premnath and Banerjee (Phys. Rev. E 80:036702, 2009); De Rosis (Phys. Rev. E 95:023311, 2017).
// Without inertia the change of frame, second order in u, is left out: a scheme of raw moments x^a y^b remains.
#include <rouleau/collision.hpp>

struct CentralMoment {
  double bulk, third, fourth, magic;
  explicit CentralMoment(const rouleau::Parameters& p)
      : bulk{p["bulk_rate"]}, third{p["third_order_rate"]}, fourth{p["fourth_order_rate"]}, magic{p["magic"]} {
    if (third > 0 && magic > 0) throw std::invalid_argument("a third_order_rate is used with \"magic\": 0 only");
  }

  /// What is left of a moment: 1 - rate.
  template <class S>
  struct Kept {
    S shear, bulk, third, fourth;
  };
  template <class S>
  Kept<S> rates(const S& omega) const {
    const auto keep = [&](double rate) { return 1.0 - (rate > 0 ? S(rate) : omega); };
    return {1.0 - omega, keep(bulk),
            magic > 0 ? 1.0 - 2.0 * (2.0 - omega) / (4.0 * magic * omega + (2.0 - omega)) : keep(third), keep(fourth)};
  }

  template <class S>
  struct Moments {
    S xx, xy, yy, xxy, xyy, xxyy;
    ROULEAU_ALWAYS_INLINE friend Moments operator+(const Moments& a, const Moments& b) {
      return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy, a.xxy + b.xxy, a.xyy + b.xyy, a.xxyy + b.xxyy};
    }
    ROULEAU_ALWAYS_INLINE friend Moments operator-(const Moments& a, const Moments& b) {
      return {a.xx - b.xx, a.xy - b.xy, a.yy - b.yy, a.xxy - b.xxy, a.xyy - b.xyy, a.xxyy - b.xxyy};
    }
    /// Moments of the same populations, without mass and momentum, when all velocities grow by (u, v).
    ROULEAU_ALWAYS_INLINE Moments seen(const S& u, const S& v) const {
      const S four = xxyy + 2.0 * (u * xyy + v * xxy) + u * u * yy + v * v * xx + 4.0 * u * v * xy;
      return {xx, xy, yy, xxy + 2.0 * u * xy + v * xx, xyy + 2.0 * v * xy + u * yy, four};
    }
    ROULEAU_ALWAYS_INLINE Moments relaxed(const Kept<S>& keep) const {
      const S sum = 0.5 * keep.bulk * (xx + yy), difference = 0.5 * keep.shear * (xx - yy);
      return {sum + difference, keep.shear * xy,  sum - difference,
              keep.third * xxy, keep.third * xyy, keep.fourth * xxyy};
    }
  };

  template <class Node, class S>
  ROULEAU_ALWAYS_INLINE void operator()(const Node& node, const Kept<S>& keep, S (&after)[9]) const {
    const auto& f = node.f;
    const S u = node.velocity[0], v = node.velocity[1], none = 0.0;
    S g = none, h = none;
    if constexpr (Node::forced) g = 0.5 * node.force[0], h = 0.5 * node.force[1];
    const S p = node.density * (1.0 / 3.0), x = u + g, y = v + h, all = (f[5] + f[7]) + (f[6] + f[8]);
    Moments<S> equilibrium{p, none, p, v * (1.0 / 3.0), u * (1.0 / 3.0), p * (1.0 / 3.0)};
    Moments<S> source{none, none, none, h * (1.0 / 3.0), g * (1.0 / 3.0), none};
    if constexpr (Node::inertia) {
      const S uu = u * u, vv = v * v, uv = u * v, ug = 2.0 * u * g, vh = 2.0 * v * h;
      equilibrium = equilibrium + Moments<S>{uu, uv, vv, uu * v, u * vv, (uu + vv) * (1.0 / 3.0) + uu * vv};
      if constexpr (Node::forced) {
        source =
            source +
            Moments<S>{
                ug, u * h + v * g, vh, uu * h + ug * v, vv * g + vh * u, (ug + vh) * (1.0 / 3.0) + ug * vv + vh * uu};
      }
    }
    Moments<S> left{f[1] + f[3] + all,
                    (f[5] + f[7]) - (f[6] + f[8]),
                    f[2] + f[4] + all,
                    (f[5] - f[7]) + (f[6] - f[8]),
                    (f[5] - f[7]) - (f[6] - f[8]),
                    all};
    left = left - equilibrium + source;
    if constexpr (Node::inertia)
      left = left.seen(-u, -v).relaxed(keep).seen(u, v);
    else
      left = left.relaxed(keep);
    const Moments<S> m = equilibrium + source + left;

    const auto set = [&](int q, const S& even, const S& odd) {
      after[q] = even + odd;
      after[rouleau::d2q9::opposite[q]] = even - odd;
    };
    after[0] = node.density - m.xx - m.yy + m.xxyy;
    set(1, 0.5 * (m.xx - m.xxyy), 0.5 * (x - m.xyy));
    set(2, 0.5 * (m.yy - m.xxyy), 0.5 * (y - m.xxy));
    set(5, 0.25 * (m.xxyy + m.xy), 0.25 * (m.xxy + m.xyy));
    set(6, 0.25 * (m.xxyy - m.xy), 0.25 * (m.xxy - m.xyy));
  }
};
ROULEAU_COLLISION(CentralMoment, "central-moment", "1.0.0")
