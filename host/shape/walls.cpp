#include "walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "core/geometry/faceted.hpp"
#include "core/geometry/formulas.hpp"
#include "core/geometry/parts.hpp"
#include "core/geometry/region.hpp"
#include "json/json_pointer.hpp"
#include "scene/scene_reader.hpp"
#include "wall_borders.hpp"

namespace rouleau::shape {

namespace {

using core::RegionPointer;
using core::Vec;
using scene::WallShape;

constexpr double endless = std::numeric_limits<double>::infinity();

/// Places in a unit of length that every lattice of the domain has: its nodes over their common divisor. As core has
/// it, a domain begins half a unit before its first node.
double common_unit(const scene::Domain& domain) {
  const int divisor =
      std::accumulate(domain.nodes.begin(), domain.nodes.end(), 0, [](int a, int b) { return std::gcd(a, b); });
  return domain.size.x() / domain.nodes[0] * divisor;
}

template <int D>
core::Domain<D> domain_in(double unit, const scene::Domain& domain) {
  core::Domain<D> made;
  for (int k = 0; k < D; ++k) {
    made.size[k] = static_cast<int>(std::lround(domain.size[k] / unit));
    made.periodic[k] = domain.periodic[k];
  }
  made.open_axis = domain.open_axis;
  made.block = {{}, made.size};
  return made;
}

RegionPointer<2> standing(RegionPointer<2> section, double, double, std::integral_constant<int, 2>) { return section; }
RegionPointer<3> standing(RegionPointer<2> section, double from, double to, std::integral_constant<int, 3>) {
  return core::extruded(std::move(section), 2, from, to);
}
/// There are none in the plane.
RegionPointer<2> round_about(int, const Vec<2>& center, double radius, double, double, std::integral_constant<int, 2>) {
  return core::ball_region<2>(center, radius);
}
RegionPointer<3> round_about(int axis, const Vec<2>& center, double radius, double from, double to,
                             std::integral_constant<int, 3>) {
  return core::extruded(core::ball_region<2>(center, radius), axis, from, to);
}

/// Regions of shapes, each with its images along periodic axes.
template <int D>
class Builder {
  static constexpr std::integral_constant<int, D> here{};

 public:
  Builder(const scene::Domain& domain, double unit, const scene::SceneFields& fields)
      : unit_(unit), domain_(domain_in<D>(unit, domain)), fields_(fields) {}

  [[nodiscard]] const core::Domain<D>& domain() const { return domain_; }

  RegionPointer<D> of(const WallShape& shape) const {
    return std::visit([&](const auto& is) { return region(shape.pointer, is); }, shape.is);
  }

 private:
  [[nodiscard]] double at(double metres) const { return metres / unit_ - 0.5; }
  template <int K>
  [[nodiscard]] Vec<K> at(const scene::Vector& metres) const {
    return metres.in<K>() / unit_ - Vec<K>::Constant(0.5);
  }

  /// Whether what reaches from one place to another fills a period along an axis: then there is no end.
  [[nodiscard]] bool passes(int axis, double from, double to) const {
    constexpr double exact = 1e-9;
    const double period = domain_.period(axis);
    return period > 0 && from <= -0.5 + exact * period && to >= period - 0.5 - exact * period;
  }

  /// Ends along an axis, those taken away that lie at the ends of a period, or of the domain at an opening.
  void take_ends(int axis, double& from, double& to) const {
    constexpr double exact = 1e-9;
    if (passes(axis, from, to)) from = -endless, to = endless;
    if (axis != domain_.open_axis) return;
    const double size = domain_.size[axis];
    if (from <= -0.5 + exact * size) from = -endless;
    if (to >= size - 0.5 - exact * size) to = endless;
  }

  /// Gradient of the velocity of what turns.
  static Eigen::Matrix<double, D, D> spin(const Eigen::Vector3d& w) {
    Eigen::Matrix3d cross;
    cross << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    return cross.topLeftCorner<D, D>();
  }

  /// Of a wall that slides along an axis.
  void require_endless(const std::string& pointer, int axis, double from, double to) const {
    if (!std::isfinite(from) && !std::isfinite(to)) return;
    fields_.refuse(pointer, std::string("this wall ends along ") + scene::axis_names[axis] +
                                ", and would move through the fluid\nwalls move along themselves: let it reach from "
                                "one end of the domain to the other along an axis that is periodic, or let this be 0");
  }

  /// With images along the periodic axes that it does not pass; refused where it reaches farther than a period beyond.
  RegionPointer<D> imaged(const std::string& pointer, RegionPointer<D> region, const Vec<D>& from,
                          const Vec<D>& to) const {
    core::Domain<D> around = domain_;
    for (int k = 0; k < D; ++k) {
      const double period = domain_.period(k);
      around.periodic[k] = period > 0 && std::isfinite(from[k]) && std::isfinite(to[k]);
      if (around.periodic[k]) require_reach(fields_, pointer, k, period, from[k], to[k], unit_);
    }
    if (std::ranges::none_of(around.periodic, [](bool periodic) { return periodic; })) return region;
    return core::repeated<D>(std::move(region), (from + to) / 2, around);
  }

