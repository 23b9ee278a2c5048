// The tasks of a step that are about cells, in two dimensions.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "any_cell_tasks.hpp"
#include "cell_exchange.hpp"
#include "core/contact/interactions.hpp"
#include "core/contact/wall_contacts.hpp"
#include "core/coupling/coupling.hpp"
#include "core/coupling/slip_correction.hpp"
#include "core/coupling/viscosity_field.hpp"
#include "core/fluid/fluid.hpp"
#include "core/membrane/membranes.hpp"
#include "core/membrane/motion.hpp"
#include "schedule.hpp"
#include "solver_setup.hpp"
#include "surroundings.hpp"

namespace rouleau::core {

/// What a solver does with its cells: outlines, their forces, and what couples them to the fluid.
template <class T>
class OutlineTasks final : public AnyCellTasks<2> {
 public:
  using Cells = Membranes;

  /// The setup, the membranes, of which there is at least one, and the fluid belong to the solver, and outlive this.
  /// `ghosts`: this rank's part in the membranes, which these know of; null without other ranks.
  OutlineTasks(const SolverSetup& setup, Membranes& membranes, Fluid<T>& fluid, std::optional<GhostCells<2>> ghosts);

  /// Adds what a step of these cells takes.
  void describe(StepFeatures& features) const;
  /// A worker's share of a task of schedule.hpp that is not one over rows; what the fluid does alone is left out.
  void run(Task task, Worker worker);
  /// Pass over rows of the block.
  void spread(Range rows) {
    coupling_.spread(rows, membranes_, slip_correction_ ? slip_correction_->forces() : membranes_.forces(),
                     fluid_.force());
  }
  [[nodiscard]] WallForces<2> wall_share() const override {
    return coupling_.wall_share(membranes_, slip_correction_ ? slip_correction_->forces() : membranes_.forces(),
                                ranks_);
  }
  /// The frame of the fluid's unsteady term gets the cells' velocity, as far as the walls allow, if the setup wants that.
  void follow(const std::array<double, 3>& velocity);
  void end_messages() override {
    if (exchange_) exchange_->receive_positions(membranes_, viscosity_field_.watch());
  }
  [[nodiscard]] Surroundings<2> surroundings() override {
    end_messages();
    return exchange_ ? Surroundings<2>(membranes_, *exchange_) : Surroundings<2>(membranes_);
  }
  [[nodiscard]] const GhostCells<2>* ghosts() const override { return exchange_ ? &exchange_->ghosts() : nullptr; }
  [[nodiscard]] std::vector<BoundingBox<2>> boxes_of_all() override {
    end_messages();
    return exchange_->boxes_of_all(membranes_);
  }
  DisplacementWatch::Memory pass_on(const GhostCells<2>& next) override {
    exchange_->pass_on(membranes_, viscosity_field_.watch(), next);
    return std::move(viscosity_field_.watch().memory());
  }
  /// Mean velocity of all ranks' nodes, which must ask together.
  [[nodiscard]] std::array<double, 3> mean_velocity() const { return core::mean_velocity(membranes_, ranks_); }
  /// Between two steps: as a solver was whose viscosity field was last renewed so.
  void restore(DisplacementWatch::Memory viscosity) {
    viscosity_field_.restore(std::move(viscosity), membranes_, fluid_.relaxation_rate(), fluid_.mask());
    forget_unknown();
  }

  [[nodiscard]] int escaped_node() const override { return coupling_.escaped(membranes_); }
  [[nodiscard]] bool escaped() const override {
    return exchange_ ? exchange_->escaped() : coupling_.any_escaped(membranes_);
  }
  [[nodiscard]] MembraneEnergy membrane_energy() override { return membrane_forces_.energies(membranes_, ranks_); }
  [[nodiscard]] std::vector<double> tensions(int cell) override { return membrane_forces_.tensions(membranes_, cell); }
  /// And to bend them by as much.
  [[nodiscard]] double slight_energy() const override;
  [[nodiscard]] bool corrects_motion() const override { return slip_correction_ || setup_.area_correction; }
  [[nodiscard]] const DisplacementWatch::Memory& viscosity_memory() const override { return viscosity_field_.memory(); }
  [[nodiscard]] std::array<double, 2> force_from_walls() const override {
    return {wall_contacts_ ? wall_contacts_->net_force(membranes_, ranks_) : 0, 0};
  }
  [[nodiscard]] double force_across_images(int cell) const override {
    return interactions_ ? interactions_->force_across_images(cell) : 0;
  }
  [[nodiscard]] std::vector<InteractionEnergy> interaction_energies() const override {
    return energies_of(membranes_, ranks_, interactions_, wall_contacts_);
  }

 private:
  /// What this rank does not know takes no memory.
  void forget_unknown();
  [[nodiscard]] std::unique_ptr<SlipCorrection> make_slip_correction() const;
  [[nodiscard]] MembraneForcesSetup forces_setup() const;
  [[nodiscard]] std::vector<double> viscosity_ratios() const;
  [[nodiscard]] typename CellExchange<2>::Parts parts();
  void locate(Worker worker, Whose whose);

  const SolverSetup& setup_;
  Membranes& membranes_;
  Fluid<T>& fluid_;
  Ranks<2> ranks_;
  std::unique_ptr<CellExchange<2>> exchange_;  ///< null without other ranks
  std::unique_ptr<SlipCorrection> slip_correction_;
  MembraneForces membrane_forces_;
  std::unique_ptr<Interactions<2>> interactions_;
  std::unique_ptr<WallContacts<2>> wall_contacts_;
  ViscosityField<T> viscosity_field_;
  Coupling<T> coupling_;
};

extern template class OutlineTasks<float>;
extern template class OutlineTasks<double>;

}  // namespace rouleau::core
