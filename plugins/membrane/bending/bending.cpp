// Bending resistance: energy Eb/2 (kappa - kappa0)^2 per rest length, moment Eb (kappa - kappa0). The rest curvature
// kappa0 is that of the cell's initial shape, zero or a given value; any constant gives the same forces, for the sum of
// kappa over a closed outline is 2 pi whatever its shape. Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 3.
// In three dimensions kappa is the sum of both principal curvatures and the energy per rest area: Helfrich (Z.
// Naturforsch. 28c, 1973) with the spontaneous curvature kappa0, which matters there.
#include <rouleau/membrane.hpp>

struct Bending {
  double Eb, share_of_initial, constant;
  explicit Bending(const rouleau::Parameters& p) : Eb{p["modulus"]}, constant{p["rest_curvature_value"]} {
    const auto choice = static_cast<int>(p["rest_curvature"]);  // initial, zero, value
    share_of_initial = choice == 0 ? 1 : 0;
    if (choice != 2 && constant != 0) {
      throw std::invalid_argument("rest_curvature_value is given, but rest_curvature is not \"value\"");
    }
  }

  template <class S>
  rouleau::Moment<S> operator()(const rouleau::Vertex<S>& vertex) const {
    const S change = vertex.curvature - (share_of_initial * vertex.rest_curvature + constant);
    return {0.5 * Eb * change * change, Eb * change, S(Eb)};
  }
};
ROULEAU_MEMBRANE(Bending, "bending", "1.2.0")
