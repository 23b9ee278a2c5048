#include "geometry.hpp"

#include <cmath>

namespace rouleau::core {

namespace {

Vec<2> node(const Membranes& membranes, int i) { return {membranes.position[0][i], membranes.position[1][i]}; }

/// Square of the distance from a point to the segment p ... q.
double square_distance(const Vec<2>& point, const Vec<2>& p, const Vec<2>& q) {
  const Vec<2> along = q - p, from = point - p;
  const double square = along.squaredNorm();
  const double s = square > 0 ? std::clamp(from.dot(along) / square, 0.0, 1.0) : 0.0;
  return (from - s * along).squaredNorm();
}

/// Moments of area about `origin`: area, first moments, second moments xx, xy, yy.
struct Moments {
  double area = 0;
  Vec<2> first = Vec<2>::Zero();
  double xx = 0, xy = 0, yy = 0;
};
Moments moments(const Membranes& membranes, const CellRange& cell, const Vec<2>& origin) {
  Moments sum;
  for (int i = cell.first; i < cell.end(); ++i) {
    const Vec<2> p = node(membranes, i) - origin, q = node(membranes, cell.next(i)) - origin;
    const double twice = cross(p, q);
    sum.area += twice / 2;
    sum.first += twice / 6 * (p + q);
    sum.xx += twice / 12 * (p.x() * p.x() + p.x() * q.x() + q.x() * q.x());
    sum.yy += twice / 12 * (p.y() * p.y() + p.y() * q.y() + q.y() * q.y());
    sum.xy += twice / 24 * (2 * p.x() * p.y() + p.x() * q.y() + q.x() * p.y() + 2 * q.x() * q.y());
  }
  return sum;
}

/// Smallest square distance from a point to an outline with these bounds; `best` if it is not below that.
double nearest(const Membranes& membranes, const CellRange& cell, const BoundingBox<2>& box, const Vec<2>& point,
               double best) {
  const double dx = std::max({0.0, box.least[0] - point.x(), point.x() - box.most[0]});
  const double dy = std::max({0.0, box.least[1] - point.y(), point.y() - box.most[1]});
  if (!(dx * dx + dy * dy <= best)) return best;
  for (int j = cell.first; j < cell.end(); ++j)
    best = std::min(best, square_distance(point, node(membranes, j), node(membranes, cell.next(j))));
  return best;
}

/// The same from the nodes of `a` moved by `move` to the outline of `b`.
double nearest_node(const Membranes& membranes, const CellRange& a, const CellRange& b, const Vec<2>& move,
                    double best) {
  const BoundingBox<2> box = box_of<2>(membranes, b);
  for (int i = a.first; i < a.end(); ++i) best = nearest(membranes, b, box, node(membranes, i) + move, best);
  return best;
}

}  // namespace

double enclosed_area(const Membranes& membranes, const CellRange& cell) {
  // Relative to the first node: far from the origin the digits would cancel otherwise.
  const Vec<2> origin = node(membranes, cell.first);
  double twice = 0;
  for (int i = cell.first; i < cell.end(); ++i)
    twice += cross(node(membranes, i) - origin, node(membranes, cell.next(i)) - origin);
  return twice / 2;
}

double perimeter(const Membranes& membranes, const CellRange& cell) {
  double sum = 0;
  for (int i = cell.first; i < cell.end(); ++i) sum += (node(membranes, cell.next(i)) - node(membranes, i)).norm();
  return sum;
}

StretchRange stretch_range(const Membranes& membranes, const CellRange& cell) {
  StretchRange range;
  const std::vector<double>& rest_length = membranes.type_of(cell).rest_length;
  for (int i = cell.first; i < cell.end(); ++i) {
    const double length = (node(membranes, cell.next(i)) - node(membranes, i)).norm();
    range.add(length / rest_length[i - cell.first]);
  }
  return range;
}

Vec<2> centroid(const Membranes& membranes, const CellRange& cell) {
  const Vec<2> origin = node(membranes, cell.first);
  const Moments sum = moments(membranes, cell, origin);
  return origin + sum.first / sum.area;
}

InertiaEllipse inertia_ellipse(const Membranes& membranes, const CellRange& cell) {
  const Moments sum = moments(membranes, cell, centroid(membranes, cell));
  const double xx = sum.xx / sum.area, xy = sum.xy / sum.area, yy = sum.yy / sum.area;
  const double middle = (xx + yy) / 2, radius = std::hypot((xx - yy) / 2, xy);
  InertiaEllipse ellipse{};
  ellipse.semi_major = 2 * std::sqrt(middle + radius);
  ellipse.semi_minor = 2 * std::sqrt(std::max(0.0, middle - radius));
  ellipse.angle = 0.5 * std::atan2(2 * xy, xx - yy);
  ellipse.deformation = (ellipse.semi_major - ellipse.semi_minor) / (ellipse.semi_major + ellipse.semi_minor);
  return ellipse;
}

double marker_angle(const Membranes& membranes, const CellRange& cell) {
  const Vec<2> arm = node(membranes, cell.first) - centroid(membranes, cell);
  return std::atan2(arm.y(), arm.x());
}

double outline_distance(const Membranes& membranes, const CellRange& a, const CellRange& b, ImageShift shift,
                        const Domain<2>& domain, double limit) {
  const Vec<2> move(shift.x * domain.period(0), shift.y * domain.period(1));
  const double outside = limit * limit;
  double best = std::nextafter(outside, std::numeric_limits<double>::infinity());
  best = nearest_node(membranes, a, b, -move, best);
  best = nearest_node(membranes, b, a, move, best);
  return best <= outside && std::isfinite(best) ? std::sqrt(best) : std::numeric_limits<double>::infinity();
}

double facing_length(const Membranes& membranes, const CellRange& a, const CellRange& b, ImageShift shift,
                     const Domain<2>& domain, double reach) {
  const Vec<2> move(shift.x * domain.period(0), shift.y * domain.period(1));
  const BoundingBox<2> box = box_of<2>(membranes, b);
  const std::vector<double>& weight = membranes.type_of(a).rest_weight;
  double length = 0;
  for (int i = a.first; i < a.end(); ++i) {
    const bool near = nearest(membranes, b, box, node(membranes, i) - move, reach * reach) < reach * reach;
    if (near) length += weight[i - a.first];
  }
  return length;
}

double smallest_gap(const Membranes& membranes, int a, int b, const Domain<2>& domain, double limit) {
  const CellRange& cell = membranes.cells[a];
  const CellRange& other = membranes.cells[b];
  double gap = std::numeric_limits<double>::infinity();
  for_each_image(box_of<2>(membranes, cell), box_of<2>(membranes, other), limit, domain, [&](ImageShift shift) {
    if (a == b && shift == ImageShift{}) return;
    gap = std::min(gap, outline_distance(membranes, cell, other, shift, domain, std::min(gap, limit)));
  });
  return gap;
}

double depth_inside(const Membranes& membranes, const CellRange& cell, const Vec<2>& point) {
  double square = std::numeric_limits<double>::infinity();
  int winding = 0;
  for (int i = cell.first; i < cell.end(); ++i) {
    const Vec<2> p = node(membranes, i), q = node(membranes, cell.next(i));
    square = std::min(square, square_distance(point, p, q));
    const double side = cross(q - p, point - p);
    if (p.y() <= point.y() && q.y() > point.y() && side > 0) ++winding;
    if (p.y() > point.y() && q.y() <= point.y() && side < 0) --winding;
  }
  return winding != 0 ? std::sqrt(square) : -std::sqrt(square);
}

}  // namespace rouleau::core
