// Cells that come in through an inlet and leave through an outlet, while a scene is stepped.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine.hpp"
#include "inflow.hpp"
#include "run_state.hpp"
#include "stepper.hpp"

namespace rouleau::run {

/// Who comes and who goes, between two steps: a cell that is due comes as soon as there is room behind the inlet; a
/// cell that has come near an opening goes. All ranks ask together, and get the same.
template <int D>
class Traffic {
 public:
  using Arrival = typename Engine<D>::Arrival;
  struct Departure {
    int cell, end, opening;  ///< through the lower end, 0, or the upper one, 1, and which opening there
  };
  struct Change {
    std::vector<Departure> gone;
    std::vector<Arrival> come;
    [[nodiscard]] bool any() const { return !gone.empty() || !come.empty(); }
  };

  /// All outlive it. The state has no cells but those that are placed, until it is restored.
  Traffic(const plan::Plan& plan, Engine<D>& engine, RunState& state);

  /// Before the forces of a step: whether any come or go, if it is time to look.
  [[nodiscard]] bool due();
  /// Whether that was so, and is still to be done.
  [[nodiscard]] bool found() const { return change_.any(); }
  /// How many have come in after so long, s, or wait for room.
  [[nodiscard]] int due_by(double time) { return inflow().due(time, state_.traffic.cells.come_in()); }
  /// Between steps, where there are openings: what has flowed through them is known from now on.
  void measure();
  /// What due() has found is done.
  Change take();
  /// The step of the stage at which it looks again.
  [[nodiscard]] long next() const { return is_open() ? state_.traffic.next - state_.steps_before : Stepper::never; }

 private:
  [[nodiscard]] long steps_to_next() const;
  [[nodiscard]] bool is_open() const { return observe::has_traffic(*plan_.scene); }
  [[nodiscard]] const Inflow<D>& inflow();
  /// Which opening of an end a cell is in front of: its first node that is in front of any.
  [[nodiscard]] int opening_at(int end, const core::Cells<D>& cells, const core::CellRange& cell);
  void find_gone();
  void find_come(double time);
  /// The first of these places that is free on all ranks; none: none is.
  [[nodiscard]] std::optional<typename Engine<D>::Cells> free_place(int cell, double time);
  /// How far each cell can move along the open axis, at most so far, before it comes too near another one on any rank.
  [[nodiscard]] std::vector<double> ways(const std::vector<typename Engine<D>::Cells>& cells, std::vector<double> most);

  const plan::Plan& plan_;
  Engine<D>& engine_;
  RunState& state_;
  std::vector<double> content_;      ///< m3, or m2, of a cell of each type
  std::optional<Inflow<D>> inflow_;  ///< made when first asked for
  int of_stage_ = 0;
  std::array<std::vector<int>, 2> parts_of_ends_;  ///< core::parts_of_ends; empty until first asked for
  int looks_in_vain_ = 0;  ///< one after another, in which no place was tried: all were too near a wall
  Change change_;
};

}  // namespace rouleau::run
