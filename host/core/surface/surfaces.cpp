#include "surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace rouleau::core {

RestSurface make_rest_surface(Mesh mesh, std::vector<double> x, std::vector<double> y, std::vector<double> z,
                              double prestretch) {
  RestSurface rest(std::move(mesh));
  rest.x = std::move(x);
  rest.y = std::move(y);
  rest.z = std::move(z);
  const Nodes nodes = rest.nodes();
  const double square = prestretch * prestretch;
  rest.third_area.assign(rest.mesh.node_count(), 0.0);
  for (const auto& corners : rest.mesh.triangles()) {
    const Vec<3> e1 = nodes[corners[1]] - nodes[corners[0]], e2 = nodes[corners[2]] - nodes[corners[0]];
    const double g11 = e1.dot(e1), g12 = e1.dot(e2), g22 = e2.dot(e2), det = e1.cross(e2).squaredNorm();
    if (!(det > 0)) throw std::invalid_argument("a triangle of the surface has no area");
    rest.inverse_11.push_back(square * g22 / det);
    rest.inverse_12.push_back(-square * g12 / det);
    rest.inverse_22.push_back(square * g11 / det);
    const double area = std::sqrt(det) / 2 / square;
    rest.triangle_area.push_back(area);
    rest.rest_surface_area += area;
    for (const int node : corners) rest.third_area[node] += area / 3;
  }
  rest.node_area = node_areas(rest.mesh, nodes);
  rest.rest_curvature = integrated_curvature(rest.mesh, nodes);
  for (int i = 0; i < rest.mesh.node_count(); ++i) {
    rest.node_area[i] /= square;
    rest.rest_curvature[i] /= rest.node_area[i];
  }
  rest.rest_volume = enclosed_volume(rest.mesh, nodes);
  if (!(rest.rest_volume > 0))
    throw std::invalid_argument(
        "the triangles of the surface run clockwise seen from outside\nturn them over: swap two corners of each "
        "(meshing programs: invert the orientation of the faces)");
  return rest;
}

RestSurface created_as(const RestSurface& first, RestSurface rest) {
  rest.stress_free = {std::move(rest.x), std::move(rest.y), std::move(rest.z)};
  rest.x = first.x;
  rest.y = first.y;
  rest.z = first.z;
  rest.rest_volume = first.rest_volume;
  rest.rest_surface_area = first.rest_surface_area;
  return rest;
}

StretchRange stretch_range(const Surfaces& surfaces, int cell) {
  const RestSurface& rest = surfaces.type_of(cell);
  const Nodes then = rest.nodes_at_rest();
  const double at_rest = std::accumulate(rest.triangle_area.begin(), rest.triangle_area.end(), 0.0);
  return stretch_range(surfaces, cell, then, std::sqrt(surface_area(rest.mesh, then) / at_rest));
}

StretchRange stretch_range(const Surfaces& surfaces, int cell, Nodes then, double factor) {
  const Nodes now = surfaces.nodes(cell);
  StretchRange range;
  for (const Mesh::Edge& edge : surfaces.type_of(cell).mesh.edges())
    range.add(factor * (now[edge.b] - now[edge.a]).norm() / (then[edge.b] - then[edge.a]).norm());
  return range;
}

StretchRange first_stretch(const RestSurface& surface) {
  StretchRange range;
  const Nodes nodes = surface.nodes();
  for (int t = 0; t < surface.mesh.triangle_count(); ++t) {
    const auto& [a, b, c] = surface.mesh.triangles()[t];
    const Vec<3> e1 = nodes[b] - nodes[a], e2 = nodes[c] - nodes[a];
    // Eigenvalues of the metric over that at rest.
    const double h11 = surface.inverse_11[t], h12 = surface.inverse_12[t], h22 = surface.inverse_22[t];
    const double half = (h11 * e1.dot(e1) + 2 * h12 * e1.dot(e2) + h22 * e2.dot(e2)) / 2;
    const double product = (h11 * h22 - h12 * h12) * e1.cross(e2).squaredNorm();
    const double apart = std::sqrt(std::max(0.0, half * half - product));
    range.add(std::sqrt(half + apart));
    range.add(std::sqrt(product / (half + apart)));
  }
  return range;
}

void add_cell(Surfaces& surfaces, int type, const Vec<3>& center, const Eigen::Matrix3d& rotation) {
  const RestSurface& rest = *surfaces.types.at(type);
  surfaces.cells.push_back({{.first = surfaces.node_count(), .count = rest.mesh.node_count()}, type});
  for (int i = 0; i < rest.mesh.node_count(); ++i) {
    const Vec<3> place = center + rotation * rest.nodes()[i];
    surfaces.position[0].push_back(place.x());
    surfaces.position[1].push_back(place.y());
    surfaces.position[2].push_back(place.z());
  }
  surfaces.resize_to_positions();
}

}  // namespace rouleau::core
