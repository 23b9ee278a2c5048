#include "surface.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "formats/mesh_file.hpp"

namespace rouleau::shape {

using core::TriangleSurface, core::Vec;

TriangleSurface mesh_surface(const scene::MeshFile& mesh) {
  TriangleSurface made = read_mesh(mesh.file);
  const Vec<3> near = made.nodes[0];  // far from it the digits would cancel
  double volume = 0;
  Vec<3> moment = Vec<3>::Zero();
  for (const auto& [a, b, c] : made.triangles) {
    const Vec<3> p = made.nodes[a] - near, q = made.nodes[b] - near, r = made.nodes[c] - near;
    const double six = p.dot(q.cross(r));
    volume += six;
    moment += six * (p + q + r);
  }
  const Vec<3> centroid = near + moment / (4 * volume);
  for (Vec<3>& node : made.nodes) node = mesh.unit * (node - centroid);
  return made;
}

namespace {

TriangleSurface surface_of(const scene::Shape& shape, std::size_t triangles) {
  if (const auto* mesh = std::get_if<scene::MeshFile>(&shape)) return mesh_surface(*mesh);
  const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 20.0)));
  if (const auto* disc = std::get_if<scene::Biconcave>(&shape)) return core::biconcave_disc(n, disc->radius);
  if (const auto* solid = std::get_if<scene::Ellipsoid>(&shape))
    return (solid->even ? core::even_spheroid : core::ellipsoid)(n, solid->semi_axes.in<3>());
  return core::ellipsoid(n, Vec<3>::Constant(std::get<scene::Sphere>(shape).radius));
}

}  // namespace

TriangleSurface make_surface(const scene::CellType& type) {
  return surface_of(type.shape, static_cast<std::size_t>(type.triangles));
}

TriangleSurface stress_free_surface(const scene::CellType& type, const TriangleSurface& first) {
  TriangleSurface made = surface_of(type.stress_free->shape, first.triangles.size());
  const double scale = std::sqrt(core::content_of(first).area / core::content_of(made).area);
  for (Vec<3>& node : made.nodes) node *= type.stress_free->sized ? 1 : scale;
  return made;
}

void check_stress_free(const scene::Scene& scene) {
  for (const scene::CellType& type : scene.cell_types) {
    if (!type.stress_free || scene.domain.in_plane()) continue;
    const TriangleSurface first = make_surface(type);
    const TriangleSurface free = stress_free_surface(type, first);
    if (free.triangles == first.triangles) continue;
    const auto amount = [](const TriangleSurface& surface) { return std::to_string(surface.triangles.size()); };
    throw Error(
        Cause::bad_input, scene.place(type.stress_free->pointer),
        "the stress-free shape has other triangles, " + amount(free) + ", than the shape, " + amount(first) +
            ": the same numbers of nodes have to make them, in the same order",
        {"take meshes from frames of one run, and beside a shape that is no mesh give \"triangles\" as it had"});
  }
}

Eigen::Matrix3d rotation_of(const std::optional<Eigen::Vector3d>& axis, double angle) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  if (!axis) return AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Quaterniond turned = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), *axis);
  return (turned * AngleAxisd(angle, Vector3d::UnitY())).toRotationMatrix();
}

}  // namespace rouleau::shape
