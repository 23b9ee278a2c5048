// Central moments: n = f - f_eq + S/2 relaxes in the frame that moves with the fluid; f' = f_eq + S/2 + what is left of
// n. f_eq and S have the moments of a Maxwellian and of its shift by the force. Geier, Greiner and Korvink (Phys. Rev.
// E 73:066705, 2006); Premnath and Banerjee (Phys. Rev. E 80:036702, 2009); De Rosis (Phys. Rev. E 95:023311, 2017).
// Without inertia the change of frame, second order in u, is left out: a scheme of raw moments x^a y^b remains. D3Q19
// has the moments of the planes xy, xz and yz, each with those of D2Q9, and no others; a change of frame keeps them
// apart.
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

  /// Of one plane, x and y standing for its directions.
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
    /// In two dimensions; the trace of the stress is xx + yy.
    ROULEAU_ALWAYS_INLINE Moments relaxed(const Kept<S>& keep) const {
      const S sum = 0.5 * keep.bulk * (xx + yy), difference = 0.5 * keep.shear * (xx - yy);
      return {sum + difference, keep.shear * xy,  sum - difference,
              keep.third * xxy, keep.third * xyy, keep.fourth * xxyy};
    }
    /// `pressure`: what the trace keeps beyond what the shear stress does, by direction.
    ROULEAU_ALWAYS_INLINE Moments relaxed(const Kept<S>& keep, const S& pressure) const {
      return {keep.shear * xx + pressure, keep.shear * xy,  keep.shear * yy + pressure,
              keep.third * xxy,           keep.third * xyy, keep.fourth * xxyy};
    }
  };

  /// Directions of a plane, and the first of the four velocities between them, which go round counter-clockwise.
  struct Plane {
    int x, y, first;
  };
  static constexpr Plane planes[3] = {{0, 1, 5}, {0, 2, 11}, {1, 2, 15}};
  static constexpr int along[3] = {1, 2, 9};  ///< velocity of each direction

  template <class Node, class S>
  ROULEAU_ALWAYS_INLINE void operator()(const Node& node, const Kept<S>& keep, S (&after)[Node::velocity_count]) const {
    constexpr int dimension = Node::dimension, plane_count = dimension == 2 ? 1 : 3;
    const auto& f = node.f;
    const S none = 0.0, p = node.density * (1.0 / 3.0);
    S normal[dimension], all[plane_count];  // sums of f c_a c_a, and of all four velocities of a plane
    for (int a = 0; a < dimension; ++a) normal[a] = f[along[a]] + f[Node::opposite[along[a]]];
    for (int k = 0; k < plane_count; ++k) {
      const auto [x, y, q] = planes[k];
      all[k] = (f[q] + f[q + 2]) + (f[q + 1] + f[q + 3]);
      normal[x] = normal[x] + all[k];
      normal[y] = normal[y] + all[k];
    }
    Moments<S> towards[plane_count], left[plane_count];  // f_eq + S/2, and what is left of n
    for (int k = 0; k < plane_count; ++k) {
      const auto [x, y, q] = planes[k];
      const S u = node.velocity[x], v = node.velocity[y];
      S g = none, h = none;
      if constexpr (Node::forced) g = 0.5 * node.force[x], h = 0.5 * node.force[y];
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
        if constexpr (dimension == 3) {  // what the second order of D3Q19's equilibrium has besides
          const int z = 3 - x - y;
          const S w = node.velocity[z];
          equilibrium.xxyy = equilibrium.xxyy - (1.0 / 6.0) * w * w;
          if constexpr (Node::forced) source.xxyy = source.xxyy - (1.0 / 6.0) * w * node.force[z];
        }
      }
      const Moments<S> before{normal[x],
                              (f[q] + f[q + 2]) - (f[q + 1] + f[q + 3]),
                              normal[y],
                              (f[q] - f[q + 2]) + (f[q + 1] - f[q + 3]),
                              (f[q] - f[q + 2]) - (f[q + 1] - f[q + 3]),
                              all[k]};
      towards[k] = equilibrium + source;
      left[k] = before - equilibrium + source;
      if constexpr (Node::inertia) left[k] = left[k].seen(-u, -v);
    }
    if constexpr (dimension == 2) {
      left[0] = left[0].relaxed(keep);
    } else {
      const S pressure = (keep.bulk - keep.shear) * (1.0 / 3.0) * (left[0].xx + left[0].yy + left[1].yy);
      for (int k = 0; k < plane_count; ++k) left[k] = left[k].relaxed(keep, pressure);
    }

    const auto set = [&](int q, const S& even, const S& odd) {
      after[q] = even + odd;
      after[Node::opposite[q]] = even - odd;
    };
    S rest = node.density, even[dimension], odd[dimension];  // of what lies along the directions
    for (int a = 0; a < dimension; ++a) {
      odd[a] = node.velocity[a];
      if constexpr (Node::forced) odd[a] = odd[a] + 0.5 * node.force[a];
    }
    for (int k = 0; k < plane_count; ++k) {
      const auto [x, y, q] = planes[k];
      if constexpr (Node::inertia) left[k] = left[k].seen(node.velocity[x], node.velocity[y]);
      const Moments<S> m = towards[k] + left[k];
      if (k == 0) even[x] = m.xx, rest = rest - m.xx;
      if (k < 2) even[y] = m.yy, rest = rest - m.yy;
      even[x] = even[x] - m.xxyy, even[y] = even[y] - m.xxyy, rest = rest + m.xxyy;
      odd[x] = odd[x] - m.xyy, odd[y] = odd[y] - m.xxy;
      set(q, 0.25 * (m.xxyy + m.xy), 0.25 * (m.xxy + m.xyy));
      set(q + 1, 0.25 * (m.xxyy - m.xy), 0.25 * (m.xxy - m.xyy));
    }
    after[0] = rest;
    for (int a = 0; a < dimension; ++a) set(along[a], 0.5 * even[a], 0.5 * odd[a]);
  }
};
ROULEAU_COLLISION(CentralMoment, "central-moment", "1.0.0")
