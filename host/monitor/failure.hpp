// Why a run stopped early, and what that looks like.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace rouleau::monitor {

/// Why a run stopped early.
struct Failure {
  std::string
      reason;  ///< code: non_finite, mach, node_step, escaped, area_drift, uneven_nodes, crossing, energy_growth
  long step = 0;
  double time = 0, strain = 0;
  std::array<double, 2> place{};  ///< m
  int cell = -1;                  ///< -1: none
  double value = 0, limit = 0;    ///< what was measured and the limit it passed
  std::string message;            ///< one sentence
  std::string remedy;             ///< what to change
  std::optional<double> place_z = {};  ///< m, in three dimensions
};

}  // namespace rouleau::monitor
