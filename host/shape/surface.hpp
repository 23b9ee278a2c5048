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

/// Turns about z, or so that the y axis becomes the axis wanted, and about that; rad.
Eigen::Matrix3d rotation_of(const std::optional<Eigen::Vector3d>& axis, double angle);
inline Eigen::Matrix3d rotation_of(const scene::CellPlacement& cell) { return rotation_of(cell.axis, cell.angle); }

}  // namespace rouleau::shape
