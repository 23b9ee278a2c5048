// Tells when nodes have moved so far that lists made from their old positions must be made anew.
#pragma once

#include <cstdint>
#include <vector>

#include "membranes.hpp"
#include "worker.hpp"

namespace rouleau::host {

/// Largest distance between corresponding nodes of two sets of positions.
double largest_displacement(const std::vector<double>& x, const std::vector<double>& y,
                            const std::vector<double>& old_x, const std::vector<double>& old_y);

/// Remembers positions and compares. After construction every cell counts as moved.
class DisplacementWatch {
 public:
  DisplacementWatch() = default;
  DisplacementWatch(const Membranes& membranes, double limit);

  /// Pass: compares this worker's cells. A barrier must lie between it and exceeded().
  void measure(Worker worker, const Membranes& membranes);
  /// True if a node had moved further than the limit (or is not a number) at the last measure().
  [[nodiscard]] bool exceeded() const;
  /// Pass: remembers the present positions of this worker's cells. Does not change exceeded().
  void remember(Worker worker, const Membranes& membranes);

 private:
  double limit_ = 0;
  std::vector<double> x_, y_;
  std::vector<std::uint8_t> moved_;  // one per cell, so that the answer does not depend on the workers
};

}  // namespace rouleau::host
