// Membrane viscosity (Kelvin-Voigt, beside the elastic laws). In two dimensions the tension T = (mu_m + k)/e de/dt, which
// a sheet has that is clamped across the plane; k = 0: Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 2. In three
// 2 mu_m (D - tr D/2) + k tr D of the rate of strain D in the surface: Evans and Hochmuth (Biophys. J. 16, 1976).
// The host takes both implicitly, at any viscosity.
#include <rouleau/membrane.hpp>

struct Viscous {
  double mu, k;
  explicit Viscous(const rouleau::Parameters& p) : mu{p["viscosity"]}, k{p["area_viscosity"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment) const {
    const S coefficient = (mu + k) / segment.stretch;
    return {S(0), coefficient * segment.stretch_rate, S(0), coefficient};
  }
  template <class S>
  rouleau::Stress<S> operator()(const rouleau::Triangle<S>&) const {
    return {S(0), S(0), S(0), S(0), S(0), S(0), S(mu), S(k)};
  }
};
ROULEAU_MEMBRANE(Viscous, "viscous", "1.1.0")
