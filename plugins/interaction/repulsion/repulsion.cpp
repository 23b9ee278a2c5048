// Pure repulsion that ends smoothly: phi = A (1 - r/rc)^3, force 3 A/rc (1 - r/rc)^2, so that energy, force and its
// derivative all vanish at the cutoff rc. A is the energy of contact.
#include <rouleau/interaction.hpp>

struct Repulsion {
  double A, rc;
  explicit Repulsion(const rouleau::Parameters& p) : A{p["strength"]}, rc{p["cutoff"]} {}
  double cutoff() const { return rc; }

  template <class S>
  rouleau::Pair<S> operator()(const S& r) const {
    const S within = max(1.0 - r / rc, S(0.0));
    return {A * within * within * within, 3.0 * A / rc * within * within, -6.0 * A / (rc * rc) * within};
  }
};
ROULEAU_INTERACTION(Repulsion, "repulsion", "1.0.0")
