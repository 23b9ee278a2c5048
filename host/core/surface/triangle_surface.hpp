// Closed surfaces of triangles as nodes and faces: spheres, ellipsoids, biconcave discs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "surfaces.hpp"

namespace rouleau::core {

/// Nodes around the origin, and triangles counter-clockwise seen from outside.
struct TriangleSurface {
  std::vector<Vec<3>> nodes;
  std::vector<std::array<int, 3>> triangles;
};

/// The surface at rest; `prestretch`: lengths as given over those at rest.
RestSurface rest_surface(const TriangleSurface& surface, double prestretch = 1);

/// Each of an icosahedron's 20 triangles in n^2 parts, on the sphere of radius 1: 20 n^2 triangles, 10 n^2 + 2 nodes.
/// Edges differ by a quarter at most.
TriangleSurface unit_sphere(int n);

/// Semi-axes along x, y and z.
TriangleSurface ellipsoid(int n, const Vec<3>& semi_axes);

/// Area of a surface, and the volume that it encloses.
struct SurfaceContent {
  double area, volume;
  /// The volume over that of the sphere of the same area.
  [[nodiscard]] double reduced_volume() const;
};
SurfaceContent content_of(const TriangleSurface& surface);

/// Semi-axes of the oblate spheroid with its axis along y, or the prolate one with its axis along x, of this area and
/// volume; the reduced volume is above 0 and at most 1.
Vec<3> spheroid_axes(const SurfaceContent& content, bool prolate);

/// A place on a curve, and its derivative by the curve's angle.
struct CurvePoint {
  Eigen::Vector2d place, derivative;
};

/// Evans and Fung's outline of a red cell, its axis of symmetry along y: x = R cos(a),
/// y = R/2 sin(a) (0.207 + 2.002 (x/R)^2 - 1.122 (x/R)^4), smooth at the rim, where y(x) is not.
CurvePoint biconcave_curve(double radius, double angle);

/// That curve turned about y. Nodes lie at equal distances along meridians.
TriangleSurface biconcave_disc(int n, double radius);
/// A spheroid about x, where the others of its semi-axes are equal, or about y, its nodes likewise.
TriangleSurface even_spheroid(int n, const Vec<3>& semi_axes);

}  // namespace rouleau::core
