// Why a run stopped early, and what that looks like.
#pragma once

#include <string>

#include "scene/vector.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::monitor {

/// Why a run stopped early.
struct Failure {
  std::string
      reason;  ///< code: non_finite, mach, node_step, escaped, area_drift, uneven_nodes, crossing, energy_growth
  long step = 0;
  double time = 0, strain = 0;
  scene::Vector place{0, 0};    ///< m
  int cell = -1;                ///< -1: none
  double value = 0, limit = 0;  ///< what was measured and the limit it passed
  std::string message;          ///< one sentence
  std::string remedy;           ///< what to change
};

/// A place of the lattice in m.
template <class Place>
scene::Vector in_metres(const Place& node, int dimension, double spacing) {
  scene::Vector place = scene::Vector::filled(dimension, 0);
  for (int axis = 0; axis < dimension; ++axis) place[axis] = units::coordinate(node[axis], spacing);
  return place;
}

}  // namespace rouleau::monitor
