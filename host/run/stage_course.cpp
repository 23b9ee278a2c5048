#include "stage_course.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "observe/energy.hpp"

namespace rouleau::run {

template <int D>
void StageCourse::begin(const core::AnySolver<D>& solver) {
  state_.observer.start_stage();
  state_.stage_step = 0;
  by_outputs_ = Ending::none;
  state_.steps_before = state_.steps;
  state_.stage_wall = 0;
  state_.rest_watch.stop();
  if (setting().stage->until_at_rest) state_.rest_watch.start(0, solver.cells(), solver.ghosts());
  state_.equilibrium.start();
  if (plan_.scene->domain.is_open()) state_.traffic.cells.begin_stage(setting().stage->name);
}

bool StageCourse::compares_positions() const {
  return setting().stage->until_at_rest && state_.stage_step >= state_.rest_watch.end(rest_window());
}

template <int D>
Ending StageCourse::by_outputs(const core::AnySolver<D>& solver) const {
  const scene::Stage& stage = *setting().stage;
  if (!stage.until_parted && stage.until_mean.empty()) return Ending::none;
  // The first rank alone has the outputs.
  const bool found = stage.until_parted
                         ? state_.rheology.parted(state_.stage)
                         : state_.rheology.knows(state_.stage, stage.until_mean, stage.until_standard_error);
  if (core::of_first(solver.ranks(), found ? 1.0 : 0.0) == 0) return Ending::none;
  return stage.until_parted ? Ending::parted : Ending::mean;
}

template <int D>
Ending StageCourse::ending(const core::AnySolver<D>& solver) const {
  const scene::Stage& stage = *setting().stage;
  if (compares_positions()) {
    const double moved = state_.rest_watch.moved(solver.cells(), solver.ghosts());
    if (core::of_first(solver.ranks(), moved) < plan_.scene->at_rest.displacement / setting().units.length)
      return Ending::at_rest;
  }
  if (stage.until_equilibrium && state_.equilibrium.reached()) return Ending::equilibrium;
  if (const Ending found = by_outputs_ ? *by_outputs_ : by_outputs(solver); found != Ending::none) return found;
  if (state_.stage_step < setting().max_steps) return Ending::none;
  const bool by_strain =
      stage.strain && (!stage.duration || *stage.strain / std::abs(stage.shear_rate) <= *stage.duration);
  return by_strain ? Ending::strain : Ending::duration;
}

template <int D>
Ending StageCourse::end(const core::AnySolver<D>& solver) {
  const Ending found = ending(solver);
  // The window by which a stage has ended stays: a checkpoint of this step ends it again.
  if (found == Ending::none && compares_positions())
    state_.rest_watch.start(state_.stage_step, solver.cells(), solver.ghosts());
  return found;
}

template <int D>
void StageCourse::look(core::AnySolver<D>& solver, bool has_outputs) {
  const scene::StageSetting& setting = this->setting();
  if (has_outputs || !by_outputs_) by_outputs_ = by_outputs(solver);
  if (!setting.stage->until_equilibrium || state_.stage_step < state_.equilibrium.next(energy_window())) return;
  const observe::CellEnergy energy = observe::cell_energy(solver);
  if (!energy.unknown.empty()) {
    throw Error(Cause::bad_input, plan_.scene->place(setting.stage->pointer + "/until"),
                "there is no energy to watch, since " + energy.unknown,
                {"end the stage by \"at_rest\" or by duration"});
  }
  state_.equilibrium.note(state_.stage_step, energy.sum, energy.magnitude + solver.slight_energy(),
                          plan_.scene->equilibrium.rate * setting.units.time);
}

template void StageCourse::begin(const core::AnySolver<2>&);
template Ending StageCourse::ending(const core::AnySolver<2>&) const;
template Ending StageCourse::end(const core::AnySolver<2>&);
template void StageCourse::look(core::AnySolver<2>&, bool);
template void StageCourse::begin(const core::AnySolver<3>&);
template Ending StageCourse::ending(const core::AnySolver<3>&) const;
template Ending StageCourse::end(const core::AnySolver<3>&);
template void StageCourse::look(core::AnySolver<3>&, bool);

long StageCourse::next() const {
  const scene::Stage& stage = *setting().stage;
  long next = setting().max_steps;
  if (by_outputs_ && *by_outputs_ != Ending::none) next = std::min(next, state_.stage_step + 1);
  if (stage.until_at_rest) next = std::min(next, state_.rest_watch.end(rest_window()));
  if (stage.until_equilibrium) {
    const bool reached = state_.equilibrium.reached();
    next = std::min(next, reached ? state_.stage_step + 1 : state_.equilibrium.next(energy_window()));
  }
  return next;
}

long StageCourse::steps_of(double seconds) const { return std::max(1L, std::lround(setting().steps_of(seconds))); }

}  // namespace rouleau::run
