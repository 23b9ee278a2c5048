#include "rigid_outline.hpp"

#include <algorithm>
#include <limits>

#include "outline.hpp"

namespace rouleau::shape {

namespace {

constexpr int map_squares = 128;  ///< along each side of the map of distances

using Body = RigidBody<RigidOutline>;

/// Component of `point` along a direction and across it: the point as seen in a body that is turned that far.
Pair turned_back(Pair point, Pair direction) {
  return {direction.x * point.x + direction.y * point.y, direction.x * point.y - direction.y * point.x};
}

/// Whether all nodes of `a` keep their distance from the outline of `b` moved by `shift`.
bool nodes_keep_apart(const Body& a, const Body& b, const Place<2>& shift, double gap) {
  const Pair between{a.center[0] - b.center[0] - shift[0], a.center[1] - b.center[1] - shift[1]};
  const double ratio = a.scale / b.scale, least = gap / b.scale;
  Pair offset = turned_back(between, b.orientation.direction);
  offset = {offset.x / b.scale, offset.y / b.scale};
  const Pair relative = turned_back(a.orientation.direction, b.orientation.direction);
  const double c = ratio * relative.x, s = ratio * relative.y;
  return std::all_of(a.solid->nodes().begin(), a.solid->nodes().end(), [&](Pair node) {
    return b.solid->keeps({offset.x + c * node.x - s * node.y, offset.y + s * node.x + c * node.y}, least);
  });
}

}  // namespace

RigidOutline::RigidOutline(const scene::CellType& type, double unit, double /*gap*/) {
  const Outline all = make_outline(type.shape, type.segments);
  const Outline few = type.segments > most_nodes ? make_outline(type.shape, most_nodes) : all;
  for (const auto& node : few.nodes) nodes_.push_back({rounded(node.x() / unit), rounded(node.y() / unit)});
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Pair from = nodes_[i], to = nodes_[(i + 1) % nodes_.size()];
    along_.push_back({to.x - from.x, to.y - from.y});
    inverse_square_.push_back(1 / (along_[i].x * along_[i].x + along_[i].y * along_[i].y));
    radius_ = std::max(radius_, std::sqrt(from.x * from.x + from.y * from.y));
    half_segment_ = std::max(half_segment_, 0.5 / std::sqrt(inverse_square_[i]));
  }
  area_ = rounded(area_of(all) / (unit * unit));

  half_width_ = 1.25 * radius_;
  count_ = map_squares;
  const double step = 2 * half_width_ / count_;
  inverse_step_ = 1 / step;
  half_diagonal_ = 0.7072 * step;
  for (int j = 0; j < count_; ++j)
    for (int i = 0; i < count_; ++i)
      map_.push_back(distance({(i + 0.5) * step - half_width_, (j + 0.5) * step - half_width_}));

  // Nodes and directions of both bodies are rounded; both outlines may be coarser than they will be.
  double coarser = 0;
  if (few.nodes.size() < all.nodes.size())
    for (const auto& node : all.nodes)
      coarser = std::max(coarser, std::abs(distance({node.x() / unit, node.y() / unit})));
  allowance_ = rounded(2 * coarser + 4 * std::ldexp(1 + radius_, -24));
}

double RigidOutline::distance(Pair point) const {
  double square = std::numeric_limits<double>::infinity();
  int winding = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Pair from = nodes_[i], along = along_[i], to = nodes_[i + 1 < nodes_.size() ? i + 1 : 0];
    const double x = point.x - from.x, y = point.y - from.y;
    const double s = std::clamp((x * along.x + y * along.y) * inverse_square_[i], 0.0, 1.0);
    const double dx = x - s * along.x, dy = y - s * along.y;
    square = std::min(square, dx * dx + dy * dy);
    const double side = along.x * y - along.y * x;
    if (from.y <= point.y && to.y > point.y && side > 0) ++winding;
    if (from.y > point.y && to.y <= point.y && side < 0) --winding;
  }
  return winding != 0 ? -std::sqrt(square) : std::sqrt(square);
}

bool encloses(const Body& body, const Place<2>& point) {
  const Pair seen = turned_back({point[0] / body.scale, point[1] / body.scale}, body.orientation.direction);
  return !body.solid->keeps(seen, 0);
}

bool keep_apart(const Body& a, const Body& b, const Place<2>& shift, double gap) {
  const double x = b.center[0] + shift[0] - a.center[0], y = b.center[1] + shift[1] - a.center[1];
  const double reach = a.radius() + b.radius() + gap;
  if (x * x + y * y >= reach * reach) return true;
  return nodes_keep_apart(a, b, shift, gap) && nodes_keep_apart(b, a, {-shift[0], -shift[1]}, gap);
}

}  // namespace rouleau::shape
