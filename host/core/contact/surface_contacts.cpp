#include "surface_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace rouleau::core {

namespace {

constexpr double slack = 1e-9;        // rounding
constexpr std::size_t in_cache = 64;  // so many groups are searched at a time

/// By so much an image lies beside the cell itself.
Vec<3> moved_by(const std::array<int, 3>& shift, const Domain<3>& domain) {
  Vec<3> move = Vec<3>::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (domain.periodic[axis]) move[axis] = shift[axis] * domain.period(axis);
  return move;
}
/// A number of single precision that is not larger, of one that is not negative.
float rounded_down(double value) { return static_cast<float>(value * (1 - 0x1p-23)); }
bool usable(const Vec<3>& place) { return place.cwiseAbs().maxCoeff() < 1e9; }  // false where one is no number

}  // namespace

/// All triangles, sorted by the place of their middles in the periodic box.
class SurfaceContacts::Bins {
 public:
  struct Entry {
    Vec<3> middle;
    double radius;  ///< no corner lies farther from the middle
    int cell, triangle;
  };

  /// `reach`: within which triangles are looked for.
  Bins(const Surfaces& surfaces, double reach, const Domain<3>& domain) : domain_(domain) {
    double largest = 0;
    std::vector<Entry> entries;
    for (const int cell : surfaces.known_cells()) {
      const Nodes nodes = surfaces.nodes(cell);
      int triangle = 0;
      for (const auto& [i, j, k] : surfaces.type_of(cell).mesh.triangles()) {
        const Vec<3> a = nodes[i], b = nodes[j], c = nodes[k], middle = (a + b + c) / 3;
        const double square =
            std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()});
        if (usable(middle)) {
          entries.push_back({middle, std::sqrt(square), cell, triangle});
          largest = std::max(largest, entries.back().radius);
        }
        ++triangle;
      }
    }
    reach_ = reach + largest;
    // No more bins than about eight times the triangles.
    const int most = 1 + static_cast<int>(2 * std::cbrt(static_cast<double>(entries.size())));
    for (int axis = 0; axis < 3; ++axis) {
      const double length = domain.size[axis];
      count_[axis] = std::clamp(static_cast<int>(length / std::max(1.0, reach_ / 2)), 1, most);
      width_[axis] = length / count_[axis];
    }
    std::vector<int> bin(entries.size());
    begin_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    for (std::size_t e = 0; e < entries.size(); ++e) {
      bin[e] =
          bin_of({along(0, entries[e].middle.x()), along(1, entries[e].middle.y()), along(2, entries[e].middle.z())});
      ++begin_[bin[e] + 1];
    }
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    entries_.resize(entries.size());
    for (std::size_t e = 0; e < entries.size(); ++e) entries_[next[bin[e]]++] = entries[e];
  }

  /// Calls function(entry) for the triangles that may lie within the reach of a box, once for each, in some order.
  template <class Function>
  void for_near(const Eigen::AlignedBox3d& box, Function function) const {
    int first[3], last[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto bin = [&](double place) { return static_cast<int>(std::floor((place + 0.5) / width_[axis])); };
      first[axis] = bin(box.min()[axis] - reach_), last[axis] = bin(box.max()[axis] + reach_);
      if (domain_.periodic[axis]) {
        last[axis] = std::min(last[axis], first[axis] + count_[axis] - 1);  // no bin twice
      } else {
        first[axis] = std::clamp(first[axis], 0, count_[axis] - 1),
        last[axis] = std::clamp(last[axis], 0, count_[axis] - 1);
      }
    }
    for (int z = first[2]; z <= last[2]; ++z) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int x = first[0]; x <= last[0]; ++x) {
          const int bin = bin_of({wrapped(0, x), wrapped(1, y), wrapped(2, z)});
          for (int e = begin_[bin]; e < begin_[bin + 1]; ++e) function(entries_[e]);
        }
      }
    }
  }

 private:
  [[nodiscard]] int wrapped(int axis, int bin) const { return (bin % count_[axis] + count_[axis]) % count_[axis]; }
  /// The bin along an axis; of what lies beyond a wall that beside it.
  [[nodiscard]] int along(int axis, double place) const {
    const int bin = static_cast<int>(std::floor((place + 0.5) / width_[axis]));
    return domain_.periodic[axis] ? wrapped(axis, bin) : std::clamp(bin, 0, count_[axis] - 1);
  }
  [[nodiscard]] int bin_of(const std::array<int, 3>& bin) const {
    return (bin[2] * count_[1] + bin[1]) * count_[0] + bin[0];
  }

  const Domain<3>& domain_;
  double reach_ = 0;
  int count_[3];
  double width_[3];
  std::vector<int> begin_;  // of each bin: its first entry, and one more
  std::vector<Entry> entries_;
};

