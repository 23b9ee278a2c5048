// The simulator: fluid, membranes and what couples them, stepped by any number of workers.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "cell_exchange.hpp"
#include "core/coupling/coupling.hpp"
#include "core/coupling/slip_correction.hpp"
#include "core/coupling/viscosity_field.hpp"
#include "core/fluid/fluid.hpp"
#include "core/membrane/membranes.hpp"
#include "flow_control.hpp"
#include "pass.hpp"
#include "schedule.hpp"
#include "solver_setup.hpp"

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

/// Everything that one setup computes with. Membranes belong to the caller and outlive it: the next setup of a run goes
/// on with them.
///
/// T: of the populations; Set: D2Q9 or, without cells, D3Q19.
template <class T, class Set = D2Q9>
class Solver {
 public:
  static constexpr int dimension = Set::dimension;
  using Setup = BasicSolverSetup<dimension>;

  /// The fluid is at rest until start(); `membranes` must outlive the solver. Throws
  /// std::invalid_argument for a setup without nodes or collision operator, and for cells in three dimensions.
  /// `ranks`: who computes the other blocks, if the domain's block is not the whole lattice, and `owner[c]` the rank of
  /// cell c; none: by place. Every rank is given all cells.
  Solver(Setup setup, Membranes& membranes, const Ranks<dimension>& ranks = {}, std::vector<int> owner = {});

  /// The fluid that the setup asks for: developed, or what `former` left (null: there was none), rescaled with the time
  /// step: velocities and density deviations of the same flow scale like it. The nodes' velocities with it.
  void start(Solver* former = nullptr);
  /// Goes on from where a solver of this setup and these membranes was.
  void start(const SolverState<T>& state);

  /// Takes time steps with one worker. Between steps nodes are where the last step has moved them to.
  void step(long count = 1);
  /// The two halves of a step, with one worker: forces at the present positions, after which the state may be observed;
  /// then fluid, interpolation and motion.
  void compute_forces();
  void advance();

  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] Fluid<T, Set>& fluid() { return fluid_; }
  [[nodiscard]] const Membranes& membranes() const { return membranes_; }
  /// Who computes the other blocks.
  [[nodiscard]] const Ranks<dimension>& ranks() const { return fluid_.ranks(); }
  /// One worker, between steps or where the state may be observed: tells all ranks what only the owners of cells know.
  void share_state() {
    if (exchange_) exchange_->share_state(membranes_);
  }
  /// None where no mean velocity is kept.
  [[nodiscard]] const std::optional<FlowControl>& flow_control() const { return flow_control_; }
  /// Null without cells.
  [[nodiscard]] const ViscosityField<T>* viscosity_field() const { return viscosity_field_.get(); }
  /// A step, for several workers. Before pass [observable_pass()], after a barrier, the state may be observed; who does
  /// not want to runs the passes from rows_pass() on without a stop.
  [[nodiscard]] const std::vector<Pass>& passes() const { return passes_; }
  [[nodiscard]] std::size_t rows_pass() const { return rows_pass_; }
  [[nodiscard]] std::size_t observable_pass() const { return observable_pass_; }
  /// How this step cuts rows.
  [[nodiscard]] RowBands bands() const;
  /// Whether a node has left the domain, and which; -1: none.
  [[nodiscard]] bool escaped() const { return coupling_ && coupling_->any_escaped(); }
  [[nodiscard]] int escaped_node() const { return coupling_ ? coupling_->escaped() : -1; }
  /// Tension of every segment at the present positions, lattice units.
  void tensions(std::vector<double>& tension) const;
  /// Nodes move otherwise than the lattice's fluid at their places does.
  [[nodiscard]] bool corrects_motion() const { return slip_correction_ || setup_.area_correction; }
  /// Null without cells.
  [[nodiscard]] MembraneForces* membrane_forces() { return membrane_forces_.get(); }
  /// What it takes to stretch all membranes by 0.1 %: energies far below this are rounding. Lattice units.
  [[nodiscard]] double slight_energy() const { return slight_energy_; }
  /// Null without cells or interactions.
  [[nodiscard]] const InteractionForces* interaction_forces() const { return interaction_forces_.get(); }
  /// Null without cells or interactions with walls.
  [[nodiscard]] const WallContacts* wall_contacts() const { return wall_contacts_.get(); }
  [[nodiscard]] const SelfContacts* self_contacts() const { return self_contacts_.get(); }

 private:
  [[nodiscard]] StepFeatures features() const;
  // What follows of cells does nothing in three dimensions, which have none yet.
  void make_cells();
  void make_slip_correction();
  /// The frame of the fluid's unsteady term gets the cells' velocity, as far as the walls allow, if the setup wants that.
  void follow_cells(const std::array<double, 2>& velocity);
  /// The fluid is driven as an oscillation wants it in the step that begins after so many.
  void oscillate(long steps);
  /// The force that keeps the mean velocity, from what this is now.
  void keep_mean_velocity();
  void run(Task task, Worker worker);
  void run_cells(Task task, Worker worker);
  void run_rows(Task task, Range rows);
  void exchange(Task task);
  void run_alone(std::size_t first, std::size_t last);
  void locate(Worker worker);

  Setup setup_;
  Membranes& membranes_;
  Fluid<T, Set> fluid_;
  std::unique_ptr<CellExchange> exchange_;  ///< null without other ranks
  std::unique_ptr<SlipCorrection> slip_correction_;
  std::unique_ptr<MembraneForces> membrane_forces_;
  std::unique_ptr<InteractionForces> interaction_forces_;
  std::unique_ptr<WallContacts> wall_contacts_;
  std::unique_ptr<SelfContacts> self_contacts_;
  std::unique_ptr<ViscosityField<T>> viscosity_field_;
  std::unique_ptr<Coupling<T>> coupling_;
  double slight_energy_ = 0;
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
