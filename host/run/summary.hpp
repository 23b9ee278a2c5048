// What summary.json says: how a run ended, what it cost, what was computed and what was left out.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "json/number_or_null.hpp"
#include "monitor/failure.hpp"
#include "observe/aggregate_event.hpp"
#include "pass_costs.hpp"
#include "plan/limit.hpp"
#include "plugin/lock.hpp"

namespace rouleau::run {

struct PluginUse {
  std::string id, version, kind, library, sha256;
};
struct Summary {
  std::string status;  ///< completed, diverged, interrupted
  std::optional<monitor::Failure> failure;
  std::string title, scene_file, scene_sha256, git, machine, started;
  long steps = 0;
  long steps_at_most = 0;  ///< of all stages; one that ends at rest needs fewer
  double strain = 0, simulated_time_s = 0, wall_s = 0, steps_per_s = 0, mlups = 0;
  long peak_rss_bytes = 0;
  std::optional<long> checkpoint_step;  ///< from which --resume goes on
  int threads = 1;
  std::string precision;
  std::vector<PluginUse> plugins;
  std::optional<plugin::LockUse> lock;
  std::vector<PassCost> passes;
  std::vector<plan::Omission> left_out;
  nlohmann::json dimensionless;  ///< object: name -> number (null: undefined)
  std::vector<plan::Limit> limits;
  nlohmann::json wells;  ///< array: the wells of the interactions, in SI
  double mass_drift = 0, area_drift_max = 0, momentum_residual = 0;
  std::array<double, 2> stretch{};  ///< smallest and largest of any segment at any output
  double area_leakage_max = 0;      ///< NaN without area correction
  int aggregates_final = 0;
  std::vector<observe::AggregateEvent> aggregate_history;  ///< one entry at each change
  std::vector<std::string> warnings;
  nlohmann::json conversions;      ///< array: {quantity, of, si, unit, lattice} for each stage
  nlohmann::json output_estimate;  ///< object: what the run was expected to write
  nlohmann::json numerics_choice;  ///< object: what "numerics": "auto" chose and why; null where the scene pins all
  nlohmann::json packings;         ///< array: cells that were placed at random
  nlohmann::json energy;           ///< object: growth of the total energy in stages at rest
  nlohmann::json rheology;         ///< array: means, break-up and rotation in each stage
  nlohmann::json stages;           ///< array: how each stage ended
  nlohmann::json resumed;          ///< array: where the run went on from a checkpoint
};

nlohmann::json to_json(const Summary& summary);

/// How the run ended, in a few words: "completed after 120 steps"; also where the limit of steps cut it short, which the
/// status does not tell.
std::string outcome(const Summary& summary);

}  // namespace rouleau::run
