#include "surface_contacts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "triangle_distance.hpp"

namespace rouleau::core {

namespace {

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
    for (int cell = 0; cell < surfaces.cell_count(); ++cell) {
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

  /// Calls function(entry) for the triangles that may lie within the reach of a place, in some order.
  template <class Function>
  void for_near(const Vec<3>& place, Function function) const {
    int first[3], last[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int around = static_cast<int>(std::ceil(reach_ / width_[axis])), at = along(axis, place[axis]);
      first[axis] = at - around, last[axis] = at + around;
      if (domain_.periodic[axis]) {
        last[axis] = std::min(last[axis], first[axis] + count_[axis] - 1);  // no bin twice
      } else {
        first[axis] = std::max(first[axis], 0), last[axis] = std::min(last[axis], count_[axis] - 1);
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

SurfaceContacts::SurfaceContacts(const Surfaces& surfaces, Cutoffs cutoffs, const Domain<3>& domain)
    : cutoffs_(std::move(cutoffs)), domain_(domain), watch_(surfaces), lists_(surfaces.cells.size()) {}

SurfaceContacts SurfaceContacts::within(double reach, const Surfaces& surfaces, const Domain<3>& domain) {
  const int types = static_cast<int>(surfaces.types.size());
  Cutoffs cutoffs(types);
  for (int a = 0; a < types; ++a) {
    for (int b = 0; b <= a; ++b) cutoffs.raise(a, b, reach);
  }
  SurfaceContacts contacts(surfaces, std::move(cutoffs), domain);
  contacts.measure({}, surfaces);
  contacts.refresh({}, surfaces);
  return contacts;
}

void SurfaceContacts::refresh(Worker worker, const Surfaces& surfaces) {
  if (!watch_.exceeded()) return;
  const Range cells = worker.share(surfaces.cell_count());
  const double skin = suitable_skin(surfaces);
  // Every worker sorts all triangles: that is quicker than to wait for one who does.
  const Bins bins(surfaces, cutoffs_.largest() + 2 * skin, domain_);
  for (int cell = cells.begin; cell < cells.end; ++cell) {
    list_candidates(cell, surfaces, bins, skin);
    watch_.remember(cell, surfaces, skin);
  }
  if (worker.first()) ++renewals_;
}

void SurfaceContacts::list_candidates(int cell, const Surfaces& surfaces, const Bins& bins, double skin) {
  CandidateList& list = lists_[cell];
  list.groups.clear();
  list.candidates.clear();
  struct Found {
    int other;
    std::array<int, 3> shift;
    double distance;
    int triangle;
    [[nodiscard]] auto order() const { return std::tie(other, shift, distance, triangle); }
  };
  std::vector<Found> found;
  const CellRange& own = surfaces.cells[cell];
  for (int node = own.first; node < own.end(); ++node) {
    const Vec<3> place(surfaces.x[node], surfaces.y[node], surfaces.z[node]);
    if (!usable(place)) continue;
    found.clear();
    bins.for_near(place, [&](const Bins::Entry& entry) {
      const double cutoff = cutoffs_(own.type, surfaces.cells[entry.cell].type);
      if (!(cutoff > 0)) return;
      const double reach = cutoff + 2 * skin, around = reach + entry.radius;
      const Vec<3> apart = place - entry.middle;
      Vec<3> nearest = apart;  // of all images
      for (int axis = 0; axis < 3; ++axis) {
        if (domain_.periodic[axis])
          nearest[axis] -= std::round(apart[axis] / domain_.period(axis)) * domain_.period(axis);
      }
      if (nearest.squaredNorm() > around * around) return;
      const Nodes nodes = surfaces.nodes(entry.cell);
      const auto& [i, j, k] = surfaces.type_of(entry.cell).mesh.triangles()[entry.triangle];
      // All images of the triangle that come so near: in a narrow box more than the nearest one.
      std::array<int, 3> first{}, last{};
      for (int axis = 0; axis < 3; ++axis) {
        if (!domain_.periodic[axis]) continue;
        first[axis] = static_cast<int>(std::ceil((apart[axis] - around) / domain_.period(axis)));
        last[axis] = static_cast<int>(std::floor((apart[axis] + around) / domain_.period(axis)));
      }
      std::array<int, 3> shift{};
      for (shift[2] = first[2]; shift[2] <= last[2]; ++shift[2]) {
        for (shift[1] = first[1]; shift[1] <= last[1]; ++shift[1]) {
          for (shift[0] = first[0]; shift[0] <= last[0]; ++shift[0]) {
            if (entry.cell == cell && shift == std::array<int, 3>{}) continue;
            Vec<3> near = place;
            for (int axis = 0; axis < 3; ++axis) {
              if (domain_.periodic[axis]) near[axis] -= shift[axis] * domain_.period(axis);
            }
            if ((near - entry.middle).squaredNorm() > around * around) continue;
            const double distance = (near - closest_point(near, nodes[i], nodes[j], nodes[k]).place).norm();
            if (distance <= reach) found.push_back({entry.cell, shift, distance, entry.triangle});
          }
        }
      }
    });
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.order() < b.order(); });
    for (std::size_t begin = 0; begin < found.size();) {
      const Found& nearest = found[begin];
      std::size_t end = begin;
      const int first = static_cast<int>(list.candidates.size());
      for (; end < found.size() && found[end].other == nearest.other && found[end].shift == nearest.shift; ++end) {
        if (found[end].distance <= nearest.distance + 4 * skin)
          list.candidates.push_back({found[end].distance, found[end].triangle});
      }
      list.groups.push_back({node, nearest.other, nearest.shift, first, static_cast<int>(list.candidates.size())});
      begin = end;
    }
  }
}

void SurfaceContacts::find(int cell, const Surfaces& surfaces, std::vector<SurfaceContact>& contacts) const {
  contacts.clear();
  const CandidateList& list = lists_[cell];
  const std::vector<double>& moved = watch_.memory().bound;
  const int type = surfaces.cells[cell].type;
  for (const Group& group : list.groups) {
    const CellRange& other = surfaces.cells[group.other];
    const Nodes nodes = surfaces.nodes(group.other);
    const auto& triangles = surfaces.type_of(group.other).mesh.triangles();
    const double cutoff = cutoffs_(type, other.type);
    // How much nearer a triangle may have come since the list was made, rounding included.
    const double slack = moved[cell] + moved[group.other] + 1e-9;
    Vec<3> place(surfaces.x[group.node], surfaces.y[group.node], surfaces.z[group.node]);
    for (int k = 0; k < 3; ++k) place[k] -= group.shift[k] * (domain_.periodic[k] ? domain_.period(k) : 0);
    double square = cutoff * cutoff, root = cutoff;
    int closest = -1;
    TrianglePoint point{.weight = {}, .place = Vec<3>::Zero()};
    for (int c = group.begin; c < group.end; ++c) {
      const Candidate& candidate = list.candidates[c];
      if (candidate.distance - slack > root) break;
      const auto& [i, j, k] = triangles[candidate.triangle];
      const TrianglePoint there = closest_point(place, nodes[i], nodes[j], nodes[k]);
      const double here = (place - there.place).squaredNorm();
      // Of triangles equally far away the first counts, in whatever order they are listed.
      if (!(here < square || (here == square && (closest < 0 || candidate.triangle < closest)))) continue;
      square = here, root = std::sqrt(here), closest = candidate.triangle, point = there;
    }
    if (closest < 0) continue;
    const auto& [i, j, k] = triangles[closest];
    SurfaceContact contact{group.node,
                           group.other,
                           group.shift,
                           {other.first + i, other.first + j, other.first + k},
                           point.weight,
                           std::max(root, SurfaceContact::least_distance),
                           {}};
    contact.direction = root > SurfaceContact::least_distance
                            ? Vec<3>((place - point.place) / root)
                            : Vec<3>((nodes[j] - nodes[i]).cross(nodes[k] - nodes[i]).normalized());
    contacts.push_back(contact);
  }
}

}  // namespace rouleau::core
