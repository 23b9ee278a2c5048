// Keeps the area of a cell's surface: energy K/2 (A - A0)^2 / A0, tension K (A - A0)/A0 all over it, A0 a share of the
// area at rest. Single triangles may still grow at the cost of others. A constant tension is added to it: that of a
// drop.
#include <rouleau/membrane.hpp>

struct SurfaceArea {
  double K, ratio, constant;
  explicit SurfaceArea(const rouleau::Parameters& p) : K{p["modulus"]}, ratio{p["ratio"]}, constant{p["tension"]} {}

  template <class S>
  rouleau::BodyForces<S> operator()(const rouleau::Body<S>& body) const {
    const S preferred = ratio * body.rest_surface_area, excess = body.surface_area - preferred;
    const S tension = K * excess / preferred;
    return {0.5 * tension * excess + constant * body.surface_area, S(0.0), tension + constant};
  }
};
ROULEAU_MEMBRANE(SurfaceArea, "surface-area", "1.0.0")
