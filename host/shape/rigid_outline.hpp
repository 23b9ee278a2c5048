// The outline of a cell as a rigid body that can be turned and scaled, and whether two of them keep a distance.
#pragma once

#include <cmath>
#include <vector>

#include "scene/scene.hpp"

namespace rouleau::shape {

// Everything here is made of additions, products, quotients and square roots of numbers that were rounded to multiples
// of a power of two, and compiled without contraction: the same on every machine, whatever its libm and instruction set
// (a cosine's last digit differs between libraries). Plain pairs instead of Eigen's vectors, whose functions the linker
// may take from a file that was compiled with contraction.

struct Pair {
  double x, y;
};

/// Cosine and sine rounded to multiples of 2^-24.
Pair direction_of(double angle);

/// A closed polygon, counter-clockwise, about the origin at angle 0, in a unit of length of the caller's choice.
class RigidOutline {
 public:
  /// Outline of a shape with this many segments. A polygon of more than `most_nodes` is replaced by a coarser one and
  /// allowance() says by how much gaps may be smaller than they seem.
  RigidOutline(const scene::Shape& shape, int segments, double unit);
  static constexpr int most_nodes = 200;

  [[nodiscard]] const std::vector<Pair>& nodes() const { return nodes_; }
  [[nodiscard]] double radius() const { return radius_; }        ///< of the circle about the origin that holds it
  [[nodiscard]] double area() const { return area_; }            ///< enclosed, of the polygon with all its segments
  [[nodiscard]] double allowance() const { return allowance_; }  ///< rounding included

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
  double radius_ = 0, area_ = 0, allowance_ = 0;
  // Distances in the middles of count x count squares that cover the outline and some more.
  int count_ = 0;
  double half_width_ = 0, inverse_step_ = 0, half_diagonal_ = 0;
  std::vector<double> map_;
};

/// An outline somewhere: point p of it lies at center + scale (turned p).
struct RigidBody {
  const RigidOutline* outline;
  Pair center, direction;
  double scale = 1;
  [[nodiscard]] double radius() const { return scale * outline->radius(); }
};

/// Whether the outlines of two bodies, the second moved by `shift`, keep the distance `gap` (above 0) and none lies in
/// the other. Exact for polygons whose thinnest place is wider than a segment is long.
bool keep_apart(const RigidBody& a, const RigidBody& b, Pair shift, double gap);

}  // namespace rouleau::shape
