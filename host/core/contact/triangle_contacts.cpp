#include "triangle_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "cell_grid.hpp"

namespace rouleau::core {

namespace {

constexpr double slack = 1e-9;        // rounding
constexpr std::size_t in_cache = 64;  // so many groups are searched at a time

/// A number of single precision that is not larger, of one that is not negative.
float rounded_down(double value) { return static_cast<float>(value * (1 - 0x1p-23)); }

}  // namespace

TriangleContacts::TriangleContacts(const Surfaces& surfaces, Cutoffs cutoffs, const Domain<3>& domain,
                                   const std::vector<double>& self_cutoffs)
    : cutoffs_(std::move(cutoffs)),
      domain_(domain),
      watch_(surfaces),
      path_(surfaces.cells.size(), 0.0),
      renewed_(surfaces.cells.size(), 0),
      lists_(surfaces.cells.size()) {
  for (std::size_t t = 0; t < self_cutoffs.size(); ++t) {
    self_reach_.push_back(self_cutoffs[t] > 0 ? std::make_unique<const SelfReach>(*surfaces.types[t], self_cutoffs[t])
                                              : nullptr);
  }
}

/// Of a cell from another's image, or within it.
double TriangleContacts::cutoff(const Surfaces& surfaces, int cell, int other, bool within) const {
  const int type = surfaces.cells[cell].type;
  if (!within) return cutoffs_(type, surfaces.cells[other].type);
  return !self_reach_.empty() && self_reach_[type] ? self_reach_[type]->cutoff() : 0;
}

TriangleContacts TriangleContacts::within(double reach, const Surfaces& surfaces, const Domain<3>& domain) {
  const int types = static_cast<int>(surfaces.types.size());
  Cutoffs cutoffs(types);
  for (int a = 0; a < types; ++a)
    for (int b = 0; b <= a; ++b) cutoffs.raise(a, b, reach);
  TriangleContacts contacts(surfaces, std::move(cutoffs), domain);
  contacts.of_all_ = true;
  contacts.measure({}, surfaces);
  contacts.refresh({}, surfaces);
  return contacts;
}

void TriangleContacts::measure(Worker worker, const Surfaces& surfaces) {
  watch_.measure(worker, surfaces);
  const CellNumbers cells = surfaces.known_cells(worker);
  for (const int cell : cells) {
    if (renewed_[cell] != 0) path_[cell] = 0;
    path_[cell] +=
        surfaces.largest_step.empty() ? std::numeric_limits<double>::infinity() : surfaces.largest_step[cell];
  }
}

/// By how much two cells may have come nearer to each other since their distances were measured. While lists are made
/// anew others' paths say nothing: those workers may be ahead or behind.
double TriangleContacts::travelled(int cell, int other) const {
  if (renewed_[cell] != 0) return 0;
  const double path = path_[cell] + path_[other];
  if (std::isfinite(path)) return path;
  const std::vector<double>& moved = watch_.memory().bound;
  return moved[cell] + moved[other];
}

void TriangleContacts::refresh(Worker worker, const Surfaces& surfaces) {
  const bool renew = watch_.exceeded();
  const CellNumbers cells = surfaces.known_cells(worker);
  for (const int cell : cells) renewed_[cell] = renew;
  if (!renew) return;
  const double skin = of_all_ ? 1e-6 : suitable_skin(surfaces);  // who looks at all looks once
  // Every worker sorts all cells: that is quicker than to wait for one who does.
  const std::vector<BoundingBox<3>> boxes = boxes_of_known<3>(surfaces);
  const CellGrid<3> grid(boxes, cutoffs_.largest() + 2 * skin, domain_);
  std::vector<int> near;
  for (const int cell : cells) {
    lists_[cell] = {};
    if (of_all_ || surfaces.owns(cell)) {
      grid.find(cell, near);
      list_candidates(cell, surfaces, near, boxes, skin);
    }
    watch_.remember(cell, surfaces, skin);
  }
  if (worker.first()) ++renewals_;
}

void TriangleContacts::forget(const Surfaces& surfaces, std::span<const Range> nodes) {
  watch_.forget(surfaces, nodes);
  surfaces.forget_unknown_of(lists_);
}

void TriangleContacts::list_candidates(int cell, const Surfaces& surfaces, const std::vector<int>& near,
                                       const std::vector<BoundingBox<3>>& boxes, double skin) {
  CandidateList& list = lists_[cell];
  const CellRange& own = surfaces.cells[cell];
  const auto place_of = [&](int node) { return vector_at<3>(surfaces.position, node); };
  NearTriangles triangles;
  for (const int other : near) {
    const double reach = cutoff(surfaces, cell, other, false) + 2 * skin + slack;
    for_each_image(boxes[cell], boxes[other], reach, domain_, [&](ImageShift shift) {
      const bool within = other == cell && shift == ImageShift{};
      const double most = cutoff(surfaces, cell, other, within);
      if (most > 0) triangles.add(boxes[cell], {other, shift, within}, most + 2 * skin, surfaces, domain_);
    });
  }
  triangles.sort_images();
  for (const NearTriangles::Image& image : triangles.images())
    list.images.push_back({image.other, image.shift, image.within, 0, nullptr, moved_by(image.shift, domain_), 0, 0});
  std::vector<Candidate>& fresh = list.fresh;
  for (int node = own.first; node < own.end(); ++node) {
    // Nodes that follow each other lie side by side in most meshes.
    constexpr int together = 16;
    if ((node - own.first) % together == 0) {
      Eigen::AlignedBox3d box;
      for (int i = node; i < std::min(node + together, own.end()); ++i) box.extend(place_of(i));
      triangles.choose(box);
    }
    const Vec<3> place = place_of(node);
    for (std::size_t i = 0; i < triangles.images().size(); ++i) {
      const NearTriangles::Image& image = triangles.images()[i];
      if (image.near.empty()) continue;
      fresh.clear();
      const bool within = list.images[i].within;
      // A triangle's middle is no nearer than the triangle, and farther away by its radius at most.
      double nearest = std::numeric_limits<double>::infinity();
      triangles.for_near(place, image, [&](const NearTriangles::Triangle& triangle, double distance) {
        if (within && !self_reach_[own.type]->allows(node - own.first, triangle.triangle)) return;
        nearest = std::min(nearest, distance);
        fresh.push_back({rounded_down(std::max(0.0, distance - triangle.radius)), triangle.triangle});
      });
      // Others stay farther away than the nearest one.
      std::erase_if(fresh, [&](const Candidate& candidate) { return candidate.distance > nearest + 4 * skin; });
      if (fresh.empty()) continue;
      std::sort(fresh.begin(), fresh.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.distance, a.triangle) < std::tie(b.distance, b.triangle);
      });
      Group group{node, static_cast<int>(i), fresh.front().distance, {}, 0, 0};
      const auto count = static_cast<int>(fresh.size());
      for (int k = 0; k < at_once; ++k) group.first[k] = fresh[std::min(k, count - 1)];
      group.begin = static_cast<int>(list.candidates.size());
      if (count > at_once) list.candidates.insert(list.candidates.end(), fresh.begin() + at_once, fresh.end());
      group.end = static_cast<int>(list.candidates.size());
      list.groups.push_back(group);
    }
  }
}

