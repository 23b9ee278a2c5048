#include "rigid_surface.hpp"

#include <algorithm>
#include <map>

#include "extent.hpp"
#include "surface.hpp"

namespace rouleau::shape {

namespace {

constexpr int map_steps = 40;                ///< of the map of distances, along the radius
constexpr std::size_t most_samples = 12000;  ///< up to which triangles are divided
constexpr double least_from_pole = 0x1p-20;

/// a + s b
Place<3> along(const Place<3>& a, double s, const Place<3>& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

/// Distance of a point to a triangle, squared (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
double square_distance(const Place<3>& p, const Place<3>& a, const Place<3>& b, const Place<3>& c) {
  const Place<3> ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bp = minus(p, b), cp = minus(p, c);
  const auto square = [](const Place<3>& v) { return dot(v, v); };
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return square(ap);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return square(bp);
  const double in_c = d1 * d4 - d3 * d2;
  if (in_c <= 0 && d1 >= 0 && d3 <= 0) return square(along(ap, -d1 / (d1 - d3), ab));
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return square(cp);
  const double in_b = d5 * d2 - d1 * d6;
  if (in_b <= 0 && d2 >= 0 && d6 <= 0) return square(along(ap, -d2 / (d2 - d6), ac));
  const double in_a = d3 * d6 - d5 * d4;
  if (in_a <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return square(along(bp, -(d4 - d3) / ((d4 - d3) + (d5 - d6)), minus(c, b)));
  const double inverse = 1 / (in_a + in_b + in_c);
  return square(along(along(ap, -in_b * inverse, ab), -in_c * inverse, ac));
}

/// Turns the y axis by the shortest way to `axis`, after a turn by `angle` about it.
RigidSurface::Orientation orientation(const Place<3>& axis, std::uint32_t angle) {
  const auto [x, y, z] = axis;
  const double k = 1 / (1 + y);
  const std::array<Place<3>, 3> swing{{{1 - k * x * x, x, -k * x * z}, {-x, y, -z}, {-k * x * z, z, 1 - k * z * z}}};
  const auto [c, s] = direction_of(radians(angle));
  RigidSurface::Orientation made{{}, axis, angle};
  for (int i = 0; i < 3; ++i)
    made.rows[i] = {c * swing[i][0] - s * swing[i][2], swing[i][1], s * swing[i][0] + c * swing[i][2]};
  return made;
}

/// The inverse of rotated().
Place<3> back(const RigidSurface::Orientation& turn, const Place<3>& v) {
  Place<3> seen;
  for (int k = 0; k < 3; ++k) seen[k] = turn.rows[0][k] * v[0] + turn.rows[1][k] * v[1] + turn.rows[2][k] * v[2];
  return seen;
}

}  // namespace

RigidSurface::Orientation RigidSurface::drawn(RandomNumbers& numbers) {
  for (;;) {  // Marsaglia, Annals of Mathematical Statistics 43, 645 (1972)
    const double u = numbers.either_side(1), v = numbers.either_side(1), s = u * u + v * v;
    const std::uint32_t angle = numbers.angle();
    if (s >= 1 || s < least_from_pole) continue;  // from the pole -y there is no shortest way
    const double root = 2 * std::sqrt(1 - s);
    return orientation({u * root, 2 * s - 1, v * root}, angle);
  }
}

RigidSurface::Orientation RigidSurface::turned(const Orientation& from, double most, RandomNumbers& numbers) {
  const double radius = 2 * std::numbers::pi * most;
  const std::uint32_t angle = turned_by(from.angle, numbers.either_side(most));
  for (;;) {
    Place<3> way;
    for (double& component : way) component = numbers.either_side(1);
    if (dot(way, way) > 1) continue;
    const Place<3> moved = along(from.axis, radius, way);
    const double length = norm(moved);
    if (!(length > least_from_pole)) continue;
    const Place<3> axis{moved[0] / length, moved[1] / length, moved[2] / length};
    if (1 + axis[1] < least_from_pole) continue;
    return orientation(axis, angle);
  }
}

RigidSurface::Orientation RigidSurface::of(const scene::CellPlacement& cell) {
  const Eigen::Matrix3d matrix = rotation_of(cell);
  Orientation found{};
  for (int i = 0; i < 3; ++i) found.rows[i] = {rounded(matrix(i, 0)), rounded(matrix(i, 1)), rounded(matrix(i, 2))};
  return found;
}

void RigidSurface::put(const Orientation& orientation, scene::CellPlacement& cell) {
  cell.axis = Eigen::Vector3d(orientation.axis[0], orientation.axis[1], orientation.axis[2]);
  cell.angle = radians(orientation.angle);
}

Place<3> rotated(const RigidSurface::Orientation& orientation, const Place<3>& point) {
  return {dot(orientation.rows[0], point), dot(orientation.rows[1], point), dot(orientation.rows[2], point)};
}

RigidSurface::RigidSurface(const scene::CellType& type, double unit, double gap) {
  const core::TriangleSurface surface = make_surface(type);
  triangles_ = surface.triangles;
  for (const core::Vec<3>& node : surface.nodes) {
    nodes_.push_back({rounded(node.x() / unit), rounded(node.y() / unit), rounded(node.z() / unit)});
    radius_ = std::max(radius_, norm(nodes_.back()));
  }
  volume_ = rounded(enclosed_by(type) / (unit * unit * unit));
  std::vector<Place<3>> middles;
  std::vector<double> radii;
  for (const auto& [a, b, c] : triangles_) {
    Place<3> middle;
    for (int k = 0; k < 3; ++k) middle[k] = (nodes_[a][k] + nodes_[b][k] + nodes_[c][k]) / 3;
    middles.push_back(middle);
    double radius = 0;
    for (const int corner : {a, b, c}) radius = std::max(radius, norm(minus(nodes_[corner], middle)));
    radii.push_back(radius);
  }
  triangle_tree_ = BallTree(middles, radii);
  make_samples(gap);
  make_map();
}

// Let all corners of a triangle, whose sides are at most L, be farther than t from another surface, and m be its
// smallest distance. The distance d to any set has second derivatives of at most 1/d, so d - x^2/2m is concave on the
// triangle, and m lies at most R^2/2m below t, where R = L / sqrt(3) is at least the radius of the smallest circle
// around the triangle.
// With t = g + R^2/2g, m is at least g if R < g; and t - R always, for a point is at most R from a corner.
void RigidSurface::make_samples(double gap) {
  samples_ = nodes_;
  auto triangles = triangles_;
  for (;;) {
    double square = 0;
    for (const auto& [a, b, c] : triangles) {
      for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
        const Place<3> side = minus(samples_[to], samples_[from]);
        square = std::max(square, dot(side, side));
      }
    }
    const double circle = std::sqrt(square / 3);
    const double below = circle < gap ? circle * circle / (2 * gap) : circle;
    // Nodes and orientations of both bodies are rounded.
    allowance_ = rounded(below + 8 * std::ldexp(1 + radius_, -24));
    if (below < 0.2 * gap || 4 * samples_.size() > most_samples) break;
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(samples_.size()));
      if (is_new) {
        Place<3> place;
        for (int k = 0; k < 3; ++k) place[k] = 0.5 * (samples_[a][k] + samples_[b][k]);
        samples_.push_back(place);
      }
      return found->second;
    };
    std::vector<std::array<int, 3>> parts;
    for (const auto& [a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      parts.insert(parts.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(parts);
  }
  sample_tree_ = BallTree(samples_, std::vector<double>(samples_.size(), 0.0));
}

void RigidSurface::make_map() {
  step_ = radius_ / map_steps;
  half_diagonal_ = 0.867 * step_;
  least_ = most_ = nodes_.front();
  for (const Place<3>& node : nodes_) {
    for (int k = 0; k < 3; ++k) {
      least_[k] = std::min(least_[k], node[k]);
      most_[k] = std::max(most_[k], node[k]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    lower_[k] = least_[k] - 0.25 * radius_;
    count_[k] = static_cast<int>(std::ceil((most_[k] + 0.25 * radius_ - lower_[k]) / step_));
  }
  const auto point = [&](int i, int j, int k) -> Place<3> {
    return {lower_[0] + (i + 0.5) * step_, lower_[1] + (j + 0.5) * step_, lower_[2] + (k + 0.5) * step_};
  };
  Place<3> last = point(0, 0, 0);
  double found = 4 * radius_;
  for (int k = 0; k < count_[2]; ++k) {
    for (int j = 0; j < count_[1]; ++j) {
      for (int i = 0; i < count_[0]; ++i) {
        const Place<3> here = point(i, j, k);
        found = distance(here, 1.001 * (found + norm(minus(here, last))));
        last = here;
        map_.push_back(static_cast<float>(found));
      }
    }
  }
  // Outside is what can be reached from a corner of the map: no surface lies between two points whose balls meet.
  std::vector<bool> outside(map_.size(), false);
  std::vector<std::size_t> border{0};
  outside[0] = true;
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(count_[0]),
                                          static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1])};
  while (!border.empty()) {
    const std::size_t here = border.back();
    border.pop_back();
    for (int k = 0; k < 3; ++k) {
      const int place = static_cast<int>(here / stride[k]) % count_[k];
      for (const int way : {-1, 1}) {
        if (place + way < 0 || place + way >= count_[k]) continue;
        const std::size_t next = way > 0 ? here + stride[k] : here - stride[k];
        if (outside[next] || static_cast<double>(map_[here]) + static_cast<double>(map_[next]) <= 1.001 * step_)
          continue;
        outside[next] = true;
        border.push_back(next);
      }
    }
  }
  for (std::size_t i = 0; i < map_.size(); ++i)
    if (!outside[i]) map_[i] = -map_[i];
}

double RigidSurface::distance(const Place<3>& point, double at_most) const {
  double square = at_most * at_most;
  triangle_tree_.all(
      [&](const Place<3>& center, double radius) {
        const Place<3> between = minus(point, center);
        const double apart = dot(between, between), reach = std::sqrt(square) + radius;
        return apart >= reach * reach;
      },
      [&](int item) {
        const auto& [a, b, c] = triangles_[item];
        square = std::min(square, square_distance(point, nodes_[a], nodes_[b], nodes_[c]));
        return true;
      });
  return std::sqrt(square);
}

const float* RigidSurface::mapped(const Place<3>& point) const {
  std::size_t place = 0;
  for (int k = 2; k >= 0; --k) {
    const double steps = (point[k] - lower_[k]) / step_;
    if (!(steps >= 0 && steps < count_[k])) return nullptr;
    place = place * static_cast<std::size_t>(count_[k]) + static_cast<std::size_t>(steps);
  }
  return &map_[place];
}

bool RigidSurface::surely_keeps(const Place<3>& point, double least) const {
  // From the box that holds the surface.
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double beyond = std::max({least_[k] - point[k], point[k] - most_[k], 0.0});
    square += beyond * beyond;
  }
  if (square >= least * least) return true;
  const float* const middle = mapped(point);
  return middle != nullptr && static_cast<double>(*middle) - 1.0001 * half_diagonal_ >= least;
}

bool RigidSurface::keeps(const Place<3>& point, double least) const {
  if (surely_keeps(point, least)) return true;
  const float* const middle = mapped(point);
  if (middle == nullptr) return distance(point, 4 * radius_) >= least;
  if (static_cast<double>(*middle) + 1.0001 * half_diagonal_ < least) return false;
  const double found = distance(point, std::abs(static_cast<double>(*middle)) + 1.001 * half_diagonal_);
  // Farther than that from the surface, the point lies on the same side as the cube's middle.
  return found >= least && found > half_diagonal_ && *middle > 0;
}

bool encloses(const RigidBody<RigidSurface>& body, const Place<3>& point) {
  constexpr double outside = 1e-9;  // 0 would be kept inside, too
  Place<3> seen = back(body.orientation, point);
  for (double& component : seen) component /= body.scale;
  return !body.solid->keeps(seen, outside);
}

bool keep_apart(const RigidBody<RigidSurface>& a, const RigidBody<RigidSurface>& b, const Place<3>& shift, double gap) {
  const Place<3> between = minus(minus(a.center, b.center), shift);
  const double reach = a.radius() + b.radius() + gap;
  if (dot(between, between) >= reach * reach) return true;
  // Columns of the matrix that turns a as seen from b, with the ratio of their sizes.
  const double ratio = a.scale / b.scale;
  std::array<Place<3>, 3> rows;
  for (int k = 0; k < 3; ++k) {
    const auto& turn = a.orientation.rows;
    const Place<3> column = back(b.orientation, {turn[0][k], turn[1][k], turn[2][k]});
    for (int i = 0; i < 3; ++i) rows[i][k] = ratio * column[i];
  }
  Place<3> offset = back(b.orientation, between);
  for (double& component : offset) component /= b.scale;
  const double least = gap / b.scale;
  const auto seen = [&](const Place<3>& p) -> Place<3> {
    return {offset[0] + dot(rows[0], p), offset[1] + dot(rows[1], p), offset[2] + dot(rows[2], p)};
  };
  // b may lie in a: one of its nodes then does.
  Place<3> node = rotated(b.orientation, b.solid->nodes().front());
  for (int k = 0; k < 3; ++k) node[k] = b.scale * node[k] - between[k];
  node = back(a.orientation, node);
  for (double& component : node) component /= a.scale;
  if (!a.solid->keeps(node, gap / a.scale)) return false;
  return a.solid->sample_tree().all(
      [&](const Place<3>& center, double radius) {
        return b.solid->surely_keeps(seen(center), least + ratio * radius);
      },
      [&](int item) { return b.solid->keeps(seen(a.solid->samples()[item]), least); });
}

}  // namespace rouleau::shape
