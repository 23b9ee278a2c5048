// Which parts of its own surface a membrane may touch, in three dimensions.
#pragma once

#include <vector>

#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// Of each node of a shape, the triangles whose corners are all at least pi/2 cutoffs away along the surface at rest
/// (half a circle that is a cutoff wide). The way is measured along edges and across pairs of triangles, which on
/// regular meshes is at most 4 % too long; that much is taken off. Which triangles these are never changes, so that
/// forces are an exact gradient. A flat membrane, and a round one wider than the cutoff, do nothing to themselves.
class SelfReach {
 public:
  SelfReach(const RestSurface& rest, double cutoff);

  [[nodiscard]] double cutoff() const { return cutoff_; }
  [[nodiscard]] bool allows(int node, int triangle) const {
    return allowed_[static_cast<std::size_t>(node) * triangles_ + static_cast<std::size_t>(triangle)];
  }

 private:
  double cutoff_;
  std::size_t triangles_;
  std::vector<bool> allowed_;  // of each node, each triangle
};

}  // namespace rouleau::core