  RegionPointer<D> region(const std::string& pointer, const WallShape::Box& box) const {
    Vec<D> from = at<D>(box.lower), to = at<D>(box.upper);
    core::BorderMotion<D> motion{.velocity = box.velocity.head<D>() / unit_};
    for (int k = 0; k < D; ++k) {
      take_ends(k, from[k], to[k]);
      if (motion.velocity[k] != 0)
        require_endless(json::child_pointer(pointer + "/box/velocity", k), k, from[k], to[k]);
    }
    return imaged(pointer, core::moving<D>(core::box_region<D>(from, to), motion), from, to);
  }

  RegionPointer<D> region(const std::string& pointer, const WallShape::Sphere& sphere) const {
    const Vec<D> center = at<D>(sphere.center), out = Vec<D>::Constant(sphere.radius / unit_);
    const core::BorderMotion<D> motion{.spin = spin(sphere.angular_velocity), .center = center};
    return imaged(pointer, core::moving<D>(core::ball_region<D>(center, sphere.radius / unit_), motion), center - out,
                  center + out);
  }

  RegionPointer<D> region(const std::string& pointer, const WallShape::Cylinder& cylinder) const {
    double from = at(cylinder.from), to = at(cylinder.to);
    take_ends(cylinder.axis, from, to);
    if (cylinder.velocity != 0) require_endless(pointer + "/cylinder/velocity", cylinder.axis, from, to);
    const Vec<2> center(at(cylinder.center[0]), at(cylinder.center[1]));
    const double radius = cylinder.radius / unit_;
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(cylinder.axis);
    core::BorderMotion<D> motion{.velocity = (cylinder.velocity / unit_ * axis).head<D>(),
                                 .spin = spin(cylinder.angular_velocity * axis)};
    Vec<D> lower, upper;
    for (int k = 0, across = 0; k < D; ++k) {
      const bool along = k == cylinder.axis;
      if (!along) motion.center[k] = center[across];
      lower[k] = along ? from : center[across] - radius, upper[k] = along ? to : center[across] + radius;
      if (!along) ++across;
    }
    return imaged(pointer, core::moving<D>(round_about(cylinder.axis, center, radius, from, to, here), motion), lower,
                  upper);
  }

  RegionPointer<D> region(const std::string& pointer, const WallShape::Outline& outline) const {
    core::Border<2> border;
    for (const auto& [x, y] : outline.points) {
      const int i = static_cast<int>(border.corners.size()), next = (i + 1) % static_cast<int>(outline.points.size());
      border.corners.push_back({at(x), at(y)});
      border.facets.push_back({i, next});
    }
    return stood(pointer, enclosed<2>(pointer + "/outline", std::move(border)), at(outline.lower), at(outline.upper));
  }

  RegionPointer<D> region(const std::string& pointer, const WallShape::Mesh& mesh) const {
    core::Border<3> read = mesh_border(mesh);
    core::Border<D> border;  // in the plane there are none
    for (const Vec<3>& corner : read.corners)
      border.corners.push_back(corner.template head<D>() / unit_ - Vec<D>::Constant(0.5));
    for (const auto& facet : read.facets) std::copy_n(facet.begin(), D, border.facets.emplace_back().begin());
    return enclosed<D>(pointer + "/mesh/file", std::move(border));
  }

  RegionPointer<D> region(const std::string& pointer, const WallShape::Image& image) const {
    if (image.spacing > 0) return pictured<D>(pointer + "/image", image);
    return stood(pointer, pictured<2>(pointer + "/image", image), -endless, endless);
  }

  RegionPointer<D> region(const std::string&, const WallShape::Joined& joined) const {
    std::vector<RegionPointer<D>> parts;
    for (const WallShape& part : joined.parts) {
      fields_.attempt([&] {
        RegionPointer<D> made = of(part);
        const bool removed = joined.kind == WallShape::Kind::first_without_others && !parts.empty();
        parts.push_back(removed ? core::outside_of<D>(std::move(made)) : std::move(made));
      });
    }
    if (parts.empty()) throw scene::Misread{};
    return joined.kind == WallShape::Kind::any_of ? core::union_of<D>(std::move(parts))
                                                  : core::intersection<D>(std::move(parts));
  }

  /// A section along x and y, with images there, between two heights.
  RegionPointer<D> stood(const std::string& pointer, RegionPointer<2> section, double from, double to) const {
    constexpr int up = 2;
    Vec<D> lower = Vec<D>::Constant(-endless), upper = Vec<D>::Constant(endless);
    if (D > up && !passes(std::min(up, D - 1), from, to)) lower[D - 1] = from, upper[D - 1] = to;
    return imaged(pointer, standing(std::move(section), lower[D - 1], upper[D - 1], here), lower, upper);
  }