std::span<TriangleContacts::Candidate> TriangleContacts::CandidateList::next(const Search& search) {
  Group& group = groups[search.group];
  if (search.looked < 0) return group.first;
  const int from = group.begin + search.looked;
  return std::span(candidates).subspan(from, std::min(at_once, group.end - from));
}

/// Those that have been looked at have new distances: the nearest of them are the first, the others are sorted again.
void TriangleContacts::sort_in(CandidateList& list, const Search& search) {
  Group& group = list.groups[search.group];
  if (search.looked > 0) {
    Candidate* const others = list.candidates.data() + group.begin;
    const int all = group.end - group.begin;
    std::vector<Candidate>& fresh = list.fresh;
    fresh.assign(group.first.begin(), group.first.end());
    fresh.insert(fresh.end(), others, others + search.looked);
    const auto nearer = [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; };
    std::sort(fresh.begin(), fresh.end(), nearer);
    std::copy_n(fresh.begin(), at_once, group.first.begin());
    int at = 0, old = search.looked;
    for (auto next = fresh.begin() + at_once; next != fresh.end(); ++next) {
      while (old < all && nearer(others[old], *next)) others[at++] = others[old++];
      others[at++] = *next;
    }
  }
  group.nearest = list.nearest_from(group, 0);
  for (const Candidate& candidate : group.first) group.nearest = std::min(group.nearest, candidate.distance);
}

