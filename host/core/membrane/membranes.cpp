#include "membranes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/contact/crossing.hpp"
#include "geometry.hpp"
#include "shape/outline.hpp"

namespace rouleau::membrane {

namespace {

/// Outline of a cell type with what its cells share, in lattice units.
struct Template {
  std::vector<Eigen::Vector2d> nodes;
  std::vector<double> rest_length, rest_weight, rest_curvature;
  double rest_area, rest_perimeter;
};

Template make_template(const scene::CellType& type, double spacing) {
  Template made;
  made.nodes = shape::make_outline(type.shape, type.segments).nodes;
  for (Eigen::Vector2d& node : made.nodes) node /= spacing;
  const auto* circle = std::get_if<scene::Circle>(&type.shape);
  const double prestretch = circle != nullptr ? circle->prestretch : 1.0;

  const std::size_t count = made.nodes.size();
  const auto tangent = [&](std::size_t i) -> Eigen::Vector2d { return made.nodes[(i + 1) % count] - made.nodes[i]; };
  made.rest_area = made.rest_perimeter = 0;
  for (std::size_t i = 0; i < count; ++i) {
    made.rest_length.push_back(tangent(i).norm() / prestretch);
    made.rest_perimeter += made.rest_length.back();
    const Eigen::Vector2d &p = made.nodes[i], &q = made.nodes[(i + 1) % count];
    made.rest_area += (p.x() * q.y() - p.y() * q.x()) / 2;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = (i + count - 1) % count;
    const Eigen::Vector2d s = tangent(before), t = tangent(i);
    made.rest_weight.push_back((made.rest_length[before] + made.rest_length[i]) / 2);
    made.rest_curvature.push_back(std::atan2(s.x() * t.y() - s.y() * t.x(), s.dot(t)) / made.rest_weight.back());
  }
  return made;
}

/// Everything that a message about a place in the scene needs.
class Checker {
 public:
  Checker(const scene::Scene& scene, const Membranes& membranes, double spacing)
      : scene_(scene),
        membranes_(membranes),
        spacing_(spacing),
        box_{static_cast<double>(scene.domain.nodes[0]), scene.domain.periodic_y ? scene.domain.nodes[1] : 0.0} {}

  void check() const {
    for (std::size_t i = 0; i < membranes_.cells.size(); ++i) check_fits(i);
    if (const auto crossing = contact::find_crossing(membranes_, box_)) report(*crossing);
  }

 private:
  [[noreturn]] void refuse(std::size_t cell, const std::string& problem) const {
    const std::string& pointer = scene_.cells[cell].pointer;
    const Place place = scene_.document ? scene_.place(pointer) : Place{"", pointer};
    throw Error(ExitCode::bad_input, place, problem);
  }
  [[nodiscard]] std::string micrometres(double spacings) const {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g um", spacings * spacing_ * 1e6);
    return text;
  }
  [[nodiscard]] std::string name(int cell) const {
    return "cell " + std::to_string(cell) + " (" + scene_.cells[static_cast<std::size_t>(cell)].pointer + ")";
  }

  void check_fits(std::size_t cell) const {
    const Bounds extent = bounds(membranes_, membranes_.cells[cell]);
    const std::string who = name(static_cast<int>(cell));
    const double width = extent.x_max - extent.x_min, height = extent.y_max - extent.y_min;
    if (!(width < box_.nx)) {
      refuse(cell, who + " is " + micrometres(width) + " wide, more than the periodic length of the domain, " +
                       micrometres(box_.nx) + "; make the domain longer.");
    }
    if (box_.periodic_y()) {
      if (!(height < box_.ny)) {
        refuse(cell, who + " is " + micrometres(height) + " high, more than the periodic height of the domain, " +
                         micrometres(box_.ny) + "; make the domain higher.");
      }
      return;
    }
    const double below = -0.5 - extent.y_min, above = extent.y_max - (scene_.domain.nodes[1] - 0.5);
    if (!(below < 0)) stick_out(cell, "lower", below);
    if (!(above < 0)) stick_out(cell, "upper", above);
  }
  [[noreturn]] void stick_out(std::size_t cell, const char* wall, double amount) const {
    refuse(cell, name(static_cast<int>(cell)) + " sticks through the " + wall + " wall by " + micrometres(amount) +
                     "; move it away from the wall.");
  }

