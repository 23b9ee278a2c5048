// Walls of any shape: which nodes of the lattice are solid, and where between them and the fluid the wall is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/geometry/formulas.hpp"

namespace rouleau::core {

/// A mark for every node of the whole lattice. Between a fluid node and a solid one lies a wall.
template <int D>
class SolidNodes {
 public:
  using Node = std::array<int, D>;
  /// Share of the link from a fluid node to the solid one at `node + to` that lies in the fluid, in (0, 1].
  using Cut = std::function<double(const Node& node, const Node& to)>;

  /// Without `cut` walls are half way: no mass is lost, and velocities are of first order. With it they are
  /// interpolated, of second order; then links that leave the domain are cut, too.
  SolidNodes(const Node& size, const std::function<bool(const Node&)>& is_solid, Cut cut = {})
      : size_(size), cut_(std::move(cut)) {
    const Box<D> all{{}, size};
    solid_.reserve(static_cast<std::size_t>(row_count(all)) * size[0]);
    for (int i = 0; i < row_count(all); ++i) {
      const std::array<int, D - 1> row = row_of(all, i);
      Node node;
      std::copy(row.begin(), row.end(), node.begin() + 1);
      for (node[0] = 0; node[0] < size[0]; ++node[0]) solid_.push_back(is_solid(node));
    }
    fluid_count_ = std::count(solid_.begin(), solid_.end(), false);
  }

  /// All nodes outside of a region, or on its border; walls lie there.
  SolidNodes(const Node& size, RegionPointer<D> region)
      : SolidNodes(
            size, [&](const Node& node) { return region->distance(place_of(node)).value <= 0; },
            [region](const Node& node, const Node& to) { return region->share_inside(place_of(node), place_of(to)); }) {
    region_ = std::move(region);
  }

  [[nodiscard]] const Node& size() const { return size_; }
  /// Of a node of the lattice.
  [[nodiscard]] bool at(const Node& node) const {
    std::size_t place = 0;
    for (int k = D - 1; k >= 0; --k)
      place = place * static_cast<std::size_t>(size_[k]) + static_cast<std::size_t>(node[k]);
    return solid_[place];
  }
  /// The same of periodic images, too; what lies beyond the walls of the domain is none. Beyond an opening the section
  /// of the outermost nodes goes on.
  [[nodiscard]] bool at(const Domain<D>& domain, Node node) const {
    if (const int k = domain.open_axis; k >= 0) node[k] = std::clamp(node[k], 0, domain.size[k] - 1);
    for (int k = 0; k < D; ++k) {
      node[k] = domain.wrapped(k, node[k]);
      if (node[k] < 0) return false;
    }
    return at(node);
  }
  [[nodiscard]] double cut(const Node& node, const Node& to) const { return cut_ ? cut_(node, to) : 0.5; }
  /// Of the wall at that cut, in the region's unit of time.
  [[nodiscard]] Vec<D> velocity(const Node& node, const Node& to) const {
    if (!region_) return Vec<D>::Zero();
    return region_->velocity(place_of(node) + cut(node, to) * place_of(to));
  }
  [[nodiscard]] long fluid_count() const { return fluid_count_; }

 private:
  Node size_;
  Cut cut_;
  RegionPointer<D> region_;  ///< null: walls at rest
  std::vector<bool> solid_;
  long fluid_count_ = 0;

  static Vec<D> place_of(const Node& node) {
    Vec<D> place;
    for (int k = 0; k < D; ++k) place[k] = node[k];
    return place;
  }
};

/// A tube along x through the middle of the lattice; its radius in spacings.
inline RegionPointer<3> tube_region(const std::array<int, 3>& size, double radius) {
  return extruded(ball_region<2>({(size[1] - 1) / 2.0, (size[2] - 1) / 2.0}, radius), 0, -INFINITY, INFINITY);
}

}  // namespace rouleau::core
