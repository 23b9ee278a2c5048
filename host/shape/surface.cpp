#include "surface.hpp"

#include <Eigen/Geometry>
#include <cmath>

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

TriangleSurface make_surface(const scene::CellType& type) {
  if (const auto* mesh = std::get_if<scene::MeshFile>(&type.shape)) return mesh_surface(*mesh);
  const int n = static_cast<int>(std::lround(std::sqrt(type.triangles / 20.0)));
  if (const auto* disc = std::get_if<scene::Biconcave>(&type.shape)) return core::biconcave_disc(n, disc->radius);
  if (const auto* solid = std::get_if<scene::Ellipsoid>(&type.shape))
    return core::ellipsoid(n, solid->semi_axes.in<3>());
  return core::ellipsoid(n, Vec<3>::Constant(std::get<scene::Sphere>(type.shape).radius));
}

Eigen::Matrix3d rotation_of(const std::optional<Eigen::Vector3d>& axis, double angle) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  if (!axis) return AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Quaterniond turned = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), *axis);
  return (turned * AngleAxisd(angle, Vector3d::UnitY())).toRotationMatrix();
}

}  // namespace rouleau::shape
