// The simulator: fluid, membranes and what couples them, stepped by any number of workers.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "core/fluid/fluid.hpp"
#include "flow_control.hpp"
#include "outline_tasks.hpp"
#include "pass.hpp"
#include "schedule.hpp"
#include "solver_setup.hpp"
#include "surface_tasks.hpp"

namespace rouleau::core {

/// A solver between two steps, as far as setup and membranes do not tell it.
template <class T>
struct SolverState {
  /// Before the next collision, of each velocity q: of the block's nodes, row after row. Asked for once each, so that
  /// they need not all be in memory.
  std::function<std::vector<T>(int q)> populations;
  bool walls_have_acted = false;
  /// Taken since the setup's start: what oscillates goes by them.
  long steps = 0;
  /// Where a mean velocity is kept.
  std::optional<FlowControl::State> flow_control = {};
  /// When the viscosity field was last renewed; without cells there is none.
  DisplacementWatch::Memory viscosity = {};
};

/// Everything that one setup computes with. Cells belong to the caller and outlive it: the next setup of a run goes on
/// with them.
///
/// T: of the populations; Set: D2Q9 or D3Q19.
template <class T, class Set = D2Q9>
class Solver {
 public:
  static constexpr int dimension = Set::dimension;
  using Setup = BasicSolverSetup<dimension>;
  using CellTasks = std::conditional_t<dimension == 2, OutlineTasks<T>, SurfaceTasks<T>>;
  using Cells = typename CellTasks::Cells;

  /// The fluid is at rest until start(); `cells` must outlive the solver. Throws std::invalid_argument for a setup
  /// without nodes or collision operator, and for cells with what their dimension does not have.
  /// `ranks`: who computes the other blocks, if the domain's block is not the whole lattice.
  /// `ghosts`: of these ranks, with at least ghost_reach(setup): what this one is to know of the cells, of which no more is
  /// read; none: it is given all of every cell, and owners are found by place.
  Solver(Setup setup, Cells& cells, const Ranks<dimension>& ranks = {},
         std::optional<GhostCells<dimension>> ghosts = {});

  /// The fluid that the setup asks for: developed, or what `former` left (null: there was none), rescaled with the time
  /// step: velocities and density deviations of the same flow scale like it. The nodes' velocities with it.
  void start(Solver* former = nullptr);
  /// Goes on from where a solver of this setup and these membranes was.
  void start(SolverState<T> state);

  /// Takes time steps with one worker. Between steps nodes are where the last step has moved them to.
  void step(long count = 1);
  /// Ranks are done with the messages of the last step; who calls passes() calls this between two steps before all ranks
  /// speak of something else. The other workers may have begun with the next step.
  void end_messages() {
    if (cell_tasks_) cell_tasks_->end_messages();
  }
  /// The two halves of a step, with one worker: forces at the present positions, after which the state may be observed;
  /// then fluid, interpolation and motion.
  void compute_forces();
  void advance();

  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] Fluid<T, Set>& fluid() { return fluid_; }
  /// Where the state may be observed, on all ranks: what acts on the walls, the fluid in the last step (Fluid::wall_forces)
  /// and membranes beside them by the forces that they have now; and the shear stresses of that (Fluid::wall_stress).
  [[nodiscard]] WallForces<dimension> wall_forces() const {
    WallForces<dimension> forces = fluid_.wall_forces();
    if (cell_tasks_) forces += cell_tasks_->wall_share();
    return forces;
  }
  [[nodiscard]] typename Fluid<T, Set>::WallStress wall_stress() const;
  [[nodiscard]] const Cells& cells() const { return cells_; }
  /// What is done with the cells; null without any.
  [[nodiscard]] CellTasks* cell_tasks() { return cell_tasks_.get(); }
  [[nodiscard]] const CellTasks* cell_tasks() const { return cell_tasks_.get(); }
  /// Who computes the other blocks.
  [[nodiscard]] const Ranks<dimension>& ranks() const { return fluid_.ranks(); }
  /// None where no mean velocity is kept.
  [[nodiscard]] const std::optional<FlowControl>& flow_control() const { return flow_control_; }
  /// A step, for several workers. Before pass [observable_pass()], after a barrier, the state may be observed; who does
  /// not want to runs the passes from rows_pass() on without a stop.
  [[nodiscard]] const std::vector<Pass>& passes() const { return passes_; }
  [[nodiscard]] std::vector<std::string> pass_names() const { return core::pass_names(features()); }
  [[nodiscard]] std::size_t rows_pass() const { return rows_pass_; }
  [[nodiscard]] std::size_t observable_pass() const { return observable_pass_; }
  /// How this step cuts rows.
  [[nodiscard]] RowBands bands() const;
  /// Whether a node has left the domain, on any rank; and which, of this rank's cells; -1: none.
  [[nodiscard]] bool escaped() const { return cell_tasks_ && cell_tasks_->escaped(); }
  [[nodiscard]] int escaped_node() const { return cell_tasks_ ? cell_tasks_->escaped_node() : -1; }
  /// What it takes to stretch all membranes by 0.1 %: energies far below this are rounding. Lattice units.
  [[nodiscard]] double slight_energy() const { return cell_tasks_ ? cell_tasks_->slight_energy() : 0; }

 private:
  [[nodiscard]] StepFeatures features() const;
  /// The fluid is driven as an oscillation wants it in the step that begins after so many.
  void oscillate(long steps);
  /// The force that keeps the mean velocity, from what this is now.
  void keep_mean_velocity();
  void run(Task task, Worker worker);
  void run_rows(Task task, Range rows);
  void run_alone(std::size_t first, std::size_t last);

  Setup setup_;
  Cells& cells_;
  Fluid<T, Set> fluid_;
  std::unique_ptr<CellTasks> cell_tasks_;
  long steps_ = 0;  ///< taken since start()
  std::optional<FlowControl> flow_control_;
  std::vector<Pass> passes_;
  std::size_t rows_pass_ = 0, observable_pass_ = 0;
};

extern template class Solver<float>;
extern template class Solver<double>;
extern template class Solver<float, D3Q19>;
extern template class Solver<double, D3Q19>;

}  // namespace rouleau::core
