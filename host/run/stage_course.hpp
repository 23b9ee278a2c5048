// The course of a stage, step by step: what has been taken of it, and when its scene ends it.
#pragma once

#include <optional>

#include "core/solver/any_solver.hpp"
#include "plan/plan.hpp"
#include "run_state.hpp"

namespace rouleau::run {

/// Of whichever stage of the plan the state is in. Whoever steps calls count_to() and then end() before the forces of a
/// step that next() has asked for, and look() once they are known; ending() may be asked for at any time between two
/// steps. All ranks call it together, and get the same.
class StageCourse {
 public:
  /// Both must outlive it.
  StageCourse(const plan::Plan& plan, RunState& state) : plan_(plan), state_(state) {}

  [[nodiscard]] const scene::StageSetting& setting() const { return plan_.stages[state_.stage]; }
  [[nodiscard]] bool is_last() const { return state_.stage + 1 == static_cast<int>(plan_.stages.size()); }

  /// The stage begins.
  template <int D>
  void begin(const core::AnySolver<D>& solver);
  /// So many steps of the stage have been taken.
  void count_to(long step) {
    state_.stage_step = step;
    state_.steps = state_.steps_before + step;
  }
  /// What ends the stage here: at_rest, equilibrium, mean, parted, strain, duration or none.
  template <int D>
  [[nodiscard]] Ending ending(const core::AnySolver<D>& solver) const;
  /// The same, before the forces of a step: where a window of rest is over the next one begins.
  template <int D>
  Ending end(const core::AnySolver<D>& solver);
  /// Forces computed, and outputs of this step, if it has some, written: what they say, and the energy of the cells,
  /// where the stage ends by these and a window is over. Throws Error(bad_input) where the energy is unknown.
  template <int D>
  void look(core::AnySolver<D>& solver, bool has_outputs);
  /// The next step, after look(), at which the stage may end.
  [[nodiscard]] long next() const;

  /// The present step, time and strain: of a monitor::Failure or an observe::Snapshot.
  template <class What>
  void date(What& what) const {
    what.step = state_.steps;
    what.time = state_.time_at(setting());
    what.strain = state_.strain_at(setting());
  }

 private:
  /// Whether a window of rest is over.
  [[nodiscard]] bool compares_positions() const;
  /// What the outputs written so far end the stage by: mean, parted or none.
  template <int D>
  [[nodiscard]] Ending by_outputs(const core::AnySolver<D>& solver) const;
  [[nodiscard]] long steps_of(double seconds) const;
  [[nodiscard]] long rest_window() const { return steps_of(plan_.scene->at_rest.window); }
  [[nodiscard]] long energy_window() const { return steps_of(plan_.scene->equilibrium.window); }

  const plan::Plan& plan_;
  RunState& state_;
  std::optional<Ending> by_outputs_;  ///< since the last output; none: not looked for yet
};

}  // namespace rouleau::run
