// Surfaces, laws and comparisons for the tests of this folder.
#pragma once

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/surface/surface_forces.hpp"
#include "shape/surface.hpp"
#include "unit/cell_fixture.hpp"

namespace rouleau::test {

inline core::MembraneLaw surface_law(const char* id, const std::vector<double>& values) {
  return make_membrane_law(shipped(ModelKind::membrane, id), values, ModelSetting{{1, 1, 1}, 1.0, false, 3});
}

inline Surfaces one_cell(const shape::TriangleSurface& shape, double prestretch = 1) {
  Surfaces surfaces;
  surfaces.types.push_back(std::make_shared<const RestSurface>(shape::rest_surface(shape, prestretch)));
  add_cell(surfaces, 0, {3, -2, 5});
  return surfaces;
}

inline Vec<3> force_on(const Surfaces& s, int i) { return {s.force_x[i], s.force_y[i], s.force_z[i]}; }

inline double largest_force(const Surfaces& s) {
  double most = 0;
  for (int i = 0; i < s.node_count(); ++i) most = std::max(most, force_on(s, i).norm());
  return most;
}

}  // namespace rouleau::test
