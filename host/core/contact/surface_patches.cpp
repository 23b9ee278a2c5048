#include "surface_patches.hpp"

#include <algorithm>
#include <cmath>

#include "triangle_contacts.hpp"

namespace rouleau::core {

namespace {

/// Whether boxes so far apart may hold points this near, but for rounding. Not where one is no number.
bool may_hold(double box_square, double square) { return box_square <= square * (1 + 1e-9) + 1e-9; }

}  // namespace

const SurfacePatches::Patches& SurfacePatches::of(int cell) {
  Patches& patches = cells_[cell];
  if (!patches.nodes.empty()) return patches;
  const Nodes nodes = surfaces_.nodes(cell);
  for (int i = 0; i < surfaces_.cells[cell].count; ++i) {
    if (i % size == 0) patches.nodes.emplace_back();
    patches.nodes.back().extend(nodes[i]);
  }
  int triangle = 0;
  for (const auto& corners : surfaces_.type_of(cell).mesh.triangles()) {
    if (triangle++ % size == 0) patches.triangles.emplace_back();
    for (const int corner : corners) patches.triangles.back().extend(nodes[corner]);
  }
  return patches;
}

std::optional<SurfacePatches::Point> SurfacePatches::closest(const Vec<3>& place, int cell, double most) {
  const Patches& patches = of(cell);
  const auto& triangles = surfaces_.type_of(cell).mesh.triangles();
  const int first = surfaces_.cells[cell].first, count = static_cast<int>(triangles.size());
  Point best{most * most, std::numeric_limits<int>::max(), {}, Vec<3>::Zero()};
  near_.clear();
  for (int t = 0; t < static_cast<int>(patches.triangles.size()); ++t) {
    const double square = patches.triangles[t].squaredExteriorDistance(place);
    if (may_hold(square, best.square)) near_.push_back({square, 0, t});
  }
  std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) { return a.square < b.square; });
  points_.resize(size);
  for (const Near& patch : near_) {
    if (!may_hold(patch.square, best.square)) break;
    const int begin = patch.triangles * size, some = std::min(size, count - begin);
    for (int k = 0; k < some; ++k)
      for (int c = 0; c < 3; ++c)
        points_.corner[c][k] = first + triangles[begin + k][c], points_.place[c][k] = place[c];
    points_.find(some, surfaces_.positions());
    for (int k = 0; k < some; ++k) {
      const double square = points_.square[k];
      if (!(square < best.square || (square == best.square && begin + k < best.triangle))) continue;
      best.square = square, best.triangle = begin + k;
      for (int c = 0; c < 3; ++c) best.weight[c] = points_.weight[c][k], best.away[c] = points_.away[c][k];
    }
  }
  if (best.triangle == std::numeric_limits<int>::max()) return std::nullopt;
  return best;
}

double SurfacePatches::gap(int cell, std::span<const int> others, const std::vector<BoundingBox<3>>& boxes,
                           double most) {
  struct Image {
    double square;  // of the boxes' distance
    int other;
    Vec<3> moved, moved_back;
  };
  std::vector<Image> images;
  const auto box = [&](int c) { return Box(Vec<3>(boxes[c].least.data()), Vec<3>(boxes[c].most.data())); };
  for (const int other : others) {
    if (!surfaces_.knows(other)) continue;
    for_each_image(boxes[cell], boxes[other], most + 1e-6, domain_, [&](ImageShift shift) {
      if (other == cell && shift == ImageShift{}) return;
      const Vec<3> moved = moved_by(shift, domain_);
      images.push_back({box(cell).squaredExteriorDistance(box(other).translated(moved)), other, moved, -moved});
    });
  }
  std::sort(images.begin(), images.end(), [](const Image& a, const Image& b) { return a.square < b.square; });
  // Whether anything lies within `most`: a distance of just that counts.
  double square = std::nextafter(most * most, std::numeric_limits<double>::infinity());
  const double none = square;
  for (const Image& image : images) {
    if (!may_hold(image.square, square)) break;
    lower(square, cell, image.other, image.moved);
    lower(square, image.other, cell, image.moved_back);
  }
  return square < none ? std::max(std::sqrt(square), least_distance) : std::numeric_limits<double>::infinity();
}

void SurfacePatches::lower(double& square, int from, int to, const Vec<3>& moved) {
  const Patches &nodes = of(from), &triangles = of(to);
  // The nearest pair of patches first: then few others are left.
  const auto visit = [&](auto function) {
    for (int n = 0; n < static_cast<int>(nodes.nodes.size()); ++n) {
      const Box box = nodes.nodes[n].translated(-moved);
      for (int t = 0; t < static_cast<int>(triangles.triangles.size()); ++t)
        function(Near{box.squaredExteriorDistance(triangles.triangles[t]), n, t});
    }
  };
  Near nearest{std::numeric_limits<double>::infinity(), 0, 0};
  visit([&](const Near& pair) { nearest = pair.square < nearest.square ? pair : nearest; });
  if (!may_hold(nearest.square, square)) return;
  look(square, from, nearest.nodes, to, nearest.triangles, moved);
  near_.clear();
  visit([&](const Near& pair) {
    if (may_hold(pair.square, square)) near_.push_back(pair);
  });
  std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) { return a.square < b.square; });
  for (const Near& pair : near_) {
    if (!may_hold(pair.square, square)) break;
    look(square, from, pair.nodes, to, pair.triangles, moved);
  }
}

void SurfacePatches::look(double& square, int from, int nodes, int to, int patch, const Vec<3>& moved) {
  const auto& triangles = surfaces_.type_of(to).mesh.triangles();
  const int begin = patch * size, end = std::min(begin + size, static_cast<int>(triangles.size()));
  const int first_node = nodes * size, end_node = std::min(first_node + size, surfaces_.cells[from].count);
  const Nodes places = surfaces_.nodes(from);
  const int first = surfaces_.cells[to].first;
  points_.resize(size * size);
  int count = 0;
  for (int i = first_node; i < end_node; ++i) {
    const Vec<3> place = places[i] - moved;
    if (!may_hold(cells_[to].triangles[patch].squaredExteriorDistance(place), square)) continue;
    for (int t = begin; t < end; ++t, ++count)
      for (int c = 0; c < 3; ++c)
        points_.corner[c][count] = first + triangles[t][c], points_.place[c][count] = place[c];
  }
  points_.find(count, surfaces_.positions());
  for (int k = 0; k < count; ++k) square = points_.square[k] < square ? points_.square[k] : square;
}

}  // namespace rouleau::core
