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

/// Where the line at p goes through a triangle, if it does. Of two triangles with a common edge exactly one has a line
/// through that edge, so that a line enters a closed surface as often as it leaves it.
inline std::optional<LineCrossing> line_crossing(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c, LinePlace p) {
  // Twice the area of the triangle (from, to, q), positive where they run counter-clockwise. The same number but for
  // its sign where from and to change places.
  const auto twice_area = [](LinePlace from, LinePlace to, LinePlace q) {
    const bool swapped = to.y < from.y || (to.y == from.y && to.z < from.z);
    if (swapped) std::swap(from, to);
    const double area = (to.y - from.y) * (q.z - from.z) - (to.z - from.z) * (q.y - from.y);
    return swapped ? -area : area;
  };
  const LinePlace pa{a.y(), a.z()}, pb{b.y(), b.z()}, pc{c.y(), c.z()};
  const double whole = twice_area(pa, pb, pc);
  if (whole == 0) return std::nullopt;
  // A point on an edge lies beside it for one of its two directions.
  const auto beside = [&](double area, LinePlace from, LinePlace to) {
    if (whole < 0) area = -area, std::swap(from, to);
    return area > 0 || (area == 0 && (to.z > from.z || (to.z == from.z && to.y < from.y)));
  };
  const double in_a = twice_area(pb, pc, p), in_b = twice_area(pc, pa, p), in_c = twice_area(pa, pb, p);
  if (!beside(in_a, pb, pc) || !beside(in_b, pc, pa) || !beside(in_c, pa, pb)) return std::nullopt;
  // Seen from larger x the triangles that a line leaves through run counter-clockwise.
  return LineCrossing{(in_a * a.x() + in_b * b.x() + in_c * c.x()) / (in_a + in_b + in_c), whole > 0};
}

}  // namespace rouleau::core
