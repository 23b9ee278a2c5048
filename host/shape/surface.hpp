// The shapes of cells of a scene in three dimensions, as closed surfaces of triangles.
#pragma once

#include <optional>

#include "core/surface/triangle_surface.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// A mesh, m, the centroid of the volume that it encloses in the origin. Throws what read_mesh() throws.
core::TriangleSurface mesh_surface(const scene::MeshFile& mesh);

/// Of a cell type in three dimensions, m. Throws what read_mesh() throws.
core::TriangleSurface make_surface(const scene::CellType& type);

/// The shape in which a type with one is free of stress, m: the triangles of `first`, which make_surface() made.
core::TriangleSurface stress_free_surface(const scene::CellType& type, const core::TriangleSurface& first);
/// Throws Error(bad_input) where such a shape has other triangles than the first one.
void check_stress_free(const scene::Scene& scene);

/// Turns about z, or so that the y axis becomes the axis wanted, and about that; rad.
Eigen::Matrix3d rotation_of(const std::optional<Eigen::Vector3d>& axis, double angle);
inline Eigen::Matrix3d rotation_of(const scene::CellPlacement& cell) { return rotation_of(cell.axis, cell.angle); }

}  // namespace rouleau::shape
