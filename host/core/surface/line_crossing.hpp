// Where a line parallel to x goes through a closed surface.
#pragma once

#include <optional>
#include <utility>

#include "core/domain/vec.hpp"

namespace rouleau::core {

/// A point of the plane of y and z.
struct LinePlace {
  double y, z;
};

struct LineCrossing {
  double x;
  bool leaves;  ///< going towards larger x the line leaves the surface here; else it enters
};

/// A triangle as lines parallel to x see it, of which many may be asked for.
class LinesThroughTriangle {
 public:
  LinesThroughTriangle(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) : x_{a.x(), b.x(), c.x()} {
    const LinePlace pa{a.y(), a.z()}, pb{b.y(), b.z()}, pc{c.y(), c.z()};
    edge_[0] = Edge(pb, pc), edge_[1] = Edge(pc, pa), edge_[2] = Edge(pa, pb);
    whole_ = edge_[2].twice_area(pc);
    // A point on an edge lies beside it for one of its two directions.
    const LinePlace corner[] = {pa, pb, pc};
    for (int k = 0; k < 3; ++k) {
      LinePlace from = corner[(k + 1) % 3], to = corner[(k + 2) % 3];
      if (whole_ < 0) std::swap(from, to);
      holds_its_points_[k] = to.z > from.z || (to.z == from.z && to.y < from.y);
    }
  }
  /// Where the line at p goes through it, if it does. Of two triangles with a common edge exactly one has a line
  /// through that edge, so that a line enters a closed surface as often as it leaves it.
  [[nodiscard]] std::optional<LineCrossing> crossing(LinePlace p) const {
    if (whole_ == 0) return std::nullopt;
    double in[3];
    for (int k = 0; k < 3; ++k) {
      in[k] = edge_[k].twice_area(p);
      const double area = whole_ < 0 ? -in[k] : in[k];
      if (!(area > 0 || (area == 0 && holds_its_points_[k]))) return std::nullopt;
    }
    // Seen from larger x the triangles that a line leaves through run counter-clockwise.
    return LineCrossing{(in[0] * x_[0] + in[1] * x_[1] + in[2] * x_[2]) / (in[0] + in[1] + in[2]), whole_ > 0};
  }

 private:
  /// Twice the area of the triangle (from, to, q), positive where they run counter-clockwise. The same number but for
  /// its sign where from and to change places.
  struct Edge {
    LinePlace from, along;
    bool swapped;
    Edge() = default;
    Edge(LinePlace a, LinePlace b) : swapped(b.y < a.y || (b.y == a.y && b.z < a.z)) {
      if (swapped) std::swap(a, b);
      from = a, along = {b.y - a.y, b.z - a.z};
    }
    [[nodiscard]] double twice_area(LinePlace q) const {
      const double area = along.y * (q.z - from.z) - along.z * (q.y - from.y);
      return swapped ? -area : area;
    }
  };
  double x_[3];
  Edge edge_[3];  // across from each corner
  double whole_;
  bool holds_its_points_[3];
};

}  // namespace rouleau::core
