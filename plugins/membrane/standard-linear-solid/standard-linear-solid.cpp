// Maxwell branch of a standard linear solid, beside the elastic laws: a spring of modulus E in series with a dashpot.
// Tension T = E s, s = e - e_d the spring's strain, d e_d/dt = s/tau. The dashpot's stretch e_d is state; its step is
// exact for a stretch that changes evenly over the step.
#include <rouleau/membrane.hpp>

struct StandardLinearSolid {
  static constexpr int state_count = 1;  // e_d
  double E, tau;
  explicit StandardLinearSolid(const rouleau::Parameters& p) : E{p["modulus"]}, tau{p["relaxation_time"]} {}

  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment, rouleau::State<S, 1>& dashpot, double dt) const {
    const S kept = exp(S(-dt / tau)), before = segment.stretch - dt * segment.stretch_rate - dashpot[0];
    const S strain = kept * before + (1.0 - kept) * tau * segment.stretch_rate;
    // stretch - strain, in the form in which a time step of 0 leaves the bits of e_d.
    dashpot[0] =
        kept * (dashpot[0] + dt * segment.stretch_rate) + (1.0 - kept) * (segment.stretch - tau * segment.stretch_rate);
    return {0.5 * E * strain * strain, E * strain, E * kept};
  }
};
ROULEAU_MEMBRANE(StandardLinearSolid, "standard-linear-solid", "1.0.1")
