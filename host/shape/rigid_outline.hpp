// The outline of a cell as a rigid body that can be turned and scaled, and whether two of them keep a distance.
#pragma once

#include <algorithm>
#include <vector>

#include "rigid_body.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// A closed polygon, counter-clockwise, about the origin at angle 0, in a unit of length of the caller's choice.
class RigidOutline {
 public:
  static constexpr int dimension = 2;
  struct Orientation {
    std::uint32_t angle;
    Pair direction;
  };
  static Orientation orientation(std::uint32_t angle) { return {angle, direction_of(radians(angle))}; }
  static Orientation drawn(RandomNumbers& numbers) { return orientation(numbers.angle()); }
  /// Turned at random by a part `most` of a whole turn at most.
  static Orientation turned(const Orientation& from, double most, RandomNumbers& numbers) {
    return orientation(turned_by(from.angle, numbers.either_side(most)));
  }
  static Orientation of(const scene::CellPlacement& cell) { return {0, direction_of(cell.angle)}; }
  static void put(const Orientation& orientation, scene::CellPlacement& cell) {
    cell.angle = radians(orientation.angle);
  }

  /// Outline of a cell type. A polygon of more than `most_nodes` is replaced by a coarser one and allowance() says by
  /// how much gaps may be smaller than they seem.
  RigidOutline(const scene::CellType& type, double unit, double gap);
  static constexpr int most_nodes = 200;

  [[nodiscard]] const std::vector<Pair>& nodes() const { return nodes_; }
  [[nodiscard]] double radius() const { return radius_; }        ///< of the circle about the origin that holds it
  [[nodiscard]] double content() const { return area_; }         ///< enclosed, of the polygon with all its segments
  [[nodiscard]] double allowance() const { return allowance_; }  ///< rounding included
  /// By how much segments may be nearer to anything than their ends are, which then keep at least `gap` (the argument
  /// is that of RigidSurface's samples).
  [[nodiscard]] double between_samples(double gap) const {
    return half_segment_ < gap ? half_segment_ * half_segment_ / (2 * gap) : half_segment_;
  }
  /// Whether keeps(node, 0) holds for all nodes.
  template <class Keeps>
  [[nodiscard]] bool all_samples(const Keeps& keeps) const {
    return std::all_of(nodes_.begin(), nodes_.end(), [&](const Pair& node) { return keeps(node, 0.0); });
  }

  /// Distance of a point to the polygon, negative inside.
  [[nodiscard]] double distance(Pair point) const;
  /// distance(point) >= least, most often from a map of distances, else exactly.
  [[nodiscard]] bool keeps(Pair point, double least) const {
    const double reach = radius_ + least;
    if (reach <= 0 || point.x * point.x + point.y * point.y >= reach * reach) return true;
    const int i = static_cast<int>((point.x + half_width_) * inverse_step_),
              j = static_cast<int>((point.y + half_width_) * inverse_step_);
    if (i < 0 || j < 0 || i >= count_ || j >= count_) return distance(point) >= least;
    const double middle = map_[static_cast<std::size_t>(j) * static_cast<std::size_t>(count_) + i];
    if (middle - half_diagonal_ >= least) return true;
    if (middle + half_diagonal_ < least) return false;
    return distance(point) >= least;
  }

 private:
  std::vector<Pair> nodes_, along_;
  std::vector<double> inverse_square_;
  double radius_ = 0, area_ = 0, allowance_ = 0, half_segment_ = 0;
  // Distances in the middles of count x count squares that cover the outline and some more.
  int count_ = 0;
  double half_width_ = 0, inverse_step_ = 0, half_diagonal_ = 0;
  std::vector<double> map_;
};

/// A node of the outline as it lies from the centre of a body of size 1.
inline Place<2> rotated(const RigidOutline::Orientation& orientation, Pair node) {
  const double c = orientation.direction.x, s = orientation.direction.y;
  return {c * node.x - s * node.y, s * node.x + c * node.y};
}

/// Whether a body lies around a point, given as it lies from the body's centre.
bool encloses(const RigidBody<RigidOutline>& body, const Place<2>& point);

/// Whether the outlines of two bodies, the second moved by `shift`, keep the distance `gap` (above 0) and none lies in
/// the other. Exact for polygons whose thinnest place is wider than a segment is long.
bool keep_apart(const RigidBody<RigidOutline>& a, const RigidBody<RigidOutline>& b, const Place<2>& shift, double gap);

}  // namespace rouleau::shape
