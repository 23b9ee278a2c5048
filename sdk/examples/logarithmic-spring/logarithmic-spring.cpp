// A spring that no finite force crushes: energy E/4 (e^2 - 1 - 2 log e) per rest length at the stretch e.
// The SDK derives the tension, E/2 (e - 1/e), and its slope from the energy.
#include <rouleau/membrane.hpp>

struct LogarithmicSpring {
  double E;
  explicit LogarithmicSpring(const rouleau::Parameters& p) : E{p["stretching_modulus"]} {}

  template <class S>
  S energy(const rouleau::Segment<S>& segment) const {
    const S e = segment.stretch;
    return 0.25 * E * (e * e - 1.0 - 2.0 * log(e));
  }
};
ROULEAU_MEMBRANE(LogarithmicSpring, "org.example.logarithmic-spring", "1.0.0")
