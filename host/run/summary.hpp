// What summary.json says: how a run ended, what it cost, what was computed and what was left out.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "monitor/failure.hpp"
#include "observe/aggregates.hpp"
#include "plan/plan_report.hpp"
#include "plugin/lock.hpp"

namespace rouleau::run {

/// What ended a stage; none: it goes on.
enum class Ending { none, duration, strain, at_rest, equilibrium, mean, parted, max_steps, interrupted, failed };
NLOHMANN_JSON_SERIALIZE_ENUM(Ending, {{Ending::none, ""},
                                      {Ending::duration, "duration"},
                                      {Ending::strain, "strain"},
                                      {Ending::at_rest, "at_rest"},
                                      {Ending::equilibrium, "equilibrium"},
                                      {Ending::mean, "mean"},
                                      {Ending::parted, "parted"},
                                      {Ending::max_steps, "max_steps"},
                                      {Ending::interrupted, "interrupted"},
                                      {Ending::failed, "failed"}})
struct StageEnd {
  std::string name;
  long steps = 0;
  Ending ended_by = Ending::none;
  double wall_s = 0;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(StageEnd, name, steps, ended_by, wall_s)
};

/// Where a run went on from a checkpoint.
struct Continuation {
  long step = 0;
  int threads = 1;
  int ranks = 1;
  std::vector<std::string> accepted;  ///< differences from the run before, which --force let pass
  std::string damaged_checkpoint;     ///< why it was not the last one; empty: it was
};
void to_json(nlohmann::json& json, const Continuation& continuation);
void from_json(const nlohmann::json& json, Continuation& continuation);

/// What a pass of the steps has taken so far.
struct PassCost {
  std::string name;
  double wall_s = 0;
  long calls = 0;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PassCost, name, wall_s, calls)
};

struct PluginUse {
  std::string id, version, kind, library, sha256;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PluginUse, id, version, kind, library, sha256)
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
  int ranks = 1, threads = 1;           ///< threads: of a rank
  std::string message_library;          ///< of the ranks; empty: there is one
  int dimensions = 2;
  std::string precision, instruction_set;
  std::vector<PluginUse> plugins;
  std::optional<plugin::LockUse> lock;
  std::optional<plan::NumericsChoice> numerics_choice;
  plan::PlanReport plan;  ///< whose passes are not written: those of the run are
  std::vector<PassCost> passes;
  double mach_max = std::numeric_limits<double>::quiet_NaN();
  double mass_drift = 0, area_drift_max = 0, momentum_residual = 0;
  std::array<double, 2> stretch{};  ///< smallest and largest of any segment at any output
  double area_leakage_max = 0;      ///< NaN without area correction
  int aggregates_final = 0;
  std::vector<observe::AggregateEvent> aggregate_history;  ///< one entry at each change
  nlohmann::json energy;                                   ///< object: observe::EnergyHistory::summary()
  nlohmann::json rheology = nlohmann::json::array();       ///< observe::RheologyHistory::stages()
  nlohmann::json lifetimes = nlohmann::json::array();      ///< observe::AggregateHistory::lifetimes()
  nlohmann::json cell_traffic;                             ///< observe::CellTraffic::summary(); null: cells stay
  std::vector<StageEnd> stages;
  std::vector<Continuation> resumed;
};

/// Numbers that are not finite are null once it is written.
nlohmann::json to_json(const Summary& summary);

/// How the run ended, in a few words: "completed after 120 steps"; also where the limit of steps cut it short, which
/// the status does not tell.
std::string outcome(const Summary& summary);

}  // namespace rouleau::run
