// Membrane viscosity (Kelvin-Voigt, beside the elastic laws): tension T = (mu_m/e) de/dt.
// Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 2. The host takes it implicitly, at any viscosity.
#include <rouleau/membrane.hpp>

struct Viscous {
  double mu;
  explicit Viscous(const rouleau::Parameters& p) : mu{p["viscosity"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S coefficient = mu / segment.stretch;
    return {S(0), coefficient * segment.stretch_rate, S(0), coefficient};
  }
};
ROULEAU_MEMBRANE(Viscous, "viscous", "1.0.0")
