// Models compiled into the tests, in lattice units: simple enough to be worked out by hand, or wrong on purpose.
#pragma once

#include <cmath>
#include <rouleau/interaction.hpp>
#include <rouleau/membrane.hpp>
#include <stdexcept>
#include <string>

#include "core/model/compiled_in.hpp"

namespace rouleau::test {

/// Tension G (e - 1) at stretch e, and its energy.
struct Spring {
  double modulus;
  explicit Spring(const Parameters& given) : modulus{given["modulus"]} {}
  template <class S>
  Tension<S> operator()(const Segment<S>& segment) const {
    const S strain = segment.stretch - 1.0;
    return {0.5 * modulus * strain * strain, modulus * strain, S(modulus)};
  }
};
/// The same force at all distances below the cutoff; repels where positive.
struct ConstantForce {
  double force, end;
  explicit ConstantForce(const Parameters& given) : force{given["force"]}, end{given["cutoff"]} {}
  double cutoff() const { return end; }
  template <class S>
  Pair<S> operator()(S distance) const {
    return {force * (end - distance), S(force), S(0.0)};
  }
};
/// Energy k/2 ((d - rest)^2 - (cutoff - rest)^2), which is 0 at the cutoff.
struct SpringBetween {
  double stiffness, rest, end;
  explicit SpringBetween(const Parameters& given)
      : stiffness{given["stiffness"]}, rest{given["rest"]}, end{given["cutoff"]} {}
  double cutoff() const { return end; }
  template <class S>
  S energy(const S& distance) const {
    return 0.5 * stiffness * ((distance - rest) * (distance - rest) - (end - rest) * (end - rest));
  }
};
/// Damps what moves along the line to the other, and says so by its needs.
struct Damper {
  double viscosity, end;
  explicit Damper(const Parameters& given) : viscosity{given["viscosity"]}, end{given["cutoff"]} {}
  double cutoff() const { return end; }
  template <class S>
  Pair<S> operator()(const Contact<S>& contact) const {
    return {S(0.0), -viscosity * contact.normal_velocity, S(0.0)};
  }
};
/// Pushes surfaces apart that slide.
struct Rubbing : Damper {
  using Damper::Damper;
  template <class S>
  Pair<S> operator()(const Contact<S>& contact) const {
    return {S(0.0), viscosity * contact.sliding_speed, S(0.0)};
  }
};
/// A tension that is no number.
struct NoNumber {
  explicit NoNumber(const Parameters&) {}
  template <class S>
  Tension<S> operator()(const Segment<S>&) const {
    return {S(std::nan("")), S(std::nan("")), S(std::nan(""))};
  }
};
/// Refuses whatever it is given.
struct Refusing : NoNumber {
  explicit Refusing(const Parameters& given) : NoNumber(given) { throw std::invalid_argument("no modulus is good"); }
};
/// A spring that counts its instances.
struct Counted : Spring {
  static inline int alive = 0;
  explicit Counted(const Parameters& given) : Spring(given) { ++alive; }
  Counted(const Counted& other) : Spring(other) { ++alive; }
  ~Counted() { --alive; }
};

template <class Law>
core::MembraneLaw fake_law(double modulus) {
  return core::membrane_law(membrane<Law>("fake", "1"), {.parameters = {{"modulus", modulus}},
                                                         .needs = {"stretch"},
                                                         .gives = {"tension", "energy", "tension_by_stretch"}});
}
inline core::Potential constant_force(double force, double cutoff) {
  return core::potential(interaction<ConstantForce>("constant", "1"),
                         {.parameters = {{"force", force}, {"cutoff", cutoff}},
                          .needs = {"distance"},
                          .gives = {"force", "energy", "force_by_distance"}});
}

inline core::Potential spring_potential(double stiffness, double rest, double cutoff) {
  return core::potential(interaction<SpringBetween>("spring", "1"),
                         {.parameters = {{"stiffness", stiffness}, {"rest", rest}, {"cutoff", cutoff}},
                          .needs = {"distance"},
                          .gives = {"force", "energy", "force_by_distance"}});
}
/// `velocity`: the one that it says it needs.
inline core::Potential damper(double viscosity, double cutoff, const std::string& velocity) {
  return core::potential(interaction<Damper>("damper", "1"),
                         {.parameters = {{"viscosity", viscosity}, {"cutoff", cutoff}},
                          .needs = {"distance", velocity},
                          .gives = {"force", "energy", "force_by_distance"}});
}

inline core::Potential rubbing(double viscosity, double cutoff) {
  return core::potential(interaction<Rubbing>("rubbing", "1"),
                         {.parameters = {{"viscosity", viscosity}, {"cutoff", cutoff}},
                          .needs = {"distance", "sliding_speed"},
                          .gives = {"force"}});
}

}  // namespace rouleau::test
