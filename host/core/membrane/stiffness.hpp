// How stiff membrane laws are: what decides whether a step may be explicit, and what a semi-implicit one is made with.
#pragma once

#include <vector>

#include "core/model/model.hpp"

namespace rouleau::core {

/// Largest d tension / d stretch of a law of segments, or of one of triangles stretched along one direction, at these
/// stretches, without rate and with its initial state; by differences of the tension where the law gives no derivative.
/// 0 for other laws. Lattice units.
double stretching_stiffness(const MembraneLaw& law, const std::vector<double>& stretches = {0.95, 1.0, 1.1});

/// Tension of such a law at a stretch, at once; 0 for other laws.
double tension_at(const MembraneLaw& law, double stretch);

/// d moment / d curvature of a law of nodes, as much of it as the law gives, for a shape that is flat at rest. 0 for
/// other laws. Lattice units.
double bending_stiffness(const MembraneLaw& law);

/// What such a law gives as viscosities of a membrane at rest, shear and area together; 0 for other laws.
double surface_viscosity(const MembraneLaw& law);

/// All three, as above; of several laws they add up.
struct Stiffness {
  double stretching = 0, bending = 0, viscosity = 0;
  Stiffness& operator+=(const MembraneLaw& law) {
    stretching += stretching_stiffness(law);
    bending += bending_stiffness(law);
    viscosity += surface_viscosity(law);
    return *this;
  }
};

}  // namespace rouleau::core
