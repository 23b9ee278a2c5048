// The simulator as who steps it, observes it and stores its state sees it, whatever the precision of its populations.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "any_cell_tasks.hpp"
#include "core/fluid/any_fluid.hpp"
#include "flow_control.hpp"
#include "pass.hpp"
#include "solver_setup.hpp"

namespace rouleau::core {

/// A solver between two steps, as far as setup and cells do not tell it.
struct SolverState {
  /// Before the next collision, of each velocity q, exact: of the block's nodes, row after row. Asked for once each, so
  /// that they need not all be in memory.
  std::function<std::vector<double>(int q)> populations;
  bool walls_have_acted = false;
  LinkMemory links = {};  ///< without solid nodes none
  /// Taken since the setup's start: what oscillates goes by them.
  long steps = 0;
  /// Where a mean velocity is kept.
  std::optional<FlowControl::State> flow_control = {};
  /// When the viscosity field was last renewed; without cells there is none.
  DisplacementWatch::Memory viscosity = {};
};

/// Everything that one setup of D dimensions computes with. Cells belong to the caller and outlive it: the next setup
/// of a run goes on with them.
template <int D>
class AnySolver {
 public:
  static constexpr int dimension = D;
  using Setup = BasicSolverSetup<D>;
  using Cells = typename CellExchange<D>::Cells;

  virtual ~AnySolver() = default;

  /// The fluid that the setup asks for: developed, or what `former` left (null: there was none), rescaled with the time
  /// step: velocities and density deviations of the same flow scale like it. The nodes' velocities with it. `former` is
  /// of the same precision.
  virtual void start(AnySolver* former = nullptr) = 0;
  /// Goes on from where a solver of this setup and these cells was.
  virtual void start(SolverState state) = 0;

  /// Between two steps, when cells have come or gone (CellNodes::part). The fluid stays as it is. `ghosts`: of ranks,
  /// what this one is to know of the cells, of which no more is read; none without other ranks.
  virtual void renew_cells(std::optional<GhostCells<D>> ghosts) = 0;

  /// Takes time steps with one worker. Between steps nodes are where the last step has moved them to.
  void step(long count = 1);
  /// The two halves of a step, with one worker: forces at the present positions, after which the state may be observed;
  /// then fluid, interpolation and motion.
  void compute_forces();
  void advance();
  /// A step, for several workers. Who takes it calls end_messages() between two steps before all ranks speak of
  /// something else than steps: ranks are done with the messages of the last one then. The other workers may have begun
  /// with the next step.
  [[nodiscard]] const StepPasses& passes() const { return passes_; }
  void end_messages() {
    if (auto* const tasks = cell_tasks()) tasks->end_messages();
  }

  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] virtual AnyFluid<D>& fluid() = 0;
  [[nodiscard]] virtual const AnyFluid<D>& fluid() const = 0;
  [[nodiscard]] const Cells& cells() const { return cells_; }
  /// What is done with the cells; null without any.
  [[nodiscard]] virtual AnyCellTasks<D>* cell_tasks() = 0;
  [[nodiscard]] virtual const AnyCellTasks<D>* cell_tasks() const = 0;
  /// Who computes the other blocks.
  [[nodiscard]] const Ranks<D>& ranks() const { return fluid().ranks(); }
  /// Which cells are whose; null: all are this rank's.
  [[nodiscard]] const GhostCells<D>* ghosts() const {
    return cell_tasks() != nullptr ? cell_tasks()->ghosts() : nullptr;
  }
  /// None where no mean velocity is kept.
  [[nodiscard]] const std::optional<FlowControl>& flow_control() const { return flow_control_; }
  /// Where the state may be observed, on all ranks: what acts on the walls, the fluid in the last step
  /// (AnyFluid::wall_forces) and membranes beside them by the forces that they have now; and the shear stresses of that
  /// (AnyFluid::wall_stress).
  [[nodiscard]] WallForces<D> wall_forces() const;
  [[nodiscard]] typename AnyFluid<D>::WallStress wall_stress() const { return mean_wall_stress(wall_forces()); }
  [[nodiscard]] typename AnyFluid<D>::WallStress mean_wall_stress(const WallForces<D>& forces) const;
  /// Whether a node has left the domain, on any rank; and which, of this rank's cells; -1: none.
  [[nodiscard]] bool escaped() const { return cell_tasks() != nullptr && cell_tasks()->escaped(); }
  [[nodiscard]] int escaped_node() const { return cell_tasks() != nullptr ? cell_tasks()->escaped_node() : -1; }
  /// What it takes to stretch all membranes by 0.1 %: energies far below this are rounding. Lattice units.
  [[nodiscard]] double slight_energy() const { return cell_tasks() != nullptr ? cell_tasks()->slight_energy() : 0; }

 protected:
  AnySolver(Setup setup, Cells& cells) : setup_(std::move(setup)), cells_(cells) {}

  Setup setup_;
  Cells& cells_;
  std::optional<FlowControl> flow_control_;
  StepPasses passes_;

 private:
  void run_alone(std::size_t first, std::size_t last);
};

/// A solver of that precision (Solver).
template <int D>
std::unique_ptr<AnySolver<D>> make_solver(bool single_precision, BasicSolverSetup<D> setup,
                                          typename AnySolver<D>::Cells& cells, const Ranks<D>& ranks = {},
                                          std::optional<GhostCells<D>> ghosts = {});

}  // namespace rouleau::core
