// Keeps a cell's volume: energy K/2 (V - V0)^2 / V0, pressure -K (V - V0)/V0, V0 a share of the volume at rest.
#include <rouleau/membrane.hpp>

struct Volume {
  double K, ratio;
  explicit Volume(const rouleau::Parameters& p) : K{p["modulus"]}, ratio{p["ratio"]} {}

  template <class S>
  rouleau::BodyForces<S> operator()(const rouleau::Body<S>& body) const {
    const S preferred = ratio * body.rest_volume, excess = body.volume - preferred, pressure = -K * excess / preferred;
    return {-0.5 * pressure * excess, pressure, S(0.0)};
  }
};
ROULEAU_MEMBRANE(Volume, "volume", "1.0.0")
