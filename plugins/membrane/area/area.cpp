// Keeps a cell's area: energy K/2 (A - A0)^2 / A0, pressure -K (A - A0)/A0, A0 a share of the area at rest.
#include <rouleau/membrane.hpp>

struct Area {
  double K, ratio;
  explicit Area(const rouleau::Parameters& p) : K{p["modulus"]}, ratio{p["ratio"]} {}

  template <class S>
  rouleau::CellForces<S> operator()(const rouleau::Cell<S>& cell) const {
    const S preferred = ratio * cell.rest_area, excess = cell.area - preferred, pressure = -K * excess / preferred;
    return {-0.5 * pressure * excess, pressure, S(0.0)};
  }
};
ROULEAU_MEMBRANE(Area, "area", "1.0.0")
