// Whether the membranes have come to rest: no node has moved further than a limit within a window of time.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "core/membrane/displacement_watch.hpp"
#include "core/membrane/membranes.hpp"

namespace rouleau::monitor {

/// Compares positions with those at the start of the window; windows follow one another.
class RestWatch {
 public:
  /// A window begins.
  void start(long step, const core::Membranes& membranes) {
    step_ = step;
    x_ = membranes.x;
    y_ = membranes.y;
  }
  /// First step at which a window of so many steps has ended.
  [[nodiscard]] long end(long window) const { return step_ + window; }
  /// Largest distance that a node has moved since the window began, spacings.
  [[nodiscard]] double moved(const core::Membranes& membranes) const {
    return core::largest_displacement(membranes.x, membranes.y, x_, y_, {0, membranes.node_count()});
  }
  [[nodiscard]] bool fits(const core::Membranes& membranes) const {
    return step_ >= 0 && x_.size() == membranes.x.size() && y_.size() == membranes.x.size();
  }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RestWatch, step_, x_, y_)

 private:
  long step_ = 0;
  std::vector<double> x_, y_;
};

}  // namespace rouleau::monitor
