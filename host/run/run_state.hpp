// All that a run knows from one step to the next besides the fluid and the membranes; a checkpoint keeps it.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/fluid/any_fluid.hpp"
#include "files/checkpoint_file.hpp"
#include "json/json.hpp"
#include "monitor/rest_watch.hpp"
#include "observe/aggregate_history.hpp"
#include "observe/cell_traffic.hpp"
#include "observe/energy.hpp"
#include "observe/observer.hpp"
#include "observe/profiles.hpp"
#include "observe/rheology_history.hpp"
#include "plan/plan.hpp"
#include "summary.hpp"

namespace rouleau::run {

/// Where the time of a run goes, pass by pass.
class PassCosts {
 public:
  /// Adds wall-clock time and calls to a pass.
  void add(const std::string& pass, double wall_s, long calls) {
    auto found = std::find_if(passes_.begin(), passes_.end(), [&](const PassCost& cost) { return cost.name == pass; });
    if (found == passes_.end()) found = passes_.insert(found, PassCost{pass, 0, 0});
    found->wall_s += wall_s;
    found->calls += calls;
  }
  /// Of a pass; 0 of one that has not been added.
  [[nodiscard]] double wall_s(const std::string& pass) const {
    const auto found =
        std::find_if(passes_.begin(), passes_.end(), [&](const PassCost& cost) { return cost.name == pass; });
    return found == passes_.end() ? 0 : found->wall_s;
  }
  /// In the order in which they were first added.
  [[nodiscard]] const std::vector<PassCost>& passes() const { return passes_; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PassCosts, passes_)

 private:
  std::vector<PassCost> passes_;
};

/// Cells that come and go through openings.
struct TrafficState {
  long next = 0;  ///< step of the run at which to look who comes and goes
  observe::CellTraffic cells;
  /// Whether it is about so many cells, those that have left among them.
  [[nodiscard]] bool fits(std::size_t count) const {
    const std::vector<int> there = cells.there();
    return there.empty() || (there.front() >= 0 && there.back() < static_cast<int>(count));
  }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(TrafficState, next, cells)
};

struct RunState {
  explicit RunState(observe::Observer made) : observer(std::move(made)) {}

  int stage = 0;                    ///< index of the present one
  long steps = 0, stage_step = 0;   ///< taken so far: by the run, by the stage
  long steps_before = 0;            ///< by the run when the stage began
  double time = 0, strain = 0;      ///< SI; at the start of the stage
  double wall = 0, stage_wall = 0;  ///< s, of the steps that count: by the run, by the stage
  double momentum_residual = 0;     ///< largest so far
  observe::Observer observer;
  observe::AggregateHistory history;
  observe::RheologyHistory rheology;
  observe::EnergyHistory energy;
  observe::ProfileHistory profiles;  ///< kept where they are wanted
  PassCosts costs;
  monitor::RestWatch rest_watch;
  monitor::EquilibriumWatch equilibrium;
  std::vector<StageEnd> stages;  ///< those that are over
  std::vector<Continuation> resumed;
  TrafficState traffic;  ///< kept where there are openings

  [[nodiscard]] double time_at(const scene::StageSetting& setting) const {
    return time + static_cast<double>(stage_step) * setting.units.time;
  }
  [[nodiscard]] double strain_at(const scene::StageSetting& setting) const {
    return strain + setting.strain_after(stage_step);
  }
  /// The stage is over: what it took is added up.
  void end_stage(const scene::StageSetting& setting, Ending ended_by) {
    time = time_at(setting);
    strain = strain_at(setting);
    stages.push_back({setting.stage->name, stage_step, ended_by, stage_wall});
  }
  /// Puts what happened into a summary.
  void report(Summary& summary) const;
  /// Whether it can be that of a run of this plan, before which it may have come from anywhere.
  [[nodiscard]] bool fits(const plan::Plan& plan, const core::CellNodes& membranes) const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RunState, stage, steps, stage_step, steps_before, time, strain, wall, stage_wall,
                                 momentum_residual, observer, history, rheology, energy, costs, rest_watch, equilibrium,
                                 stages, resumed)
};

/// Writes the arrays, if there are links; `writer`: null on ranks that do not write. Returns how many there are.
std::size_t save_links(files::CheckpointWriter* writer, const core::LinkMemory& links);
/// Of the solver's part of a checkpoint. Former versions kept nothing, and took what came back for what had left.
core::LinkMemory read_links(const files::CheckpointReader& reader, const nlohmann::json& of_solver);

}  // namespace rouleau::run
