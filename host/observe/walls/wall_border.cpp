#include "wall_border.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/geometry/border.hpp"
#include "scene/lattice.hpp"

namespace rouleau::observe {

namespace {

constexpr double most_samples = 300000;
constexpr std::size_t most_triangles = 40000;
constexpr double straight = 1e-3;  ///< samples: corners that lie nearer to the line past them are left out

/// Samples of a region along the first axes of a domain, from end to end; along the rest in its middle.
template <int Axes, int D>
class Samples {
 public:
  /// One in about `step` spacings. `beyond`: another one behind each end, far outside of a wall.
  Samples(const core::Domain<D>& domain, double step, bool beyond) : beyond_(beyond) {
    for (int k = 0; k < D; ++k) origin_[k] = domain.size[k] / 2.0 - 0.5;
    for (int k = 0; k < Axes; ++k) {
      const int intervals = std::max(1, static_cast<int>(std::lround(domain.size[k] / step)));
      spacing_[k] = static_cast<double>(domain.size[k]) / intervals;
      size_[k] = intervals + 1 + (beyond ? 2 : 0);
      origin_[k] = -0.5;
    }
  }
  /// The walls' border, counted in samples from the domain's corner.
  [[nodiscard]] core::Border<Axes> border(const core::Region<D>& region, double sign) const {
    // So that the border passes by the sample within, if not through it: triangles without size have no orientation.
    constexpr double far_outside = -1e3, least = 1e-6;
    std::size_t count = 1;
    for (const int along : size_) count *= static_cast<std::size_t>(along);
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      core::Vec<D> place = origin_;
      bool within = true;
      std::size_t rest = i;
      for (int k = 0; k < Axes; ++k) {
        const int at = static_cast<int>(rest % static_cast<std::size_t>(size_[k])) - (beyond_ ? 1 : 0);
        rest /= static_cast<std::size_t>(size_[k]);
        within = within && (!beyond_ || (at >= 0 && at < size_[k] - 2));
        place[k] += at * spacing_[k];
      }
      values[i] = within ? sign * region.distance(place).value : far_outside;
      if (beyond_ && std::abs(values[i]) < least) values[i] = -least;
    }
    core::Border<Axes> border = core::zero_border<Axes>(values, size_);
    for (core::Vec<Axes>& corner : border.corners)
      for (int k = 0; k < Axes && beyond_; ++k) corner[k] = std::clamp(corner[k] - 1, 0.0, length(k));
    return border;
  }
  /// Whether two places, counted in samples, lie at one end of the domain.
  [[nodiscard]] bool at_an_end(const core::Vec<Axes>& place, const core::Vec<Axes>& other) const {
    constexpr double near = 1e-3;
    for (int k = 0; k < Axes; ++k) {
      for (const double end : {0.0, length(k)})
        if (std::abs(place[k] - end) < near && std::abs(other[k] - end) < near) return true;
    }
    return false;
  }
  /// In m of the domain, of a place counted in samples.
  [[nodiscard]] std::array<double, Axes> metres(const core::Vec<Axes>& place, double lattice_spacing) const {
    std::array<double, Axes> found;
    for (int k = 0; k < Axes; ++k) found[k] = place[k] * spacing_[k] * lattice_spacing;
    return found;
  }

 private:
  [[nodiscard]] double length(int axis) const { return size_[axis] - (beyond_ ? 3 : 1); }

