// The tasks of a step that are about cells, in three dimensions.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "any_cell_tasks.hpp"
#include "cell_exchange.hpp"
#include "core/contact/interactions.hpp"
#include "core/contact/wall_contacts.hpp"
#include "core/coupling/interior_field.hpp"
#include "core/coupling/surface_coupling.hpp"
#include "core/coupling/surface_slip.hpp"
#include "core/domain/ranks.hpp"
#include "core/fluid/fluid.hpp"
#include "core/membrane/motion.hpp"
#include "core/surface/surface_forces.hpp"
#include "core/surface/surface_normals.hpp"
#include "schedule.hpp"
#include "solver_setup.hpp"
#include "surroundings.hpp"

namespace rouleau::core {

/// What a solver does with its cells: closed surfaces, their forces, and what couples them to the fluid.
template <class T>
class SurfaceTasks final : public AnyCellTasks<3> {
 public:
  using Cells = Surfaces;

  /// The setup, the surfaces, of which there is at least one, and the fluid belong to the solver, and outlive this.
  /// `ghosts`: this rank's part in the surfaces, which these know of; null without other ranks.
  SurfaceTasks(const BasicSolverSetup<3>& setup, Surfaces& surfaces, Fluid<T, D3Q19>& fluid,
               std::optional<GhostCells<3>> ghosts);

  /// Adds what a step of these cells takes.
  void describe(StepFeatures& features) const {
    features.cells = true;
    features.interactions = interactions_ != nullptr;
    features.wall_interactions = wall_contacts_ != nullptr;
    features.slip_correction = slip_ != nullptr;
    features.area_correction = keeps_volumes_;
  }
  /// A worker's share of a task of schedule.hpp that is not one over rows; what the fluid does alone is left out.
  void run(Task task, Worker worker);
  /// Pass over rows of the block.
  void spread(Range rows) {
    coupling_.spread(rows, surfaces_, slip_ ? slip_->forces() : surfaces_.forces(), fluid_.force());
  }
  [[nodiscard]] WallForces<3> wall_share() const override {
    return coupling_.wall_share(surfaces_, slip_ ? slip_->forces() : surfaces_.forces(), fluid_.setting().solid.get(),
                                ranks_);
  }
  /// The fluid's unsteady term has no frame in three dimensions.
  void follow(const std::array<double, 3>&) {}
  void end_messages() override {
    if (exchange_) exchange_->receive_positions(surfaces_, viscosity_field_.watch());
  }
  [[nodiscard]] Surroundings<3> surroundings() override {
    end_messages();
    return exchange_ ? Surroundings<3>(surfaces_, *exchange_) : Surroundings<3>(surfaces_);
  }
  [[nodiscard]] const GhostCells<3>* ghosts() const override { return exchange_ ? &exchange_->ghosts() : nullptr; }
  [[nodiscard]] std::vector<BoundingBox<3>> boxes_of_all() override {
    end_messages();
    return exchange_->boxes_of_all(surfaces_);
  }
  DisplacementWatch::Memory pass_on(const GhostCells<3>& next) override {
    exchange_->pass_on(surfaces_, viscosity_field_.watch(), next);
    return std::move(viscosity_field_.watch().memory());
  }
  /// Mean velocity of all ranks' nodes, which must ask together.
  [[nodiscard]] std::array<double, 3> mean_velocity() const { return core::mean_velocity(surfaces_, ranks_); }
  /// Between two steps: as a solver was whose relaxation rates were last renewed so.
  void restore(DisplacementWatch::Memory viscosity) {
    viscosity_field_.restore(std::move(viscosity), surfaces_, fluid_.relaxation_rate(), fluid_.mask());
    forget_unknown();
  }

  [[nodiscard]] int escaped_node() const override { return coupling_.escaped(surfaces_); }
  [[nodiscard]] bool escaped() const override {
    return exchange_ ? exchange_->escaped() : coupling_.any_escaped(surfaces_);
  }
  [[nodiscard]] MembraneEnergy membrane_energy() override { return forces_.energies(surfaces_, ranks_); }
  [[nodiscard]] std::vector<double> tensions(int cell) override { return forces_.tensions(surfaces_, cell); }
  /// Along x, the volume law left aside.
  [[nodiscard]] double slight_energy() const override { return slight_energy_; }
  [[nodiscard]] bool corrects_motion() const override { return slip_ || keeps_volumes_; }
  [[nodiscard]] const DisplacementWatch::Memory& viscosity_memory() const override { return viscosity_field_.memory(); }
  [[nodiscard]] std::array<double, 2> force_from_walls() const override {
    if (!wall_contacts_) return {};
    return {wall_contacts_->net_force(surfaces_, ranks_), wall_contacts_->net_force(surfaces_, ranks_, 2)};
  }
  [[nodiscard]] double force_across_images(int cell) const override {
    return interactions_ ? interactions_->force_across_images(cell) : 0;
  }
  [[nodiscard]] std::vector<InteractionEnergy> interaction_energies() const override {
    return energies_of(surfaces_, ranks_, interactions_, wall_contacts_);
  }

 private:
  /// What this rank does not know takes no memory.
  void forget_unknown();
  /// Pass over cells: where the nodes touch the lattice.
  void locate(Worker worker, Whose whose);
  [[nodiscard]] typename CellExchange<3>::Parts parts();

  Surfaces& surfaces_;
  Fluid<T, D3Q19>& fluid_;
  SurfaceForces forces_;
  std::unique_ptr<Interactions<3>> interactions_;
  std::unique_ptr<WallContacts<3>> wall_contacts_;
  bool keeps_volumes_;                       ///< else they are left to the coupling
  double strain_per_step_;                   ///< of the flow
  std::unique_ptr<SurfaceNormals> normals_;  ///< null: nothing is corrected
  std::unique_ptr<SurfaceSlip> slip_;        ///< null: membranes slip
  InteriorField<T> viscosity_field_;
  SurfaceCoupling<T> coupling_;
  Ranks<3> ranks_;
  std::unique_ptr<CellExchange<3>> exchange_;  ///< null without other ranks
  double slight_energy_ = 0;
};

extern template class SurfaceTasks<float>;
extern template class SurfaceTasks<double>;

}  // namespace rouleau::core
