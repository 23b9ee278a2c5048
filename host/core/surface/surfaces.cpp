#include "surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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

StretchRange stretch_range(const Surfaces& surfaces, int cell) {
  const RestSurface& rest = surfaces.type_of(cell);
  const Nodes now = surfaces.nodes(cell), then = rest.nodes();
  const double prestretch = std::sqrt(surface_area(rest.mesh, then) / rest.rest_surface_area);
  StretchRange range;
  for (const Mesh::Edge& edge : rest.mesh.edges()) {
    const double stretch = prestretch * (now[edge.b] - now[edge.a]).norm() / (then[edge.b] - then[edge.a]).norm();
    range.least = std::min(range.least, stretch);
    range.most = std::max(range.most, stretch);
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
