// The flow of a run as short lines along it, for pictures and videos.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "report/report_fields.hpp"

namespace rouleau::report {

/// A piece of a path that the fluid follows.
struct FlowLine {
  std::vector<std::array<double, 2>> points;  ///< m, not wrapped into the box
  double strength;                            ///< from 0, unseen, to 1
};

/// A velocity at the middles of equal blocks of a box, m/s.
struct BlockVelocity {
  std::array<double, 2> first{}, size{};  ///< m, of the box
  ScalarField u, v;
  bool periodic_x = false;
  /// Between the blocks, linearly; beyond the outermost middles the velocity there.
  [[nodiscard]] std::array<double, 2> at(double x, double y) const;
};

/// Lines of tracers that start on a fixed, uneven grid, follow `velocity` for `seconds`, fade, and start anew: at
/// `turn` 0, 1, 2, ... the pattern is the same again only in kind. The same numbers give the same lines.
std::vector<FlowLine> flow_lines(const BlockVelocity& velocity, double turn, double seconds);

}  // namespace rouleau::report
