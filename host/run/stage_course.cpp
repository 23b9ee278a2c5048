#include "stage_course.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "observe/energy.hpp"

namespace rouleau::run {

namespace {

/// Which cells are whose; null: all are this rank's.
template <class T, class Set>
const core::GhostCells<Set::dimension>* ghosts(const core::Solver<T, Set>& solver) {
  return solver.cell_tasks() != nullptr ? solver.cell_tasks()->ghosts() : nullptr;
}

}  // namespace

template <class T, class Set>
void StageCourse::begin(const core::Solver<T, Set>& solver) {
  state_.observer.start_stage();
  state_.stage_step = 0;
  state_.steps_before = state_.steps;
  state_.stage_wall = 0;
  state_.rest_watch.stop();
  if (setting().stage->until_at_rest) state_.rest_watch.start(0, solver.cells(), ghosts(solver));
  state_.equilibrium.start();
}

bool StageCourse::compares_positions() const {
  return setting().stage->until_at_rest && state_.stage_step >= state_.rest_watch.end(rest_window());
}

template <class T, class Set>
Ending StageCourse::ending(const core::Solver<T, Set>& solver) const {
  const scene::Stage& stage = *setting().stage;
  if (compares_positions()) {
    const double moved = state_.rest_watch.moved(solver.cells(), ghosts(solver));
    if (core::of_first(solver.ranks(), moved) < plan_.scene->at_rest.displacement / setting().units.length)
      return Ending::at_rest;
  }
  if (stage.until_equilibrium && state_.equilibrium.reached()) return Ending::equilibrium;
  if (state_.stage_step < setting().max_steps) return Ending::none;
  const bool by_strain =
      stage.strain && (!stage.duration || *stage.strain / std::abs(stage.shear_rate) <= *stage.duration);
  return by_strain ? Ending::strain : Ending::duration;
}

template <class T, class Set>
Ending StageCourse::end(const core::Solver<T, Set>& solver) {
  const Ending found = ending(solver);
  // The window by which a stage has ended stays: a checkpoint of this step ends it again.
  if (found == Ending::none && compares_positions())
    state_.rest_watch.start(state_.stage_step, solver.cells(), ghosts(solver));
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
  state_.equilibrium.note(state_.stage_step, energy.sum, energy.magnitude + solver.slight_energy(),
                          plan_.scene->equilibrium.rate * setting.units.time);
}

#define ROULEAU_INSTANTIATE(T, Set)                                       \
  template void StageCourse::begin(const core::Solver<T, Set>&);          \
  template Ending StageCourse::ending(const core::Solver<T, Set>&) const; \
  template Ending StageCourse::end(const core::Solver<T, Set>&);          \
  template void StageCourse::look(core::Solver<T, Set>&);
ROULEAU_INSTANTIATE(float, core::D2Q9)
ROULEAU_INSTANTIATE(double, core::D2Q9)
ROULEAU_INSTANTIATE(float, core::D3Q19)
ROULEAU_INSTANTIATE(double, core::D3Q19)
#undef ROULEAU_INSTANTIATE

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
