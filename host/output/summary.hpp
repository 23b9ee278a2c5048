// What summary.json says: how a run ended, what it cost, what was computed and what was left out.
#pragma once

#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace rouleau::host {

/// What a failure looks like (docs/stability.md).
struct FailureMode {
  std::string name = "none";  ///< tangential, normal, node-scale, leakage, collapse, sound, none
  double wavelength = std::numeric_limits<double>::quiet_NaN();        ///< segments; NaN: no wave
  double tangential_share = std::numeric_limits<double>::quiet_NaN();  ///< of the wave's energy
  long step = -1;                                                      ///< whose motion told it; -1: none
};

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
  FailureMode mode;
};

struct Omission {
  std::string what, why;
};
struct PluginUse {
  std::string id, version, kind, library, sha256;
};
/// The lock that a run obeyed.
struct LockUse {
  std::string file, sha256;
};
struct PassCost {
  std::string name;
  double wall_s = 0;
  long calls = 0;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PassCost, name, wall_s, calls)
};
/// The setting that "numerics": "auto" changes where a limit is exceeded.
enum class RemediedBy { nothing, density_factor, resolution };

/// A limit of the method: the scene's value, where it ends, and limit / value.
struct Limit {
  std::string name;
  double value, limit, margin;
  std::string remedy;
  RemediedBy remedied_by = RemediedBy::nothing;
};
struct AggregateEvent {
  double strain, time;
  int count;
  std::vector<std::vector<int>> members;
  bool through_image;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(AggregateEvent, strain, time, count, members, through_image)
};

struct Summary {
  std::string status;  ///< completed, diverged, interrupted
  std::optional<Failure> failure;
  std::string title, scene_file, scene_sha256, git, machine, started;
  long steps = 0;
  long steps_at_most = 0;  ///< of all stages; one that ends at rest needs fewer
  double strain = 0, simulated_time_s = 0, wall_s = 0, steps_per_s = 0, mlups = 0;
  long peak_rss_bytes = 0;
  std::optional<long> checkpoint_step;  ///< from which --resume goes on
  int threads = 1;
  std::string precision;
  std::vector<PluginUse> plugins;
  std::optional<LockUse> lock;
  std::vector<PassCost> passes;
  std::vector<Omission> left_out;
  nlohmann::json dimensionless;  ///< object: name -> number (null: undefined)
  std::vector<Limit> limits;
  nlohmann::json wells;  ///< array: the wells of the interactions, in SI
  double mass_drift = 0, area_drift_max = 0, momentum_residual = 0;
  std::array<double, 2> stretch{};  ///< smallest and largest of any segment at any output
  double area_leakage_max = 0;      ///< NaN without area correction
  int aggregates_final = 0;
  std::vector<AggregateEvent> aggregate_history;  ///< one entry at each change
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

/// JSON has neither infinity nor NaN: what is undefined is null.
nlohmann::json number_or_null(double value);

nlohmann::json to_json(const Summary& summary);

/// How the run ended, in a few words: "completed after 120 steps"; also where --max-steps cut it short, which the
/// status does not tell.
std::string outcome(const Summary& summary);

}  // namespace rouleau::host
