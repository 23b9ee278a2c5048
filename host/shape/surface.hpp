// The shapes of cells of a scene in three dimensions, as closed surfaces of triangles.
#pragma once

#include "core/surface/triangle_surface.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// A mesh, m, the centroid of the volume that it encloses in the origin. Throws what read_mesh() throws.
core::TriangleSurface mesh_surface(const scene::MeshFile& mesh);

/// Of a cell type in three dimensions, m. Throws what read_mesh() throws.
core::TriangleSurface make_surface(const scene::CellType& type);

/// Turns a cell about z, or so that its y axis becomes the axis wanted, and about that.
Eigen::Matrix3d rotation_of(const scene::CellPlacement& cell);

}  // namespace rouleau::shape
