// What a run computes with: the cells and, stage after stage, a solver that goes on with them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "checkpoint.hpp"
#include "core/domain/decomposition.hpp"
#include "core/solver/any_solver.hpp"
#include "plan/solver_setup.hpp"

namespace rouleau::run {

/// In D dimensions, what one rank has of it. All ranks call it together, each with the same.
template <int D>
class Engine {
 public:
  using Cells = typename core::AnySolver<D>::Cells;
  /// What the next solver is made from. This rank's part in the cells is known, and they are there.
  struct Start {
    core::BasicSolverSetup<D> setup;
    std::optional<core::GhostCells<D>> part;  ///< none without ranks
    std::optional<core::SolverState> state;   ///< to go on from; none: from the solver before, or the setup's beginning
  };

  /// No cells yet, and no solver. The plan outlives it. `owner`: of the cells when a stage begins (core::GhostCells).
  explicit Engine(const plan::Plan& plan, const core::Ranks<D>& ranks = {}, std::vector<int> owner = {})
      : plan_(plan), walls_(plan::lattice_walls<D>(*plan.scene)), ranks_(ranks), owner_(std::move(owner)) {}

  /// The cells as the scene places them, of which the observer takes note, for the first stage.
  [[nodiscard]] Start place_cells(observe::Observer& observer);
  /// The cells as a checkpoint has them; the run's state is set to what it says, and `mark` to how far the directory's
  /// files had come. Throws Error(input_output) where it does not fit.
  [[nodiscard]] Start restore_cells(const std::shared_ptr<const files::CheckpointReader>& reader, RunState& state,
                                    files::DirectoryMark& mark);
  /// A solver takes the place of the one before.
  void begin(Start start);
  /// The same for another stage, which goes on with cells and fluid of the one before.
  void begin_stage(int stage);
  /// Between two steps, whose messages have been taken: these cells go, and others come, each with its nodes as it is
  /// alone.
  struct Arrival {
    int cell;
    Cells nodes;
  };
  void change_cells(const std::vector<int>& gone, const std::vector<Arrival>& come);
  /// Between two steps, whose messages have been taken: other blocks for the same state, so many steps after the
  /// stage's start.
  /// `seconds[r]`: what rank r has computed for since all began to measure.
  void cut_again(int stage, long stage_step, const std::vector<double>& seconds);

  [[nodiscard]] core::AnySolver<D>& solver() { return *solver_; }
  [[nodiscard]] const core::AnySolver<D>& solver() const { return *solver_; }
  [[nodiscard]] Cells& cells() { return cells_; }
  [[nodiscard]] const Cells& cells() const { return cells_; }
  [[nodiscard]] const core::Ranks<D>& ranks() const { return ranks_; }

 private:
  using Boxes = std::vector<core::BoundingBox<D>>;
  /// With the part that this rank has in cells with these boxes.
  [[nodiscard]] Start prepare(int stage, const Boxes& boxes, std::vector<int> owner) const;
  /// None without ranks or cells.
  [[nodiscard]] Boxes boxes_of_all();
  /// The cells that are there, in their order; the same on all ranks.
  [[nodiscard]] std::vector<int> present() const;
  /// Owners for all cells, nobody for those that are not there: who is given, beyond the end by place.
  [[nodiscard]] std::vector<int> owners(const Boxes& boxes, const std::vector<int>& there,
                                        const std::vector<int>& given) const;
  /// What this rank computes of the lattice.
  [[nodiscard]] core::Domain<D> domain() const;

  const plan::Plan& plan_;
  plan::LatticeWalls<D> walls_;  ///< of all stages
  core::Ranks<D> ranks_;
  std::vector<int> owner_;
  std::unique_ptr<const core::Decomposition<D>> blocks_;  ///< that ranks_ has, once they have been cut again
  Cells cells_;
  std::unique_ptr<core::AnySolver<D>> solver_;  ///< of the present stage
};

}  // namespace rouleau::run