SurfaceContacts::SurfaceContacts(const Surfaces& surfaces, Cutoffs cutoffs, const Domain<3>& domain,
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
double SurfaceContacts::cutoff(const Surfaces& surfaces, int cell, int other, bool within) const {
  const int type = surfaces.cells[cell].type;
  if (!within) return cutoffs_(type, surfaces.cells[other].type);
  return !self_reach_.empty() && self_reach_[type] ? self_reach_[type]->cutoff() : 0;
}

SurfaceContacts SurfaceContacts::within(double reach, const Surfaces& surfaces, const Domain<3>& domain) {
  const int types = static_cast<int>(surfaces.types.size());
  Cutoffs cutoffs(types);
  for (int a = 0; a < types; ++a) {
    for (int b = 0; b <= a; ++b) cutoffs.raise(a, b, reach);
  }
  SurfaceContacts contacts(surfaces, std::move(cutoffs), domain);
  contacts.of_all_ = true;
  contacts.measure({}, surfaces);
  contacts.refresh({}, surfaces);
  return contacts;
}

void SurfaceContacts::measure(Worker worker, const Surfaces& surfaces) {
  watch_.measure(worker, surfaces);
  const CellNumbers cells = surfaces.known_cells(worker);
  for (const int cell : cells) {
    if (renewed_[cell] != 0) path_[cell] = 0;
    path_[cell] +=
        surfaces.largest_step.empty() ? std::numeric_limits<double>::infinity() : surfaces.largest_step[cell];
  }
}

/// By how much two cells may have come nearer to each other since their distances were measured. While lists are made anew
/// others' paths say nothing: those workers may be ahead or behind.
double SurfaceContacts::travelled(int cell, int other) const {
  if (renewed_[cell] != 0) return 0;
  const double path = path_[cell] + path_[other];
  if (std::isfinite(path)) return path;
  const std::vector<double>& moved = watch_.memory().bound;
  return moved[cell] + moved[other];
}

void SurfaceContacts::refresh(Worker worker, const Surfaces& surfaces) {
  const bool renew = watch_.exceeded();
  const CellNumbers cells = surfaces.known_cells(worker);
  for (const int cell : cells) renewed_[cell] = renew;
  if (!renew) return;
  const double skin = of_all_ ? 1e-6 : suitable_skin(surfaces);  // who looks at all looks once
  // Every worker sorts all triangles: that is quicker than to wait for one who does.
  double largest = cutoffs_.largest();
  for (const auto& own : self_reach_) largest = std::max(largest, own ? own->cutoff() : 0);
  const Bins bins(surfaces, largest + 2 * skin, domain_);
  for (const int cell : cells) {
    if (of_all_ || surfaces.owns(cell)) {
      list_candidates(cell, surfaces, bins, skin);
    } else {
      lists_[cell] = {};
    }
    watch_.remember(cell, surfaces, skin);
  }
  if (worker.first()) ++renewals_;
}

void SurfaceContacts::forget(const Surfaces& surfaces, std::span<const Range> nodes) {
  watch_.forget(surfaces, nodes);
  surfaces.forget_unknown_of(lists_);
}

/// Images of other cells' triangles, and a cell's own, that may lie within the reach of some node of the cell.
struct SurfaceContacts::Neighbours {
  struct Triangle {
    int other;
    std::array<int, 3> shift;
    int triangle;
    Vec<3> middle;  ///< of the image
    double radius;  ///< no corner lies farther from it
    double around;  ///< reach plus that
    [[nodiscard]] auto order() const { return std::tie(other, shift, triangle); }
  };
  /// Triangles, or patches of them, [begin, end), and a box that holds all places that one of them is near.
  struct Part {
    std::size_t begin, end;
    Eigen::AlignedBox3d reached;
    void include(const Triangle& triangle) {
      ++end;
      reached.extend(triangle.middle - Vec<3>::Constant(triangle.around));
      reached.extend(triangle.middle + Vec<3>::Constant(triangle.around));
    }
  };
  /// The patches of one image of a cell.
  struct Image {
    int other;
    std::array<int, 3> shift;
    Part part;
    std::vector<Part> near{};  ///< those of its patches that the chosen place is near
    /// Whether it is the cell's own surface.
    [[nodiscard]] bool within(int cell) const { return other == cell && shift == std::array<int, 3>{}; }
  };
  std::vector<Triangle> triangles;  // sorted
  std::vector<Part> patches;        // of triangles that follow each other, which lie side by side in most meshes
  std::vector<Image> images;

  Neighbours(int cell, const Eigen::AlignedBox3d& box, const Surfaces& surfaces, const Bins& bins,
             const SurfaceContacts& contacts, double skin) {
    const Domain<3>& domain = contacts.domain_;
    bins.for_near(box, [&](const Bins::Entry& entry) {
      if (const double within = contacts.cutoff(surfaces, cell, cell, true); entry.cell == cell && within > 0)
        triangles.push_back({cell, {}, entry.triangle, entry.middle, entry.radius, within + 2 * skin + entry.radius});
      const double cutoff = contacts.cutoff(surfaces, cell, entry.cell, false);
      if (!(cutoff > 0)) return;
      const double around = cutoff + 2 * skin + entry.radius;
      // All images that come so near: in a narrow box more than the nearest one.
      std::array<int, 3> first{}, last{};
      for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min()[axis] - around - entry.middle[axis],
                     high = box.max()[axis] + around - entry.middle[axis];
        if (domain.periodic[axis]) {
          first[axis] = static_cast<int>(std::ceil(low / domain.period(axis)));
          last[axis] = static_cast<int>(std::floor(high / domain.period(axis)));
        } else if (low > 0 || high < 0) {
          return;
        }
      }
      std::array<int, 3> shift{};
      for (shift[2] = first[2]; shift[2] <= last[2]; ++shift[2]) {
        for (shift[1] = first[1]; shift[1] <= last[1]; ++shift[1]) {
          for (shift[0] = first[0]; shift[0] <= last[0]; ++shift[0]) {
            if (entry.cell == cell && shift == std::array<int, 3>{}) continue;
            triangles.push_back(
                {entry.cell, shift, entry.triangle, entry.middle + moved_by(shift, domain), entry.radius, around});
          }
        }
      }
    });
    std::sort(triangles.begin(), triangles.end(), [](const auto& a, const auto& b) { return a.order() < b.order(); });
    constexpr std::size_t patch_size = 16;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Triangle& triangle = triangles[t];
      const bool begins =
          images.empty() || images.back().other != triangle.other || images.back().shift != triangle.shift;
      if (begins) images.push_back({triangle.other, triangle.shift, {patches.size(), patches.size(), {}}});
      Image& image = images.back();
      if (begins || patches.back().end - patches.back().begin == patch_size) {
        patches.push_back({t, t, {}});
        ++image.part.end;
      }
      patches.back().include(triangle);
      image.part.reached.extend(patches.back().reached);
    }
  }

  /// Chooses a place that for_near() is about.
  void choose(const Eigen::AlignedBox3d& box) {
    for (Image& image : images) {
      image.near.clear();
      if (!image.part.reached.intersects(box)) continue;
      for (std::size_t p = image.part.begin; p < image.part.end; ++p) {
        if (patches[p].reached.intersects(box)) image.near.push_back(patches[p]);
      }
    }
  }
  /// Calls function(triangle, distance) for an image's triangles that are near a place in the chosen box; `distance`: of
  /// their middles.
  template <class Function>
  void for_near(const Vec<3>& place, const Image& image, Function function) const {
    for (const Part& patch : image.near) {
      if (!patch.reached.contains(place)) continue;
      for (std::size_t t = patch.begin; t < patch.end; ++t) {
        const double square = (place - triangles[t].middle).squaredNorm();
        if (square <= triangles[t].around * triangles[t].around) function(triangles[t], std::sqrt(square));
      }
    }
  }
};

