// Membrane of Lim, Wortis and Mukhopadhyay (Proc. Natl. Acad. Sci. 99, 2002; Soft Matter 4, 2008, ch. 2): a skeleton that
// stiffens when it is sheared or compressed. Energy per rest area, J = l1 l2 the area over that at rest:
//   w = Ka/2 (alpha^2 + a3 alpha^3 + a4 alpha^4) + mu (beta + b1 alpha beta + b2 beta^2)
//   alpha = J - 1 = sqrt(1 + I2) - 1,   beta = (l1 - l2)^2/(2 J) = (I1 + 2)/(2 J) - 1
#include <rouleau/membrane.hpp>

struct Lim {
  double Ka, mu, a3, a4, b1, b2;
  explicit Lim(const rouleau::Parameters& p)
      : Ka{p["area_modulus"]}, mu{p["shear_modulus"]}, a3{p["a3"]}, a4{p["a4"]}, b1{p["b1"]}, b2{p["b2"]} {}

  template <class S>
  rouleau::Stress<S> operator()(const rouleau::Triangle<S>& triangle) const {
    const S J = sqrt(1.0 + triangle.invariant_2), over = 1.0 / J, alpha = J - 1.0;
    const S beta = 0.5 * (triangle.invariant_1 + 2.0) * over - 1.0;
    // Of w by alpha and beta, and of these by I1 and I2.
    const S w_a = Ka * alpha * (1.0 + alpha * (1.5 * a3 + 2.0 * a4 * alpha)) + mu * b1 * beta;
    const S w_b = mu * (1.0 + b1 * alpha + 2.0 * b2 * beta);
    const S w_aa = Ka * (1.0 + alpha * (3.0 * a3 + 6.0 * a4 * alpha));
    const S a_2 = 0.5 * over, b_1 = a_2, cube = a_2 * over * over, b_2 = -(beta + 1.0) * a_2 * over;
    return {Ka * 0.5 * alpha * alpha * (1.0 + alpha * (a3 + a4 * alpha)) + mu * beta * (1.0 + b1 * alpha + b2 * beta),
            w_b * b_1,
            w_a * a_2 + w_b * b_2,
            2.0 * mu * b2 * b_1 * b_1,
            b_1 * (mu * b1 * a_2 + 2.0 * mu * b2 * b_2) - 0.5 * w_b * cube,
            a_2 * (w_aa * a_2 + 2.0 * mu * b1 * b_2) + 2.0 * mu * b2 * b_2 * b_2 - 0.5 * w_a * cube +
                1.5 * w_b * (beta + 1.0) * cube * over};
  }
};
ROULEAU_MEMBRANE(Lim, "lim", "1.0.0")
