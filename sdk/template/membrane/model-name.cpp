// A membrane that stiffens: energy w = E/(2 a) (exp(a x^2) - 1) per rest length at the strain x = e - 1, e the stretch;
// tension T = dw/de = E x exp(a x^2), near rest Hooke's. After Fung, Fronek and Patitucci (Am. J. Physiol. 237, 1979).
#include <rouleau/membrane.hpp>

struct ModelType {
  double E, a;
  explicit ModelType(const rouleau::Parameters& p) : E{p["stretching_modulus"]}, a{p["stiffening"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S strain = segment.stretch - 1.0, q = a * strain * strain, growth = exp(q);
    return {0.5 * E / a * (growth - 1.0), E * strain * growth, E * (1.0 + 2.0 * q) * growth};
  }
};
ROULEAU_MEMBRANE(ModelType, "model-id", "1.0.0")
