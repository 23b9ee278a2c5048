// Skalak membrane: resists shear with Gs and change of area with C Gs. Tension T at the stretch e, where the stretch l
// across the plane is 1 (clamped) or follows from no tension across (free):
//   clamped  T = Gs (1+C) e (e^2 - 1), energy w = Gs (1+C) (e^2 - 1)^2 / 4 per rest length
//   free     l^2 = (1 + C e^2)/(1 + C e^4), T = Gs (e/l) [e^2 - 1 + C l^2 (e^2 l^2 - 1)]
//                                             = Gs (e/l) (e^2 - 1) [1 + C (1 + C e^2)/(1 + C e^4)^2]
// In three dimensions: w = Gs/4 (I1^2 + 2 I1 - 2 I2 + C I2^2) per rest area, which clamped becomes the above.
// Skalak, Tozeren, Zarda and Chien (Biophys. J. 13, 1973); Barthes-Biesel, Diaz and Dhenin (J. Fluid Mech. 460, 2002).
#include <rouleau/membrane.hpp>

struct Skalak {
  double Gs, C;
  bool clamped;
  explicit Skalak(const rouleau::Parameters& p)
      : Gs{p["shear_modulus"]}, C{p["area_dilation"]}, clamped{p["transverse"] != 0} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S e = segment.stretch, u = e * e;
    if (clamped) return {S(0.0), Gs * (1 + C) * e * (u - 1.0), Gs * (1 + C) * (3.0 * u - 1.0)};
    const S a = 1.0 + C * u, inverse_b = 1.0 / (1.0 + C * u * u), width = sqrt(a * inverse_b);  // l
    const S area = C * a * inverse_b * inverse_b, factor = (u - 1.0) * (1.0 + area), share = C * u * inverse_b;
    const S slope =
        factor * (1.0 + u * (2.0 * share - C / a)) +
        2.0 * u * (1.0 + area + (u - 1.0) * (C * inverse_b) * (C * inverse_b - 4.0 * share * a * inverse_b));
    return {S(0.0), Gs * e / width * factor, Gs * slope / width};
  }

  /// Free, the energy is an elliptic integral: it is taken by Gauss-Legendre quadrature of the tension, exact to
  /// rounding for stretches of 1/4 to 4.
  template <class S>
  S energy(const rouleau::Segment<S>& segment) const {
    const S e = segment.stretch, half = 0.5 * (e - 1.0), middle = 1.0 + half;
    if (clamped) return 0.25 * Gs * (1 + C) * (e * e - 1.0) * (e * e - 1.0);
    S sum = 0.0;
    for (const auto& [place, weight] : quadrature) {
      const S left = (*this)(rouleau::Segment<S>{middle - place * half, S(0.0)}).tension;
      const S right = (*this)(rouleau::Segment<S>{middle + place * half, S(0.0)}).tension;
      sum += weight * (left + right);
    }
    return half * sum;
  }

  template <class S>
  rouleau::Stress<S> operator()(const rouleau::Triangle<S>& triangle) const {
    const S one = triangle.invariant_1, two = triangle.invariant_2;
    return {0.25 * Gs * (one * one + 2.0 * one - 2.0 * two + C * two * two),
            0.5 * Gs * (one + 1.0),
            0.5 * Gs * (C * two - 1.0),
            S(0.5 * Gs),
            S(0.0),
            S(0.5 * Gs * C)};
  }

 private:
  /// Places and weights of the half of twenty points on [-1, 1]; the other half lies mirrored.
  static constexpr double quadrature[10][2] = {
      {0.07652652113349734, 0.15275338713072584}, {0.22778585114164507, 0.14917298647260374},
      {0.37370608871541955, 0.14209610931838204}, {0.5108670019508271, 0.13168863844917664},
      {0.636053680726515, 0.11819453196151841},   {0.7463319064601508, 0.10193011981724044},
      {0.8391169718222188, 0.08327674157670475},  {0.912234428251326, 0.06267204833410907},
      {0.9639719272779138, 0.04060142980038694},  {0.9931285991850949, 0.017614007139152118}};
};
ROULEAU_MEMBRANE(Skalak, "skalak", "1.1.0")
