// The checks of membrane laws that move an element and count the work: rigid motion, dissipation, cycles, state.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "conform/check.hpp"
#include "trials.hpp"

namespace rouleau::conform {

/// A coordinate of an element and the force along it: force = sign d energy/d variable.
struct MembraneCoordinate {
  std::string variable, force, rest;  ///< `rest`: the input that holds its value at rest; empty: it is a constant
  double sign = 1;
};
/// Those of a law's element whose force the law gives.
std::vector<MembraneCoordinate> coordinates_of(const plugin::Manifest& manifest);

/// Elements at rest: stretch 1, rate 0, invariants 0, curvature and what cells have as at rest, state with its initial
/// values.
Values at_rest(const Subject& subject, const Trial& trial, std::size_t count, Random& random);

/// Makes the state that a step has left the input of the next one.
void keep_state(Values& inputs, const Values& outputs);

Finding check_rigid_motion(const Subject& subject);
Finding check_dissipation(const Subject& subject);
Finding check_closed_loop(const Subject& subject);
/// Of laws of both dimensions: that a clamped membrane is the same in both.
Finding check_clamped(const Subject& outline);
/// Of models of any kind with state.
Finding check_state_restored(const Subject& subject);

}  // namespace rouleau::conform
