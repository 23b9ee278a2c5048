// Closed surfaces of triangles for the shapes of cells in three dimensions.
#pragma once

#include "core/surface/surfaces.hpp"
#include "scene/scene.hpp"
#include "triangle_surface.hpp"

namespace rouleau::shape {

/// Each of an icosahedron's 20 triangles in n^2 parts, on the sphere of radius 1: 20 n^2 triangles, 10 n^2 + 2 nodes.
/// Edges differ by a quarter at most.
TriangleSurface unit_sphere(int n);

/// Semi-axes along x, y and z.
TriangleSurface ellipsoid(int n, const core::Vec<3>& semi_axes);

/// The biconcave disc of shape/outline.hpp turned about its axis, which lies along y. Nodes lie at equal distances
/// along meridians.
TriangleSurface biconcave_disc(int n, double radius);

/// A mesh, m, the centroid of the volume that it encloses in the origin. Throws what read_mesh() throws.
TriangleSurface mesh_surface(const scene::MeshFile& mesh);

/// Of a cell type in three dimensions, m. Throws what read_mesh() throws.
TriangleSurface make_surface(const scene::CellType& type);

/// Turns a cell about z, or so that its y axis becomes the axis wanted, and about that.
Eigen::Matrix3d rotation_of(const scene::CellPlacement& cell);

}  // namespace rouleau::shape