/// Of all groups that are being searched: their next candidates.
void TriangleContacts::look_at_next(const Surfaces& surfaces, CandidateList& list) const {
  const auto count = static_cast<int>(list.searching.size());
  ClosestPoints& points = list.points;
  points.resize(count * at_once);
  for (int s = 0; s < count; ++s) {
    const Search& search = list.searches[list.searching[s]];
    const Group& group = list.groups[search.group];
    const Image& image = list.images[group.image];
    const auto candidates = list.next(search);
    const Vec<3> place = vector_at<3>(surfaces.position, group.node) - image.moved;
    const int last = static_cast<int>(candidates.size()) - 1;
    for (int k = 0; k < at_once; ++k) {
      const std::array<int, 3>& corners = image.triangles[candidates[std::min(k, last)].triangle];
      const int at = s * at_once + k;
      for (int c = 0; c < 3; ++c) points.corner[c][at] = image.first_node + corners[c], points.place[c][at] = place[c];
    }
  }
  points.find(count * at_once, surfaces.positions());
  const bool remembers = !surfaces.largest_step.empty();
  int left = 0;
  for (int s = 0; s < count; ++s) {
    const int number = list.searching[s];
    Search& search = list.searches[number];
    const Group& group = list.groups[search.group];
    const double path = list.images[group.image].path;
    const auto candidates = list.next(search);
    int closest = -1;
    for (int k = 0; k < static_cast<int>(candidates.size()); ++k) {
      const double square = points.square[s * at_once + k];
      const int triangle = candidates[k].triangle;
      const double bound = std::sqrt(square) + path;
      if (remembers) candidates[k].distance = bound >= 0 ? rounded_down(bound) : 0;  // places may be no numbers
      // Of triangles equally far away the first counts, in whatever order they are listed.
      const bool closer = square < search.square || (square == search.square && triangle < search.closest);
      closest = closer ? s * at_once + k : closest;
      search.square = closer ? square : search.square;
      search.closest = closer ? triangle : search.closest;
    }
    if (closest >= 0)
      for (int c = 0; c < 3; ++c)
        search.weight[c] = points.weight[c][closest], search.away[c] = points.away[c][closest];
    search.looked = search.looked < 0 ? 0 : search.looked + static_cast<int>(candidates.size());
    list.searching[left] = number;
    left += list.nearest_from(group, search.looked) - path - slack > std::sqrt(search.square) ? 0 : 1;
  }
  list.searching.resize(left);
}

void TriangleContacts::find(int cell, const Surfaces& surfaces, std::vector<TriangleContact>& contacts) const {
  contacts.clear();
  CandidateList& list = lists_[cell];
  for (Image& image : list.images) {
    image.first_node = surfaces.cells[image.other].first;
    image.triangles = surfaces.type_of(image.other).mesh.triangles().data();
    image.cutoff = cutoff(surfaces, cell, image.other, image.within);
    image.path = travelled(cell, image.other);
  }
  const auto count = static_cast<int>(list.groups.size());
  for (int g = 0; g < count;) {
    list.searches.clear();
    list.searching.clear();
    for (; g < count && list.searches.size() < in_cache; ++g) {
      const Group& group = list.groups[g];
      const Image& image = list.images[group.image];
      if (group.nearest - image.path - slack > image.cutoff) continue;
      for (const Candidate& candidate : group.first) __builtin_prefetch(&image.triangles[candidate.triangle]);
      __builtin_prefetch(list.candidates.data() + group.begin, 1);
      list.searching.push_back(static_cast<int>(list.searches.size()));
      list.searches.push_back({g, -1, none, image.cutoff * image.cutoff, {}, Vec<3>::Zero()});
    }
    while (!list.searching.empty()) look_at_next(surfaces, list);
    for (const Search& search : list.searches) {
      if (!surfaces.largest_step.empty()) sort_in(list, search);
      if (search.closest != none) contacts.push_back(contact(search, list, surfaces));
    }
  }
}

TriangleContact TriangleContacts::contact(const Search& search, const CandidateList& list, const Surfaces& surfaces) {
  const Group& group = list.groups[search.group];
  const Image& image = list.images[group.image];
  const auto& [i, j, k] = image.triangles[search.closest];
  const double root = std::sqrt(search.square);
  TriangleContact contact{group.node,
                          image.other,
                          image.shift,
                          image.within,
                          {image.first_node + i, image.first_node + j, image.first_node + k},
                          search.weight,
                          std::max(root, least_distance),
                          {}};
  if (root > least_distance) {
    contact.direction = search.away / root;
  } else {
    const Nodes nodes = surfaces.nodes(image.other);
    contact.direction = (nodes[j] - nodes[i]).cross(nodes[k] - nodes[i]).normalized();
  }
  return contact;
}

}  // namespace rouleau::core
