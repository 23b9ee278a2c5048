#include "extent.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <variant>

#include "outline.hpp"
#include "surface.hpp"

namespace rouleau::shape {

namespace {

bool is_surface(const scene::CellType& type) { return type.segments == 0; }

/// Of the cell at rest where it is stretched from the start: lengths as placed.
core::RestSurface placed_surface(const scene::CellType& type) { return core::rest_surface(make_surface(type)); }

/// Half of the longest side of the box around a surface.
double half_extent(const core::TriangleSurface& surface) {
  Eigen::AlignedBox3d box;
  for (const core::Vec<3>& node : surface.nodes) box.extend(node);
  return box.sizes().maxCoeff() / 2;
}

}  // namespace

double enclosed_by(const scene::CellType& type) {
  if (is_surface(type)) return placed_surface(type).rest_volume;
  return area_of(make_outline(type.shape, type.segments));
}

int surface_nodes(int triangles) { return triangles / 2 + 2; }

int divided_triangles(int triangles, double coarser) {
  const int n = static_cast<int>(std::clamp(std::round(std::sqrt(triangles / 20.0) / coarser), 1.0, 1e4));
  return 20 * n * n;
}

double node_count(const scene::CellType& type) {
  if (!is_surface(type)) return type.segments;
  if (type.triangles > 0) return surface_nodes(type.triangles);
  return static_cast<double>(make_surface(type).nodes.size());
}

double node_spacing(const scene::CellType& type) {
  if (!is_surface(type)) return shape_perimeter(type.shape) / type.segments;
  const core::RestSurface surface = placed_surface(type);
  double sum = 0;
  for (const core::Mesh::Edge& edge : surface.mesh.edges())
    sum += (surface.nodes()[edge.b] - surface.nodes()[edge.a]).norm();
  return sum / surface.mesh.edge_count();
}

double shape_radius(const scene::Shape& shape) {
  if (const auto* biconcave = std::get_if<scene::Biconcave>(&shape)) return biconcave->radius;
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) return circle->radius;
  if (const auto* sphere = std::get_if<scene::Sphere>(&shape)) return sphere->radius;
  if (const auto* ellipsoid = std::get_if<scene::Ellipsoid>(&shape)) return ellipsoid->semi_axes.most();
  if (const auto* mesh = std::get_if<scene::MeshFile>(&shape)) return half_extent(mesh_surface(*mesh));
  return std::get<scene::Ellipse>(shape).semi_axes.most();
}

double smallest_radius(const scene::Scene& scene) {
  double least = 0;
  for (const scene::CellPlacement& cell : scene.cells) {
    const double radius = shape_radius(scene.cell_types[cell.type].shape);
    least = least == 0 ? radius : std::min(least, radius);
  }
  return least;
}

}  // namespace rouleau::shape
