// Hooke's law: energy w = E/2 (e - 1)^2 per rest length at the stretch e, tension T = dw/de = E (e - 1).
#include <rouleau/membrane.hpp>

struct Hooke {
  double E;
  explicit Hooke(const rouleau::Parameters& p) : E{p["stretching_modulus"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S strain = segment.stretch - 1.0;
    return {0.5 * E * strain * strain, E * strain, S(E)};
  }
};
ROULEAU_MEMBRANE(Hooke, "hooke", "1.0.0")
