// What a run in blocks would ask of each rank, known before its first step.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/domain/decomposition.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// Of one rank, with the cells where they begin. Bytes of a step: what the rank sends, the mean of two steps; reactions
/// between cells of different ranks, a small part, are left out.
struct RankCost {
  long nodes = 0;  ///< of its block
  long cells = 0;  ///< that it owns
  long membrane_nodes = 0;
  long neighbours = 0;    ///< ranks that it shares a border with
  double halo_bytes = 0;  ///< populations and velocities of a step, to neighbours
  double cell_bytes = 0;  ///< positions, forces and velocities of membranes of a step, to all
  double memory_bytes = 0;
  double step_s = 0;  ///< computing alone
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RankCost, nodes, cells, membrane_nodes, neighbours, halo_bytes, cell_bytes,
                                 memory_bytes, step_s)
};

std::vector<RankCost> rank_costs(const Plan& plan, const core::Decomposition<2>& blocks);

/// Mean step_s over the largest: the part of the time in which ranks would compute if messages took none.
double balance(const std::vector<RankCost>& ranks);

/// For people: least, mean and most of all ranks.
std::string to_text(const std::vector<RankCost>& ranks);

}  // namespace rouleau::plan