  template <int K>
  RegionPointer<K> enclosed(const std::string& pointer, core::Border<K> border) const {
    return closed_region<K>(fields_, pointer, std::move(border), first_axes<K>(), unit_);
  }
  template <int K>
  RegionPointer<K> pictured(const std::string& pointer, const WallShape::Image& image) const {
    return picture_region<K>(fields_, pointer, image, first_axes<K>(), unit_);
  }
  template <int K>
  [[nodiscard]] core::Domain<K> first_axes() const {
    core::Domain<K> some;
    std::copy_n(domain_.size.begin(), K, some.size.begin());
    std::copy_n(domain_.periodic.begin(), K, some.periodic.begin());
    some.block = {{}, some.size};
    some.open_axis = domain_.open_axis < K ? domain_.open_axis : -1;
    return some;
  }

  double unit_;
  core::Domain<D> domain_;
  const scene::SceneFields& fields_;
};

template <int D, class Visit>
void halve(Vec<D> middle, Vec<D> half, Visit visit) {
  int longest = 0;
  half.maxCoeff(&longest);
  half[longest] /= 2;
  middle[longest] -= half[longest];
  visit(middle, half);
  middle[longest] += 2 * half[longest];
  visit(middle, half);
}

/// Whether a region has something in a box, or comes near to it.
template <int D>
bool reaches(const core::Region<D>& region, const Vec<D>& middle, const Vec<D>& half, int halvings) {
  const double found = region.distance(middle).value;
  if (found > 0 || found <= -half.norm() || halvings == 0) return found > -half.norm();
  bool any = false;
  halve<D>(middle, half, [&](const Vec<D>& m, const Vec<D>& h) { any = any || reaches(region, m, h, halvings - 1); });
  return any;
}

/// Half of each side of a domain.
template <int D>
Vec<D> half_of(const core::Domain<D>& domain) {
  Vec<D> half;
  for (int k = 0; k < D; ++k) half[k] = 0.5 * domain.size[k];
  return half;
}

/// What fluid fills of a domain.
template <int D>
class Measure {
 public:
  Measure(const core::Region<D>& region, const core::Domain<D>& domain)
      : region_(region), planes_(core::between_walls(domain)) {
    const Vec<D> half = half_of(domain), middle = half - Vec<D>::Constant(0.5);
    content = core::content_of<D>(region, middle, half, content_halvings);
    seek_width(middle, half, content_halvings);
  }
  double content = 0;
  double width = 0;  ///< twice the largest distance to a wall, to 1 %

 private:
  void seek_width(const Vec<D>& middle, const Vec<D>& half, int halvings) {
    constexpr double enough = 1.01;
    const double found = std::min(region_.distance(middle).value, planes_->distance(middle).value);
    width = std::max(width, 2 * found);
    if (halvings == 0 || 2 * (found + half.norm()) <= enough * width) return;
    halve<D>(middle, half, [&](const Vec<D>& m, const Vec<D>& h) { seek_width(m, h, halvings - 1); });
  }

  const core::Region<D>& region_;
  RegionPointer<D> planes_;
};

template <int D>
void build(scene::Domain& domain, const scene::SceneFields& fields, const Faults& faults) {
  const double unit = common_unit(domain);
  const Builder<D> builder(domain, unit, fields);
  std::vector<RegionPointer<D>> parts;
  if (domain.within) fields.attempt([&] { parts.push_back(builder.of(*domain.within)); });
  const Vec<D> half = half_of(builder.domain());
  domain.obstacles_outside.clear();
  for (const WallShape& obstacle : domain.obstacles) {
    fields.attempt([&] {
      const RegionPointer<D> inside = builder.of(obstacle);
      if (!reaches<D>(*inside, half - Vec<D>::Constant(0.5), half, content_halvings))
        domain.obstacles_outside.push_back(obstacle.pointer);
      parts.push_back(core::outside_of<D>(inside));
    });
  }
  if (!faults.empty()) return;
  const RegionPointer<D> fluid = core::intersection<D>(std::move(parts));
  const std::string pointer = domain.within ? domain.within->pointer : "/domain/obstacles";
  const Measure<D> measured(*fluid, builder.domain());
  if (!(measured.content > 0))
    fields.refuse(pointer,
                  "these walls leave no fluid in the domain\nmove or turn them; lengths "
                  "are those of the domain, from its lower corner");
  if (!std::isfinite(measured.width))
    fields.refuse(pointer,
                  "these shapes leave no wall in the domain, and there are none across y "
                  "or z\nleave them out, or make them smaller than the domain");
  domain.region_content = measured.content * std::pow(unit, D);
  domain.region_width = measured.width * unit;
  domain.region<D>() = core::magnified<D>(fluid, unit, Vec<D>::Constant(0.5 * unit));
}

}  // namespace

void build_walls(scene::Scene& scene, Faults& faults) {
  if (!scene.domain.has_shapes()) return;
  const scene::SceneFields fields(*scene.document, faults);
  fields.attempt([&] {
    scene::in_dimension(scene.domain.dimension(),
                        [&]<int D>(std::integral_constant<int, D>) { build<D>(scene.domain, fields, faults); });
  });
}

}  // namespace rouleau::shape
