// Bonds between membranes, springs that form and break: n bonds per area, dn/dt = k_on (n0 - n) - k_off n, with
// k_on = on exp(-c U/kT), k_off = off exp((1 - c) U/kT), U = k/2 (r - r0)^2 the energy of a bond; force -n dU/dr.
// Dembo, Torney, Saxman and Hammer (Proc. R. Soc. Lond. B 234, 1988). The step in n is exact at a given distance.
#include <rouleau/interaction.hpp>

struct Bridging {
  static constexpr int state_count = 1;  // n
  double n0, k, r0, on, off, c, thermal, rc;
  explicit Bridging(const rouleau::Parameters& p)
      : n0{p["site_density"]},
        k{p["bond_stiffness"]},
        r0{p["zero_force_distance"]},
        on{p["on_rate"]},
        off{p["off_rate"]},
        c{p["transition_share"]},
        thermal{p["thermal_energy"]},
        rc{p["cutoff"]} {}
  double cutoff() const { return rc; }

  template <class S>
  rouleau::Pair<S> operator()(const S& r, rouleau::State<S, 1>& bonds, double time_step) const {
    const S u = 0.5 * k * (r - r0) * (r - r0), strain = min(u / thermal, S(300.0));  // far beyond, bonds break at once
    const S forming = on * exp(-c * strain), rate = forming + off * exp((1 - c) * strain),
            balance = n0 * forming / rate;
    // In this form a time step of 0 leaves the bits of n.
    const S kept = exp(-time_step * rate), n = bonds[0] = kept * bonds[0] + (1.0 - kept) * balance;
    return {n * u, -k * (r - r0) * n, -k * n};
  }
};
ROULEAU_INTERACTION(Bridging, "bridging", "1.0.1")
