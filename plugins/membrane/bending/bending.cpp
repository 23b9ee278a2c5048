// Bending resistance: energy Eb/2 (kappa - kappa0)^2 per rest length, moment Eb (kappa - kappa0), kappa0 the curvature
// of the cell's initial shape. Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 3.
#include <rouleau/membrane.hpp>

struct Bending {
  double Eb;
  explicit Bending(const rouleau::Parameters& p) : Eb{p["modulus"]} {}

  template <class S>
  rouleau::Moment<S> operator()(const rouleau::Vertex<S>& vertex) const {
    const S change = vertex.curvature - vertex.rest_curvature;
    return {0.5 * Eb * change * change, Eb * change, S(Eb)};
  }
};
ROULEAU_MEMBRANE(Bending, "bending", "1.0.0")
