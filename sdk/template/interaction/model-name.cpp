// A well between two exponentials, an attraction and an n times steeper repulsion: phi = De (s^n - n s)/(n - 1) per
// area, s = exp(beta (r0 - r)). Each is a Yukawa interaction as it acts between flat surfaces; n = 2 is Morse's well.
// force = -d phi / d r
#include <rouleau/interaction.hpp>

struct ModelType {
  double De, beta, r0, n, rc;
  explicit ModelType(const rouleau::Parameters& p)
      : De{p["depth"]}, beta{p["decay"]}, r0{p["zero_force_distance"]}, n{p["steepness"]}, rc{p["cutoff"]} {}
  double cutoff() const { return rc; }

  template <class S>
  rouleau::Pair<S> operator()(const S& r) const {
    const S s = exp(beta * (r0 - r)), t = exp(n * beta * (r0 - r));
    const double force = De * beta * n / (n - 1);
    return {De / (n - 1) * (t - n * s), force * (t - s), force * beta * (s - n * t)};
  }
};
ROULEAU_INTERACTION(ModelType, "model-id", "1.0.0")
