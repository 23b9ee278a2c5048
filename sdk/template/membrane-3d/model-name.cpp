// A membrane that stiffens, in three dimensions: energy w = G/(2 a) (exp(a q) - 1) per rest area of a triangle, with
// q = I1 - 1 + 1/(I2 + 1), so that near rest it is neo-Hookean. I1 = l1^2 + l2^2 - 2 and I2 = l1^2 l2^2 - 1, l1 and l2
// the stretches. Demiray (J. Biomech. 5, 1972) for solids.
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
};
ROULEAU_MEMBRANE(ModelType, "model-id", "1.0.0")
