// Morse potential between surfaces: phi = De (s^2 - 2 s), s = exp(beta (r0 - r)); force 2 De beta s (s - 1).
// Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 5, with De in J/m2.
#include <rouleau/interaction.hpp>

struct Morse {
  double De, beta, r0, rc;
  explicit Morse(const rouleau::Parameters& p)
      : De{p["depth"]}, beta{p["decay"]}, r0{p["zero_force_distance"]}, rc{p["cutoff"]} {}
  double cutoff() const { return rc; }

  template <class S>
  rouleau::Pair<S> operator()(const S& r) const {
    const S s = exp(beta * (r0 - r));
    return {De * s * (s - 2.0), 2.0 * De * beta * s * (s - 1.0), 2.0 * De * beta * beta * s * (1.0 - 2.0 * s)};
  }
};
ROULEAU_INTERACTION(Morse, "morse", "1.0.0")
