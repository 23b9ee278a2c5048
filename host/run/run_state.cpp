#include "run_state.hpp"

#include "core/membrane/cell_nodes.hpp"

namespace rouleau::run {

void RunState::report(Summary& s) const {
  s.steps = steps;
  s.strain = strain;
  s.simulated_time_s = time;
  s.wall_s = wall;
  s.steps_per_s = wall > 0 ? static_cast<double>(steps) / wall : 0;
  s.passes = costs.passes();
  s.mach_max = observer.mach_max();
  s.mass_drift = observer.mass_drift();
  s.area_drift_max = observer.area_drift_max();
  s.stretch = {observer.stretch().least, observer.stretch().most};
  s.momentum_residual = momentum_residual;
  s.aggregates_final = history.count();
  s.aggregate_history = history.events();
  s.rheology = rheology.stages();
  s.energy = energy.summary();
  s.stages = stages;
  s.resumed = resumed;
}

bool RunState::fits(const plan::Plan& plan, const core::CellNodes& membranes) const {
  return stage >= 0 && stage < static_cast<int>(plan.stages.size()) && stage_step >= 0 && steps_before >= 0 &&
         steps >= stage_step && observer.fits(membranes) && rheology.fits() &&
         rest_watch.fits(membranes, plan.stages[stage].stage->until_at_rest);
}

}  // namespace rouleau::run
