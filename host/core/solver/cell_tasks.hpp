// The tasks of a step that are about cells.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "any_cell_tasks.hpp"
#include "cell_exchange.hpp"
#include "cell_methods.hpp"
#include "core/contact/interactions.hpp"
#include "core/contact/wall_contacts.hpp"
#include "core/coupling/coupling.hpp"
#include "core/coupling/viscosity_field.hpp"
#include "core/domain/ranks.hpp"
#include "core/fluid/fluid.hpp"
#include "core/membrane/motion.hpp"
#include "core/surface/surface_normals.hpp"
#include "schedule.hpp"
#include "solver_setup.hpp"
#include "surroundings.hpp"

namespace rouleau::core {

/// What a solver does with its cells: their forces, and what couples them to the fluid. T: of the populations.
template <class T, int D>
class CellTasks final : public AnyCellTasks<D> {
 public:
  using Fluid = core::Fluid<T, std::conditional_t<D == 2, D2Q9, D3Q19>>;

  /// The setup, the cells, of which there is at least one, and the fluid belong to the solver, and outlive this.
  /// `ghosts`: this rank's part in the cells, which these know of; none without other ranks.
  CellTasks(const BasicSolverSetup<D>& setup, Cells<D>& cells, Fluid& fluid, std::optional<GhostCells<D>> ghosts);

  /// Adds what a step of these cells takes.
  void describe(StepFeatures& features) const;
  /// A worker's share of a task of schedule.hpp that is not one over rows; what the fluid does alone is left out.
  void run(Task task, Worker worker);
  /// Pass over rows of the block.
  void spread(Range rows) { coupling_.spread(rows, cells_, spread_forces(), fluid_.force()); }
  [[nodiscard]] WallForces<D> wall_share() const override {
    return coupling_.wall_share(cells_, spread_forces(), ranks_);
  }
  /// The frame of the fluid's unsteady term gets the cells' velocity, as far as the walls allow, if the setup wants
  /// that.
  void follow(const std::array<double, 3>& velocity);
  void end_messages() override {
    if (exchange_) exchange_->receive_positions(cells_, viscosity_field_.watch());
  }
  [[nodiscard]] Surroundings<D> surroundings() override {
    end_messages();
    return exchange_ ? Surroundings<D>(cells_, *exchange_) : Surroundings<D>(cells_);
  }
  [[nodiscard]] const GhostCells<D>* ghosts() const override { return exchange_ ? &exchange_->ghosts() : nullptr; }
  [[nodiscard]] std::vector<BoundingBox<D>> boxes_of_all() override {
    end_messages();
    return exchange_->boxes_of_all(cells_);
  }
  DisplacementWatch::Memory pass_on(const GhostCells<D>& next) override {
    exchange_->pass_on(cells_, viscosity_field_.watch(), next);
    return std::move(viscosity_field_.watch().memory());
  }
  /// Mean velocity of all ranks' nodes, which must ask together.
  [[nodiscard]] std::array<double, 3> mean_velocity() const { return core::mean_velocity(cells_, ranks_); }
  /// Between two steps: as a solver was whose viscosity field was last renewed so.
  void restore(DisplacementWatch::Memory viscosity) {
    viscosity_field_.restore(std::move(viscosity), cells_, fluid_.relaxation_rate(), fluid_.mask());
    forget_unknown();
  }

  [[nodiscard]] int escaped_node() const override { return coupling_.escaped(cells_); }
  [[nodiscard]] bool escaped() const override {
    return exchange_ ? exchange_->escaped() : coupling_.any_escaped(cells_);
  }
  [[nodiscard]] std::optional<BeyondWall> beyond_wall() const override {
    return region_border_ ? find_beyond_wall<D>(cells_, *region_border_) : std::nullopt;
  }
  [[nodiscard]] MembraneEnergy membrane_energy() override { return forces_.energies(cells_, ranks_); }
  [[nodiscard]] std::vector<double> tensions(int cell) override { return forces_.tensions(cells_, cell); }
  [[nodiscard]] double slight_energy() const override { return slight_energy_; }
  [[nodiscard]] bool corrects_motion() const override { return slip_ || setup_.area_correction; }
  [[nodiscard]] const DisplacementWatch::Memory& viscosity_memory() const override { return viscosity_field_.memory(); }
  [[nodiscard]] std::array<double, 3> force_from_outside() const override {
    const auto [x, y, z, power] = external_sums();
    std::array<double, 3> force{x, y, z};
    for (int k = setup_.region ? 0 : 1; k < D && wall_contacts_; ++k)  // planes lie along x
      force[static_cast<std::size_t>(k)] += wall_contacts_->net_force(cells_, ranks_, k);
    return force;
  }
  [[nodiscard]] std::array<double, 4> external_sums() const override {
    return setup_.external.any() ? setup_.external.sums(cells_, ranks_) : std::array<double, 4>{};
  }
  [[nodiscard]] std::array<double, 4> force_across_images(int cell) const override {
    return interactions_ ? interactions_->force_across_images(cell) : std::array<double, 4>{};
  }
  [[nodiscard]] std::vector<InteractionEnergy> interaction_energies() const override {
    return this->energies_of(cells_, ranks_, interactions_, wall_contacts_);
  }

  /// Before a step: so many after the setup's start.
  void set_time(double time) {
    if (interactions_) interactions_->set_time(time);
    if (wall_contacts_) wall_contacts_->set_time(time);
  }
  [[nodiscard]] std::vector<PairEnergy> pair_energies() const override {
    return interactions_ ? interactions_->pair_energies(cells_) : std::vector<PairEnergy>{};
  }

 private:
  /// What is spread: forces on the nodes, or what a correction makes of them.
  [[nodiscard]] std::array<const double*, D> spread_forces() const { return slip_ ? slip_->forces() : cells_.forces(); }
  /// Calls a correction of the cells with what it reads.
  template <class Correct>
  void correct(Correct correct) {
    if constexpr (D == 2) correct(cells_);
    if constexpr (D == 3) correct(cells_, *normals_);
  }
  /// What this rank does not know takes no memory.
  void forget_unknown();
  /// Pass over cells: where the nodes touch the lattice.
  void locate(Worker worker, Whose whose);
  [[nodiscard]] typename CellExchange<D>::Parts parts();

  const BasicSolverSetup<D>& setup_;
  Cells<D>& cells_;
  Fluid& fluid_;
  Ranks<D> ranks_;
  std::unique_ptr<CellExchange<D>> exchange_;            ///< null without other ranks
  std::unique_ptr<typename CellMethods<D>::Slip> slip_;  ///< null: membranes slip
  typename CellMethods<D>::Forces forces_;
  double slight_energy_;
  std::unique_ptr<Interactions<D>> interactions_;
  std::unique_ptr<WallContacts<D>> wall_contacts_;
  std::unique_ptr<const NearBorder<D>> region_border_;  ///< null without a region
  std::unique_ptr<SurfaceNormals> normals_;             ///< of surfaces that something is corrected of
  ViscosityField<T, D> viscosity_field_;
  Coupling<T, D> coupling_;
};

extern template class CellTasks<float, 2>;
extern template class CellTasks<double, 2>;
extern template class CellTasks<float, 3>;
extern template class CellTasks<double, 3>;

}  // namespace rouleau::core
