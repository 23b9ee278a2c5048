#include "triangle_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace rouleau::core {

namespace {

struct Icosahedron {
  std::array<Vec<3>, 12> corner;
  std::array<std::array<int, 3>, 20> face;
};

Icosahedron icosahedron() {
  constexpr double g = std::numbers::phi;
  Icosahedron solid{{{{-1, g, 0},
                      {1, g, 0},
                      {-1, -g, 0},
                      {1, -g, 0},
                      {0, -1, g},
                      {0, 1, g},
                      {0, -1, -g},
                      {0, 1, -g},
                      {g, 0, -1},
                      {g, 0, 1},
                      {-g, 0, -1},
                      {-g, 0, 1}}},
                    {{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}}};
  for (Vec<3>& corner : solid.corner) corner.normalize();
  return solid;
}

/// A curve from an axis to that axis, 0: x, 1: y, by its parameter from 0 to pi, turned about it. Nodes lie at equal
/// distances along meridians.
template <class Curve>
TriangleSurface turned(int axis, int n, double scale_of_all, const Curve& point) {
  constexpr int steps = 4096;
  // Length along the profile from the axis, at equal steps of the parameter.
  std::vector<double> length(steps + 1);
  for (int k = 1; k <= steps; ++k) {
    const auto [x0, y0] = point(std::numbers::pi * (k - 1) / steps);
    const auto [x1, y1] = point(std::numbers::pi * k / steps);
    length[k] = length[k - 1] + std::hypot(x1 - x0, y1 - y0);
  }
  TriangleSurface made = unit_sphere(n);
  for (Vec<3>& node : made.nodes) {
    const double from_axis = std::hypot(node[1 - axis], node.z());
    const double wanted = std::atan2(from_axis, node[axis]) / std::numbers::pi * length[steps];
    const auto above =
        std::clamp<std::ptrdiff_t>(std::upper_bound(length.begin(), length.end(), wanted) - length.begin(), 1, steps);
    const double share = (wanted - length[above - 1]) / (length[above] - length[above - 1]);
    const auto [r, y] = point(std::numbers::pi * (static_cast<double>(above - 1) + share) / steps);
    const double scale = from_axis > 0 ? r / from_axis : 0;
    node *= scale;
    node[axis] = y;
    node *= scale_of_all;
  }
  return made;
}

}  // namespace

CurvePoint biconcave_curve(double radius, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), c2 = c * c;
  const double thickness = 0.207 + c2 * (2.002 - 1.122 * c2);
  const double change = c * (2 * 2.002 - 4 * 1.122 * c2);  // d thickness / d c
  return {{radius * c, 0.5 * radius * s * thickness}, {-radius * s, 0.5 * radius * (c * thickness - s * s * change)}};
}

TriangleSurface unit_sphere(int n) {
  static const Icosahedron solid = icosahedron();
  const double step = std::acos(solid.corner[0].dot(solid.corner[1])) / n;
  TriangleSurface sphere;
  std::map<std::array<std::pair<int, int>, 3>, int> known;  // nodes of faces that meet, by corners and their shares
  const auto node = [&](const std::array<int, 3>& face, const std::array<int, 3>& shares) {
    std::array<std::pair<int, int>, 3> key;
    for (int k = 0; k < 3; ++k) key[k] = shares[k] == 0 ? std::pair{-1, 0} : std::pair{face[k], shares[k]};
    std::sort(key.begin(), key.end());
    const auto [found, is_new] = known.try_emplace(key, static_cast<int>(sphere.nodes.size()));
    if (is_new) {
      // On an edge this divides the arc evenly, and all three corners of a face are alike.
      Vec<3> place = Vec<3>::Zero();
      for (const auto& [corner, share] : key)
        if (share > 0) place += std::sin(share * step) * solid.corner[corner];
      sphere.nodes.push_back(place.normalized());
    }
    return found->second;
  };
  for (const auto& face : solid.face) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        const int rest = n - i - j;
        const auto at = [&](int a, int b) { return node(face, {rest - a - b, i + a, j + b}); };
        sphere.triangles.push_back({at(0, 0), at(1, 0), at(0, 1)});
        if (rest > 1) sphere.triangles.push_back({at(1, 0), at(1, 1), at(0, 1)});
      }
    }
  }
  return sphere;
}

TriangleSurface ellipsoid(int n, const Vec<3>& semi_axes) {
  TriangleSurface made = unit_sphere(n);
  for (Vec<3>& node : made.nodes) node = node.cwiseProduct(semi_axes);
  return made;
}

double SurfaceContent::reduced_volume() const { return 6 * std::sqrt(std::numbers::pi) * volume / std::pow(area, 1.5); }

SurfaceContent content_of(const TriangleSurface& surface) {
  SurfaceContent sum{0, 0};
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec<3>&a = surface.nodes[i], &b = surface.nodes[j], &c = surface.nodes[k];
    sum.area += (b - a).cross(c - a).norm() / 2;
    sum.volume += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

Vec<3> spheroid_axes(const SurfaceContent& content, bool prolate) {
  // By the axis of symmetry over the others, which are 1.
  const auto spheroid = [](double axis) -> SurfaceContent {
    const double volume = 4 * std::numbers::pi / 3 * axis;
    if (axis == 1) return {4 * std::numbers::pi, volume};
    const double e = std::sqrt(axis < 1 ? 1 - axis * axis : 1 - 1 / (axis * axis));
    const double shape = axis < 1 ? (1 - e * e) / e * std::atanh(e) : axis / e * std::asin(e);
    return {2 * std::numbers::pi * (1 + shape), volume};
  };
  constexpr int halvings = 200;
  double flat = std::log(1e-6), round = 0;  // logarithms of the axis, of a prolate one turned over
  for (int i = 0; i < halvings; ++i) {
    const double middle = (flat + round) / 2;
    const bool too_flat = spheroid(std::exp(prolate ? -middle : middle)).reduced_volume() < content.reduced_volume();
    (too_flat ? flat : round) = middle;
  }
  const double axis = std::exp(prolate ? -round : round), across = std::sqrt(content.area / spheroid(axis).area);
  return prolate ? Vec<3>(axis * across, across, across) : Vec<3>(across, axis * across, across);
}

TriangleSurface biconcave_disc(int n, double radius) {
  return turned(1, n, radius, [](double from_pole) -> std::pair<double, double> {
    const Eigen::Vector2d place = biconcave_curve(1, std::numbers::pi / 2 - from_pole).place;
    return {place.x(), place.y()};
  });
}

TriangleSurface even_spheroid(int n, const Vec<3>& semi_axes) {
  const int axis = semi_axes.y() == semi_axes.z() ? 0 : 1;
  return turned(axis, n, semi_axes.z(), [&](double from_pole) -> std::pair<double, double> {
    return {std::sin(from_pole), semi_axes[axis] / semi_axes.z() * std::cos(from_pole)};
  });
}

RestSurface rest_surface(const TriangleSurface& surface, double prestretch) {
  std::vector<double> x, y, z;
  for (const Vec<3>& node : surface.nodes) {
    x.push_back(node.x());
    y.push_back(node.y());
    z.push_back(node.z());
  }
  return make_rest_surface(Mesh(static_cast<int>(surface.nodes.size()), surface.triangles), std::move(x), std::move(y),
                           std::move(z), prestretch);
}

}  // namespace rouleau::core
