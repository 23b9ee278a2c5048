// Keeps a cell's perimeter: energy K/2 (P - P0)^2 / P0, tension K (P - P0)/P0 all along it, P0 a share of the perimeter
// at rest. Single segments may still stretch at the cost of others.
#include <rouleau/membrane.hpp>

struct Perimeter {
  double K, ratio;
  explicit Perimeter(const rouleau::Parameters& p) : K{p["modulus"]}, ratio{p["ratio"]} {}

  template <class S>
  rouleau::CellForces<S> operator()(const rouleau::Cell<S>& cell) const {
    const S preferred = ratio * cell.rest_perimeter, excess = cell.perimeter - preferred,
            tension = K * excess / preferred;
    return {0.5 * tension * excess, S(0.0), tension};
  }
};
ROULEAU_MEMBRANE(Perimeter, "perimeter", "1.0.0")
