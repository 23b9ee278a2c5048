// Resists local changes of a surface's area: energy K/2 (j - 1)^2 per rest area, j the area around a node over that at
// rest.
#include <rouleau/membrane.hpp>

struct LocalArea {
  double K;
  explicit LocalArea(const rouleau::Parameters& p) : K{p["modulus"]} {}

  template <class S>
  rouleau::PatchTension<S> operator()(const rouleau::Patch<S>& patch) const {
    const S growth = patch.area_ratio - 1.0;
    return {0.5 * K * growth * growth, K * growth, S(K)};
  }
};
ROULEAU_MEMBRANE(LocalArea, "local-area", "1.0.0")
