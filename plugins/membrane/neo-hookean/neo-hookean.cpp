// Neo-Hookean membrane, free to contract across the plane: energy w = Es (2/5 e^(5/2) + 2 e^(-1/2) - 12/5) per rest
// length, tension T = dw/de = Es (e^(3/2) - e^(-3/2)). Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 1.
#include <rouleau/membrane.hpp>

struct NeoHookean {
  double Es;
  explicit NeoHookean(const rouleau::Parameters& p) : Es{p["shear_modulus"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S e = segment.stretch, root = sqrt(e), inverse = 1.0 / (e * root);
    return {Es * (0.4 * e * e * root + 2.0 / root - 2.4), Es * (e * root - inverse), 1.5 * Es * (root + inverse / e)};
  }
};
ROULEAU_MEMBRANE(NeoHookean, "neo-hookean", "1.0.0")
