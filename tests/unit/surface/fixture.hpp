// Surfaces and comparisons for the tests of this folder.
#pragma once

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <utility>

#include "core/surface/surface_forces.hpp"
#include "core/surface/surface_normals.hpp"
#include "core/surface/triangle_surface.hpp"
#include "unit/cell_fixture.hpp"

namespace rouleau::test {

inline Surfaces one_cell(const core::TriangleSurface& shape, double prestretch = 1) {
  Surfaces surfaces;
  surfaces.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(shape, prestretch)));
  add_cell(surfaces, 0, {3, -2, 5});
  return surfaces;
}

/// An ellipsoid and a larger biconcave disc, of the types 0 and 1, far from the origin and out of shape by up to 0.1.
inline Surfaces cells_out_of_shape(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(4, {4, 3, 5}))));
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::biconcave_disc(5, 6))));
  add_cell(s, 0, {1000, 20, 30});
  add_cell(s, 1, {30, 2000, -40}, Eigen::AngleAxisd(1, Vec<3>(1, 2, 3).normalized()).toRotationMatrix());
  for (auto& places : s.position) {
    for (double& place : places) place += any(random);
  }
  return s;
}

inline core::SurfaceNormals normals_of(const Surfaces& s) {
  core::SurfaceNormals normals(s);
  normals.measure({}, s);
  return normals;
}

inline Vec<3> force_on(const Surfaces& s, int i) { return {s.force[0][i], s.force[1][i], s.force[2][i]}; }

inline double largest_force(const Surfaces& s) {
  double most = 0;
  for (int i = 0; i < s.node_count(); ++i) most = std::max(most, force_on(s, i).norm());
  return most;
}

/// Sum of the forces, and their torque about a point beside the surface.
inline std::pair<Vec<3>, Vec<3>> sum_and_torque(const Surfaces& s) {
  Vec<3> sum = Vec<3>::Zero(), torque = Vec<3>::Zero();
  for (int i = 0; i < s.node_count(); ++i) {
    sum += force_on(s, i);
    torque += (s.nodes(0)[i] - Vec<3>(3, -2, 5)).cross(force_on(s, i));
  }
  return {sum, torque};
}

}  // namespace rouleau::test
