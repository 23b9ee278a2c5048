// Hooke's law: energy w = E/2 (e - 1)^2 per rest length at the stretch e, tension T = dw/de = E (e - 1).
// In three dimensions the principal tensions are linear in the stretches l1 and l2:
//   w = E/(2 (1 - nu^2)) [(l1 - 1)^2 + (l2 - 1)^2 + 2 nu (l1 - 1)(l2 - 1)] per rest area,
// so that a strip that contracts freely has the tension E (l1 - 1) per width at rest. With p = l1 l2 and q = l1 + l2,
//   w = E/(2 (1 - nu^2)) [I1 + 4 + 2 nu (p + 1) - 2 (1 + nu) q],  p^2 = I2 + 1,  q^2 = I1 + 2 + 2 p.
#include <rouleau/membrane.hpp>

struct Hooke {
  double E, nu;
  explicit Hooke(const rouleau::Parameters& p) : E{p["stretching_modulus"]}, nu{p["poisson_ratio"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S strain = segment.stretch - 1.0;
    return {0.5 * E * strain * strain, E * strain, S(E)};
  }

  template <class S>
  rouleau::Stress<S> operator()(const rouleau::Triangle<S>& triangle) const {
    const double K = 0.5 * E / (1 - nu * nu);
    const S p = sqrt(triangle.invariant_2 + 1.0), q = sqrt(triangle.invariant_1 + 2.0 + 2.0 * p);
    const S by_p = 1.0 / p, by_q = 1.0 / q, slope = (0.5 * K * (1 + nu)) * by_q * by_q * by_q;
    return {K * (triangle.invariant_1 + 4.0 + (2 * nu) * (p + 1.0) - (2 * (1 + nu)) * q),
            K * (1.0 - (1 + nu) * by_q),
            K * by_p * (nu - (1 + nu) * by_q),
            slope,
            slope * by_p,
            by_p * by_p * (slope + (0.5 * K) * by_p * ((1 + nu) * by_q - nu))};
  }
};
ROULEAU_MEMBRANE(Hooke, "hooke", "1.1.0")
