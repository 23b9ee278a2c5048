// Lennard-Jones potential per membrane area: phi = De (s^2 - 2 s), s = (r0/r)^6, force 12 De s (s - 1)/r.
// lennard-jones breaks off at the cutoff. lennard-jones-shifted takes away its force there, and with it the energy of
// that constant force, phi(r) - phi(rc) + F(rc) (r - rc), so that both end at zero; at a cutoff of n r0 the well is
// then shallower by 2 (7 - 6/n) n^-6 of its depth at most. Lennard-Jones (Proc. Phys. Soc. 43, 1931).
#include <rouleau/interaction.hpp>

struct LennardJones {
  double De, r0, rc;
  explicit LennardJones(const rouleau::Parameters& p) : De{p["depth"]}, r0{p["zero_force_distance"]}, rc{p["cutoff"]} {}
  double cutoff() const { return rc; }

  template <class S>
  rouleau::Pair<S> operator()(const S& r) const {
    const S inverse = 1.0 / r, t = r0 * inverse, s = (t * t * t) * (t * t * t);
    return {De * s * (s - 2.0), 12.0 * De * s * (s - 1.0) * inverse,
            12.0 * De * s * (7.0 - 13.0 * s) * inverse * inverse};
  }
};

struct ShiftedLennardJones : LennardJones {
  rouleau::Pair<double> end;
  explicit ShiftedLennardJones(const rouleau::Parameters& p) : LennardJones(p), end(LennardJones::operator()(rc)) {}

  template <class S>
  rouleau::Pair<S> operator()(const S& r) const {
    rouleau::Pair<S> pair = LennardJones::operator()(r);
    pair.energy += end.force * (r - rc) - end.energy;
    pair.force = pair.force - end.force;
    return pair;
  }
};
ROULEAU_MODELS(rouleau::interaction<LennardJones>("lennard-jones", "1.0.0"),
               rouleau::interaction<ShiftedLennardJones>("lennard-jones-shifted", "1.0.0"))