  [[noreturn]] void report(const contact::Crossing& crossing) const {
    const auto cell = static_cast<std::size_t>(crossing.cell);
    const bool own = crossing.cell == crossing.other;
    if (own && crossing.shift == ImageShift{}) refuse(cell, name(crossing.cell) + " crosses itself; change its shape.");
    const double depth = overlap(crossing);
    const std::string amount = depth > 0 ? "overlap by " + micrometres(depth) : "cross";
    if (own) {
      refuse(cell, name(crossing.cell) + " and its own periodic image " + amount + "; make the domain longer.");
    }
    const bool image = !(crossing.shift == ImageShift{});
    refuse(cell, name(crossing.cell) + " and " + (image ? "a periodic image of " : "") + name(crossing.other) + " " +
                     amount + "; move them apart.");
  }
  /// Largest depth of a node of one cell inside the other.
  [[nodiscard]] double overlap(const contact::Crossing& crossing) const {
    const CellRange& a = membranes_.cells[static_cast<std::size_t>(crossing.cell)];
    const CellRange& b = membranes_.cells[static_cast<std::size_t>(crossing.other)];
    const Eigen::Vector2d move(crossing.shift.x * box_.nx, crossing.shift.y * box_.ny);
    double depth = 0;
    for (int i = a.first; i < a.end(); ++i) depth = std::max(depth, depth_inside(membranes_, b, node(i) - move));
    for (int i = b.first; i < b.end(); ++i) depth = std::max(depth, depth_inside(membranes_, a, node(i) + move));
    return depth;
  }
  [[nodiscard]] Eigen::Vector2d node(int i) const {
    return {membranes_.x[static_cast<std::size_t>(i)], membranes_.y[static_cast<std::size_t>(i)]};
  }

  const scene::Scene& scene_;
  const Membranes& membranes_;
  double spacing_;
  PeriodicBox box_;
};

void append(std::vector<double>& to, const std::vector<double>& from) { to.insert(to.end(), from.begin(), from.end()); }

}  // namespace

Membranes make_membranes(const scene::Scene& scene, double spacing) {
  std::vector<Template> templates;
  for (const scene::CellType& type : scene.cell_types) templates.push_back(make_template(type, spacing));

  Membranes membranes;
  for (const scene::CellPlacement& placement : scene.cells) {
    const Template& shape = templates[static_cast<std::size_t>(placement.type)];
    membranes.cells.push_back({placement.type, membranes.node_count(), static_cast<int>(shape.nodes.size()),
                               shape.rest_area, shape.rest_perimeter});
    const double c = std::cos(placement.angle), s = std::sin(placement.angle);
    // Lattice nodes are centres of unit squares, so the first lies half a spacing from the domain's edges.
    const Eigen::Vector2d center = placement.center / spacing - Eigen::Vector2d(0.5, 0.5);
    for (const Eigen::Vector2d& node : shape.nodes) {
      membranes.x.push_back(center.x() + c * node.x() - s * node.y());
      membranes.y.push_back(center.y() + s * node.x() + c * node.y());
    }
    append(membranes.rest_length, shape.rest_length);
    append(membranes.rest_weight, shape.rest_weight);
    append(membranes.rest_curvature, shape.rest_curvature);
  }
  for (auto* values : {&membranes.force_x, &membranes.force_y, &membranes.velocity_x, &membranes.velocity_y}) {
    values->assign(membranes.x.size(), 0.0);
  }
  Checker(scene, membranes, spacing).check();
  return membranes;
}

}  // namespace rouleau::membrane
