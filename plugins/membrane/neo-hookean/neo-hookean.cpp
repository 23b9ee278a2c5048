// Neo-Hookean membrane, tension T = dw/de of the energy w per rest length at the stretch e.
// Free to contract across the plane: w = Es (2/5 e^(5/2) + 2 e^(-1/2) - 12/5), T = Es (e^(3/2) - e^(-3/2)).
// Clamped, the stretch across the plane held at 1: w = Es (e^2 + e^-2 - 2)/2, T = Es (e - e^-3).
// In three dimensions: w = Es/2 (I1 - 1 + 1/(I2 + 1)) per rest area, which clamped becomes the above.
// Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 1; Barthes-Biesel, Diaz and Dhenin (J. Fluid Mech. 460, 2002).
#include <rouleau/membrane.hpp>

struct NeoHookean {
  double Es;
  bool clamped;
  explicit NeoHookean(const rouleau::Parameters& p) : Es{p["shear_modulus"]}, clamped{p["transverse"] != 0} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S e = segment.stretch;
    if (clamped) {
      const S inverse = 1.0 / e, squared = inverse * inverse;
      return {0.5 * Es * (e - inverse) * (e - inverse), Es * (e - inverse * squared),
              Es * (1.0 + 3.0 * squared * squared)};
    }
    const auto [root, inverse_root] = sqrt_and_inverse(e);
    const S inverse = inverse_root * inverse_root, cubed = inverse * inverse_root;
    return {Es * (0.4 * e * e * root + 2.0 * inverse_root - 2.4), Es * (e * root - cubed),
            1.5 * Es * (root + inverse * cubed)};
  }

  template <class S>
  rouleau::Stress<S> operator()(const rouleau::Triangle<S>& triangle) const {
    const S inverse = 1.0 / (triangle.invariant_2 + 1.0), squared = inverse * inverse;
    return {0.5 * Es * (triangle.invariant_1 - 1.0 + inverse),
            S(0.5 * Es),
            -0.5 * Es * squared,
            S(0.0),
            S(0.0),
            Es * inverse * squared};
  }
};
ROULEAU_MEMBRANE(NeoHookean, "neo-hookean", "1.2.0")