  bool beyond_;
  core::Vec<D> origin_;
  std::array<double, Axes> spacing_;
  std::array<int, Axes> size_;
};

template <int Axes, int D>
double step_for(const core::Domain<D>& domain, double least) {
  double count = 1;
  for (int k = 0; k < Axes; ++k) count *= domain.size[k];
  return std::max(least, std::pow(count / most_samples, 1.0 / Axes));
}

using Places = std::vector<core::Vec<2>>;

/// Closed polygons of a closed border.
std::vector<Places> polygons_of(const core::Border<2>& border) {
  // Corners that all but coincide are one, and what joined them is left out.
  constexpr double grain = 1.0 / 65536;
  std::map<std::pair<double, double>, std::vector<std::pair<double, double>>> next;
  const auto snapped = [&](int corner) {
    const core::Vec<2>& place = border.corners[static_cast<std::size_t>(corner)];
    return std::pair(std::round(place[0] / grain) * grain, std::round(place[1] / grain) * grain);
  };
  for (const auto& [from, to] : border.facets)
    if (snapped(from) != snapped(to)) next[snapped(from)].push_back(snapped(to));
  std::vector<Places> polygons;
  while (!next.empty()) {  // as many segments begin at a corner as end there, so that every way comes back
    Places& polygon = polygons.emplace_back();
    auto at = next.begin();
    do {
      polygon.emplace_back(at->first.first, at->first.second);
      const auto to = at->second.back();
      at->second.pop_back();
      if (at->second.empty()) next.erase(at);
      at = next.find(to);
    } while (at != next.end());
  }
  return polygons;
}

/// Without corners on straight parts, sides no longer than that; nothing of what has no area.
Places simplified(const Places& polygon, double longest) {
  Places kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const core::Vec<2>& before = kept.empty() ? polygon.back() : kept.back();
    const core::Vec<2> past = polygon[(i + 1) % polygon.size()] - before, here = polygon[i] - before;
    const bool on_the_way = here.dot(past) >= 0 && here.dot(past) <= past.squaredNorm();
    if (!on_the_way || past.norm() > longest ||
        std::abs(here[0] * past[1] - here[1] * past[0]) > straight * past.norm())
      kept.push_back(polygon[i]);
  }
  if (kept.size() < 3) kept.clear();
  return kept;
}

template <int D>
void add_polygons(const core::Region<D>& region, const core::Domain<D>& domain, double spacing, double longest,
                  WallBorder& walls) {
  constexpr double least = 0.25;
  const double step = step_for<2>(domain, least);
  const Samples<2, D> samples(domain, step, true);
  for (const Places& polygon : polygons_of(samples.border(region, -1))) {
    const Places corners = simplified(polygon, longest / step);
    if (corners.empty()) continue;
    const auto count = static_cast<int>(corners.size());
    for (int i = 0; i < count; ++i) {
      const int next = (i + 1) % count;
      if (!samples.at_an_end(corners[std::size_t(i)], corners[std::size_t(next)]))
        walls.segments.push_back({walls.first.back() + i, walls.first.back() + next});
      walls.corners.push_back(samples.metres(corners[std::size_t(i)], spacing));
    }
    walls.first.push_back(static_cast<int>(walls.corners.size()));
  }
}

void add_surface(const core::Region<2>&, const core::Domain<2>&, double, WallBorder&) {}
void add_surface(const core::Region<3>& region, const core::Domain<3>& domain, double spacing, WallBorder& walls) {
  for (double step = step_for<3>(domain, 1);; step *= 1.25) {
    const Samples<3, 3> samples(domain, step, false);
    const core::Border<3> border = samples.border(region, 1);
    if (border.facets.size() > most_triangles) continue;
    for (const core::Vec<3>& corner : border.corners) walls.points.push_back(samples.metres(corner, spacing));
    walls.triangles = border.facets;
    return;
  }
}

template <int D>
void add_walls(const scene::Scene& scene, WallBorder& walls) {
  const core::RegionPointer<D> region = scene::fluid_region<D>(scene);
  if (!region) return;
  const core::Domain<D> domain = scene::lattice_domain<D>(scene);
  const double spacing = scene::lattice_spacing(scene);
  // What is shown on the walls varies along straight ones, too.
  const double longest = scene.output.wants(shear_stress) ? 1 : std::numeric_limits<double>::infinity();
  add_polygons(*region, domain, spacing, longest, walls);
  add_surface(*region, domain, spacing, walls);
}

}  // namespace

WallBorder wall_border(const scene::Scene& scene) {
  WallBorder walls;
  add_walls<2>(scene, walls);
  add_walls<3>(scene, walls);
  return walls;
}

template <int D>
std::vector<core::Vec<D>> facet_middles(const WallBorder& walls) {
  const auto& points = std::get<const std::vector<std::array<double, D>>&>(std::tie(walls.corners, walls.points));
  std::vector<core::Vec<D>> middles;
  for (const auto& facet :
       std::get<const std::vector<std::array<int, D>>&>(std::tie(walls.segments, walls.triangles))) {
    core::Vec<D>& middle = middles.emplace_back(core::Vec<D>::Zero());
    for (const int corner : facet) middle += core::Vec<D>(points[static_cast<std::size_t>(corner)].data()) / D;
  }
  return middles;
}
template std::vector<core::Vec<2>> facet_middles(const WallBorder&);
template std::vector<core::Vec<3>> facet_middles(const WallBorder&);

}  // namespace rouleau::observe
