#include "stage_course.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "observe/energy.hpp"

namespace rouleau::run {

void StageCourse::begin() {
  state_.observer.start_stage();
  state_.growth.start_stage();
  state_.stage_step = 0;
  state_.steps_before = state_.steps;
  state_.stage_wall = 0;
  state_.rest_watch.start(0, cells_);
  state_.equilibrium.start();
}

bool StageCourse::compares_positions() const {
  return setting().stage->until_at_rest && state_.stage_step >= state_.rest_watch.end(rest_window());
}

Ending StageCourse::ending() const {
  const scene::Stage& stage = *setting().stage;
  if (compares_positions() && agree_(cells_ != nullptr ? state_.rest_watch.moved(*cells_) : 0) <
                                  plan_.scene->at_rest.displacement / setting().units.length)
    return Ending::at_rest;
  if (stage.until_equilibrium && state_.equilibrium.reached()) return Ending::equilibrium;
  if (state_.stage_step < setting().max_steps) return Ending::none;
  const bool by_strain =
      stage.strain && (!stage.duration || *stage.strain / std::abs(stage.shear_rate) <= *stage.duration);
  return by_strain ? Ending::strain : Ending::duration;
}

Ending StageCourse::end() {
  const Ending found = ending();
  // The window by which a stage has ended stays: a checkpoint of this step ends it again.
  if (found == Ending::none && compares_positions()) state_.rest_watch.start(state_.stage_step, cells_);
  return found;
}

template <class T, class Set>
void StageCourse::look(core::Solver<T, Set>& solver) {
  const plan::StageSetting& setting = this->setting();
  if (!setting.stage->until_equilibrium || state_.stage_step < state_.equilibrium.next(energy_window())) return;
  const observe::CellEnergy energy = observe::cell_energy(solver);
  if (!energy.unknown.empty()) {
    throw Error(Cause::bad_input, plan_.scene->place(setting.stage->pointer + "/until"),
                "there is no energy to watch, since " + energy.unknown,
                {"end the stage by \"at_rest\" or by duration"});
  }
  state_.equilibrium.note(state_.stage_step, agree_(energy.sum), agree_(energy.magnitude) + solver.slight_energy(),
                          plan_.scene->equilibrium.rate * setting.units.time);
}

template void StageCourse::look(core::Solver<float>&);
template void StageCourse::look(core::Solver<float, core::D3Q19>&);
template void StageCourse::look(core::Solver<double>&);
template void StageCourse::look(core::Solver<double, core::D3Q19>&);

long StageCourse::next() const {
  const scene::Stage& stage = *setting().stage;
  long next = setting().max_steps;
  if (stage.until_at_rest) next = std::min(next, state_.rest_watch.end(rest_window()));
  if (stage.until_equilibrium) {
    const bool reached = state_.equilibrium.reached();
    next = std::min(next, reached ? state_.stage_step + 1 : state_.equilibrium.next(energy_window()));
  }
  return next;
}

long StageCourse::steps_of(double seconds) const { return std::max(1L, std::lround(setting().steps_of(seconds))); }

}  // namespace rouleau::run
