// All that a run knows from one step to the next besides the fluid and the membranes; a checkpoint keeps it.
#pragma once

#include <nlohmann/json.hpp>
#include <utility>

#include "monitor/growth_watch.hpp"
#include "monitor/rest_watch.hpp"
#include "observe/aggregate_history.hpp"
#include "observe/energy.hpp"
#include "observe/observer.hpp"
#include "observe/rheology_history.hpp"
#include "pass_costs.hpp"
#include "plan/plan.hpp"
#include "summary.hpp"

namespace rouleau::run {

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
  monitor::GrowthWatch growth;
  PassCosts costs;
  monitor::RestWatch rest_watch;
  nlohmann::json stages = nlohmann::json::array();   ///< how each stage ended
  nlohmann::json resumed = nlohmann::json::array();  ///< where the run went on from a checkpoint

  [[nodiscard]] double time_at(const plan::StageSetting& setting) const {
    return time + static_cast<double>(stage_step) * setting.units.time;
  }
  [[nodiscard]] double strain_at(const plan::StageSetting& setting) const {
    return strain + std::abs(setting.shear_rate) * static_cast<double>(stage_step);
  }
  /// The stage is over: what it took is added up.
  void end_stage(const plan::StageSetting& setting, const char* ended_by) {
    time = time_at(setting);
    strain = strain_at(setting);
    stages.push_back(
        {{"name", setting.stage->name}, {"steps", stage_step}, {"ended_by", ended_by}, {"wall_s", stage_wall}});
  }
  /// Puts what happened into a summary.
  void report(Summary& summary) const;
  /// Whether it can be that of a run of this plan, before which it may have come from anywhere.
  [[nodiscard]] bool fits(const plan::Plan& plan, const core::Membranes& membranes) const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RunState, stage, steps, stage_step, steps_before, time, strain, wall, stage_wall,
                                 momentum_residual, observer, history, rheology, energy, growth, costs, rest_watch,
                                 stages, resumed)
};

}  // namespace rouleau::run
