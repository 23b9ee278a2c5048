// What a run in blocks would ask of each rank, known before its first step.
#pragma once

#include <string>
#include <vector>

#include "blocks.hpp"
#include "json/json.hpp"
#include "plan/plan.hpp"

namespace rouleau::plan {

/// What the cut costs, s: measured by one rank that takes its steps alone (docs/results/scaling-2026-11.md).
struct CostOfSharing {
  double number_s;  ///< that goes to a neighbour: packing it, and unpacking one
  double ghost_s;   ///< a node of a ghost: unpacking it, finding where it touches the lattice, spreading
  double shown_s;   ///< a node that is told to another rank
  double row_s;     ///< a row that blocks have more than the lattice: its beginning and its end
};
inline constexpr CostOfSharing cost_of_sharing[2] = {{5e-9, 25e-9, 10e-9, 40e-9}, {2e-9, 65e-9, 23e-9, 40e-9}};

/// Of one rank, with the cells where they begin. Messages and bytes are those that the rank sends in a step, the mean
/// of two steps; bytes of reactions between cells of different ranks, a small part, are left out.
struct RankCost {
  long nodes = 0;  ///< of its block
  long cells = 0;  ///< that it owns
  long membrane_nodes = 0;
  long ghost_nodes = 0;  ///< of other ranks' cells that it knows, and that spread forces in its block or act on its own
  long neighbours = 0;   ///< ranks that it shares a border with
  long messages = 0;
  long waits = 0;                                   ///< how often in a step it waits for others
  double population_bytes = 0, velocity_bytes = 0;  ///< of the lattice, to neighbours
  double position_bytes = 0, force_bytes = 0;       ///< of its membranes, to the ranks that know them
  double node_velocity_bytes = 0;                   ///< of membranes in its block, to their owners
  double received_bytes = 0;
  double memory_bytes = 0;
  double step_s = 0;       ///< computing its own part, by plan::step_cost
  double membranes_s = 0;  ///< of which its own membranes take so much
  double sharing_s = 0;    ///< what the cut costs: packing and unpacking, and other ranks' membranes,
  double ghosts_s = 0;     ///< which take so much of it,
  double rows_s = 0;       ///< and rows that its block has more than the lattice has there
  [[nodiscard]] double lattice_bytes() const { return population_bytes + velocity_bytes; }
  [[nodiscard]] double membrane_bytes() const { return position_bytes + force_bytes + node_velocity_bytes; }
  [[nodiscard]] double sent_bytes() const { return lattice_bytes() + membrane_bytes(); }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RankCost, nodes, cells, membrane_nodes, ghost_nodes, neighbours, messages, waits,
                                 population_bytes, velocity_bytes, position_bytes, force_bytes, node_velocity_bytes,
                                 received_bytes, memory_bytes, step_s, membranes_s, sharing_s, ghosts_s, rows_s)
};

std::vector<RankCost> rank_costs(const Plan& plan, const Blocks& blocks);

/// Mean step_s over the largest: the part of the time in which ranks would compute if messages took none.
double balance(const std::vector<RankCost>& ranks);

/// For people: least, mean and most of all ranks.
std::string to_text(const std::vector<RankCost>& ranks);
/// One of them.
std::string to_text(const RankCost& cost, int rank, const Blocks& blocks);

}  // namespace rouleau::plan
