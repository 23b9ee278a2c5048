// Whether the membranes have come to rest: no node has moved further than a limit within a window of time.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "core/membrane/displacement_watch.hpp"

namespace rouleau::monitor {

/// Compares positions with those at the start of the window; windows follow one another.
class RestWatch {
 public:
  /// A window begins. `cells`: null for who will not ask how far they have moved.
  void start(long step, const core::CellNodes* cells) {
    step_ = step;
    if (cells != nullptr) old_ = {cells->x, cells->y, cells->z};
  }
  /// First step at which a window of so many steps has ended.
  [[nodiscard]] long end(long window) const { return step_ + window; }
  /// Largest distance that a node has moved since the window began, spacings.
  [[nodiscard]] double moved(const core::CellNodes& cells) const {
    return core::largest_displacement(cells, {old_.x.data(), old_.y.data(), old_.z.data()}, {0, cells.node_count()});
  }
  [[nodiscard]] bool fits(const core::CellNodes& cells) const {
    return step_ >= 0 && old_.x.size() == cells.x.size() && old_.y.size() == cells.y.size() &&
           old_.z.size() == cells.z.size();
  }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RestWatch, step_, old_)

 private:
  struct OldPlaces {
    std::vector<double> x, y, z;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(OldPlaces, x, y, z)
  };
  long step_ = 0;
  OldPlaces old_;
};

}  // namespace rouleau::monitor