void SurfaceContacts::list_candidates(int cell, const Surfaces& surfaces, const Bins& bins, double skin) {
  CandidateList& list = lists_[cell];
  list.images.clear();
  list.groups.clear();
  list.candidates.clear();
  const CellRange& own = surfaces.cells[cell];
  const auto place_of = [&](int node) {
    return Vec<3>(surfaces.position[0][node], surfaces.position[1][node], surfaces.position[2][node]);
  };
  const auto box_of = [&](int first, int end) {
    Eigen::AlignedBox3d box;
    for (int node = first; node < end; ++node)
      if (usable(place_of(node))) box.extend(place_of(node));
    return box;
  };
  const Eigen::AlignedBox3d box = box_of(own.first, own.end());
  if (box.isEmpty()) return;
  Neighbours neighbours(cell, box, surfaces, bins, *this, skin);
  for (const Neighbours::Image& image : neighbours.images)
    list.images.push_back(
        {image.other, image.shift, image.within(cell), 0, nullptr, moved_by(image.shift, domain_), 0, 0});
  std::vector<Candidate>& fresh = list.fresh;
  for (int node = own.first; node < own.end(); ++node) {
    // Nodes that follow each other lie side by side in most meshes.
    constexpr int together = 16;
    if ((node - own.first) % together == 0) neighbours.choose(box_of(node, std::min(node + together, own.end())));
    const Vec<3> place = place_of(node);
    if (!usable(place)) continue;
    for (std::size_t i = 0; i < neighbours.images.size(); ++i) {
      const Neighbours::Image& image = neighbours.images[i];
      if (image.near.empty()) continue;
      fresh.clear();
      const bool within = list.images[i].within;
      // A triangle's middle is no nearer than the triangle, and farther away by its radius at most.
      double nearest = std::numeric_limits<double>::infinity();
      neighbours.for_near(place, image, [&](const Neighbours::Triangle& triangle, double distance) {
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

std::span<SurfaceContacts::Candidate> SurfaceContacts::CandidateList::next(const Search& search) {
  Group& group = groups[search.group];
  if (search.looked < 0) return group.first;
  const int from = group.begin + search.looked;
  return std::span(candidates).subspan(from, std::min(at_once, group.end - from));
}

/// Those that have been looked at have new distances: the nearest of them are the first, the others are sorted again.
void SurfaceContacts::sort_in(CandidateList& list, const Search& search) {
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
void SurfaceContacts::look_at_next(const Surfaces& surfaces, CandidateList& list) const {
  const auto count = static_cast<int>(list.searching.size());
  ClosestPoints& points = list.points;
  points.resize(count * at_once);
  for (int s = 0; s < count; ++s) {
    const Search& search = list.searches[list.searching[s]];
    const Group& group = list.groups[search.group];
    const Image& image = list.images[group.image];
    const auto candidates = list.next(search);
    const Vec<3> place =
        Vec<3>(surfaces.position[0][group.node], surfaces.position[1][group.node], surfaces.position[2][group.node]) -
        image.moved;
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
    if (closest >= 0) {
      for (int c = 0; c < 3; ++c)
        search.weight[c] = points.weight[c][closest], search.away[c] = points.away[c][closest];
    }
    search.looked = search.looked < 0 ? 0 : search.looked + static_cast<int>(candidates.size());
    list.searching[left] = number;
    left += list.nearest_from(group, search.looked) - path - slack > std::sqrt(search.square) ? 0 : 1;
  }
  list.searching.resize(left);
}

void SurfaceContacts::find(int cell, const Surfaces& surfaces, std::vector<SurfaceContact>& contacts) const {
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

SurfaceContact SurfaceContacts::contact(const Search& search, const CandidateList& list, const Surfaces& surfaces) {
  const Group& group = list.groups[search.group];
  const Image& image = list.images[group.image];
  const auto& [i, j, k] = image.triangles[search.closest];
  const double root = std::sqrt(search.square);
  SurfaceContact contact{group.node,
                         image.other,
                         {image.shift[0], image.shift[1], image.shift[2]},
                         image.within,
                         {image.first_node + i, image.first_node + j, image.first_node + k},
                         search.weight,
                         std::max(root, SurfaceContact::least_distance),
                         {}};
  if (root > SurfaceContact::least_distance) {
    contact.direction = search.away / root;
  } else {
    const Nodes nodes = surfaces.nodes(image.other);
    contact.direction = (nodes[j] - nodes[i]).cross(nodes[k] - nodes[i]).normalized();
  }
  return contact;
}

}  // namespace rouleau::core
