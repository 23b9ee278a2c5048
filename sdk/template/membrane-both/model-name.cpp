// A membrane that stiffens, in both dimensions: w = G/(2 a) (exp(a q) - 1) with q = I1 - 1 + 1/(I2 + 1), so that near
// rest it is neo-Hookean. In three dimensions per rest area of a triangle, I1 = l1^2 + l2^2 - 2 and I2 = l1^2 l2^2 - 1,
// l1 and l2 the stretches. In two, per rest length of a segment, of a sheet that keeps its width: l2 = 1.
#include <rouleau/membrane.hpp>

struct ModelType {
  double G, a;
  explicit ModelType(const rouleau::Parameters& p) : G{p["shear_modulus"]}, a{p["stiffening"]} {}

  template <class S>
  rouleau::Stress<S> operator()(const rouleau::Triangle<S>& triangle) const {
    const S y = 1.0 / (triangle.invariant_2 + 1.0), q = triangle.invariant_1 - 1.0 + y, growth = G * exp(a * q);
    return {0.5 / a * G * expm1(a * q), 0.5 * growth,
            -0.5 * growth * y * y,      0.5 * a * growth,
            -0.5 * a * growth * y * y,  growth * y * y * y * (1.0 + 0.5 * a * y)};
  }

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S e = segment.stretch, by = 1.0 / e, root = e - by, q = root * root, growth = G * exp(a * q);
    const S slope = e - by * by * by;  // half of dq/de
    return {0.5 / a * G * expm1(a * q), growth * slope,
            growth * (1.0 + 3.0 * by * by * by * by + 2.0 * a * slope * slope)};
  }
};
ROULEAU_MEMBRANE(ModelType, "model-id", "1.0.0")
