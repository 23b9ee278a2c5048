#include "outline.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/surface/triangle_surface.hpp"

namespace rouleau::shape {

namespace {

constexpr double full_turn = 2 * std::numbers::pi;

/// A closed curve by an angle in [0, 2 pi), counter-clockwise from the positive x axis, and its derivative.
struct Curve {
  core::CurvePoint (*at)(const scene::Shape&, double angle);
  const scene::Shape& shape;
  core::CurvePoint operator()(double angle) const { return at(shape, angle); }
};

core::CurvePoint biconcave(const scene::Shape& shape, double angle) {
  return core::biconcave_curve(std::get<scene::Biconcave>(shape).radius, angle);
}

core::CurvePoint circle(const scene::Shape& shape, double angle) {
  const double radius = std::get<scene::Circle>(shape).radius;
  const double c = std::cos(angle), s = std::sin(angle);
  return {{radius * c, radius * s}, {-radius * s, radius * c}};
}

core::CurvePoint ellipse(const scene::Shape& shape, double angle) {
  const scene::Vector axes = std::get<scene::Ellipse>(shape).semi_axes;
  const double c = std::cos(angle), s = std::sin(angle);
  return {{axes.x() * c, axes.y() * s}, {-axes.x() * s, axes.y() * c}};
}

Curve curve_of(const scene::Shape& shape) {
  constexpr decltype(Curve::at) curves[] = {biconcave, circle, ellipse};  // in the order of the variant
  return {curves[shape.index()], shape};
}

double smallest_size(const scene::Shape& shape) {
  if (const auto* cell = std::get_if<scene::Biconcave>(&shape)) return cell->radius;
  if (const auto* cell = std::get_if<scene::Circle>(&shape)) return cell->radius;
  return std::get<scene::Ellipse>(shape).semi_axes.least();
}

/// Angle of the next node: the first one after `angle` where the curve is `chord` away. `stride` is a small part of a
/// turn.
double step(const Curve& curve, double angle, double chord, double stride) {
  const Eigen::Vector2d start = curve(angle).place;
  const auto distance = [&](const core::CurvePoint& point) { return (point.place - start).norm(); };
  double low = angle, high = angle + stride;
  while (distance(curve(high)) < chord && high < angle + full_turn) low = std::exchange(high, high + stride);
  double next = 0.5 * (low + high);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const core::CurvePoint point = curve(next);
    const double length = distance(point), slope = (point.place - start).dot(point.derivative) / length;
    (length < chord ? low : high) = next;
    double newton = next - (length - chord) / slope;
    if (!(newton > low && newton < high)) newton = 0.5 * (low + high);
    const double change = std::abs(newton - std::exchange(next, newton));
    if (change < 1e-16 * full_turn) break;
  }
  return next;
}

/// Angles of nodes 0 ... segments when every segment has length `chord`; the last one ought to be a full turn.
void march(const Curve& curve, double chord, std::vector<double>& angles) {
  const double stride = full_turn / 4 / static_cast<double>(angles.size());
  angles[0] = 0;
  for (std::size_t i = 1; i < angles.size(); ++i) angles[i] = step(curve, angles[i - 1], chord, stride);
}

}  // namespace

Outline make_outline(const scene::Shape& shape, int segments) {
  if (segments < 3) throw std::invalid_argument("an outline needs at least 3 segments");
  if (!(smallest_size(shape) > 0)) throw std::invalid_argument("the size of a cell must be positive");
  const Curve curve = curve_of(shape);

  double chord = 0;
  for (int i = 0; i < segments; ++i)
    chord += (curve(full_turn * (i + 1) / segments).place - curve(full_turn * i / segments).place).norm() / segments;
  // Secant steps on the chord until the nodes close after exactly one turn.
  std::vector<double> angles(static_cast<std::size_t>(segments) + 1);
  double old_chord = 0, old_excess = -full_turn;
  for (int iteration = 0; iteration < 40; ++iteration) {
    march(curve, chord, angles);
    const double excess = angles.back() - full_turn;
    if (std::abs(excess) < 1e-15 * segments) break;
    const double next = chord - excess * (chord - old_chord) / (excess - old_excess);
    if (next == chord) break;
    old_chord = std::exchange(chord, next);
    old_excess = excess;
  }

  // What is left of the gap would all fall on the last segment: share it.
  const double gap = angles.back() - full_turn;
  for (int i = 0; i < segments; ++i) angles[i] -= gap * i / segments;

  Outline outline;
  outline.nodes.reserve(static_cast<std::size_t>(segments));
  for (int i = 0; i < segments; ++i) outline.nodes.push_back(curve(angles[i]).place);
  return outline;
}

Outline stress_free_outline(const scene::CellType& type, const Outline& first) {
  Outline made = make_outline(type.stress_free->shape, static_cast<int>(first.nodes.size()));
  const auto segment = [](const Outline& outline) { return (outline.nodes[1] - outline.nodes[0]).norm(); };
  const double scale = segment(first) / segment(made);
  for (Eigen::Vector2d& node : made.nodes) node *= type.stress_free->sized ? 1 : scale;
  return made;
}

double shape_perimeter(const scene::Shape& shape) {
  if (const auto* biconcave = std::get_if<scene::Biconcave>(&shape)) return 4.9285 * biconcave->radius;
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) return full_turn * circle->radius;
  const scene::Vector& a = std::get<scene::Ellipse>(shape).semi_axes;
  return full_turn / 2 * (3 * (a.x() + a.y()) - std::sqrt((3 * a.x() + a.y()) * (a.x() + 3 * a.y())));
}

double area_of(const Outline& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.nodes.size(); ++i) {
    const Eigen::Vector2d &p = outline.nodes[i], &q = outline.nodes[(i + 1) % outline.nodes.size()];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return twice / 2;
}

}  // namespace rouleau::shape
