// The passes of one time step: fluid, membranes and what couples them, in the order of the step.
#pragma once

#include <memory>
#include <vector>

#include "core/contact/interaction_forces.hpp"
#include "core/coupling/coupling.hpp"
#include "core/coupling/slip_correction.hpp"
#include "core/coupling/viscosity_field.hpp"
#include "core/fluid/fluid.hpp"
#include "core/membrane/membrane_forces.hpp"
#include "core/membrane/membranes.hpp"
#include "pass.hpp"
#include "plan/plan.hpp"

namespace rouleau::solver {

/// Everything that lives for one stage; membranes belong to the run and outlive it.
template <class T>
class Solver {
 public:
  Solver(const plan::Plan& plan, int stage, membrane::Membranes& membranes);

  /// The fluid that the stage begins with: the developed flow between its walls if the stage asks for it, else what the
  /// stage before left (null: there was none), rescaled with the time step: velocities and density deviations of the
  /// same flow scale like the density factor. The nodes' velocities with it.
  void start(Solver* former);

  [[nodiscard]] fluid::Fluid<T>& fluid() { return fluid_; }
  /// Null without cells.
  [[nodiscard]] const coupling::Indicator<T>* indicator() const { return indicator_.get(); }
  /// Relaxation rate and activity as they were at a checkpoint, between two steps; nothing to do without cells.
  void restore_indicator(const membrane::DisplacementWatch::Memory& memory) {
    if (indicator_) indicator_->restore(memory, membranes_, fluid_.relaxation_rate(), fluid_.activity());
  }
  [[nodiscard]] const plan::StageSetting& setting() const { return *setting_; }
  /// Force and spreading at the present positions; after them and a barrier the state may be observed.
  [[nodiscard]] const std::vector<Pass>& forces() const { return forces_; }
  /// Fluid, interpolation, motion: from one step to the next.
  [[nodiscard]] const std::vector<Pass>& advance() const { return advance_; }
  /// Whether a node has left the domain, and which; -1: none.
  [[nodiscard]] bool escaped() const { return coupling_ && coupling_->any_escaped(); }
  [[nodiscard]] int escaped_node() const { return coupling_ ? coupling_->escaped() : -1; }
  /// Tension of every segment at the present positions, lattice units.
  void tensions(std::vector<double>& tension) const;
  /// Nodes move otherwise than the lattice's fluid at their places does.
  [[nodiscard]] bool corrects_motion() const { return slip_correction_ || keeps_areas_; }
  /// Null where the scene has no cells, or no active interaction.
  [[nodiscard]] membrane::MembraneForces* membrane_forces() { return membrane_forces_.get(); }
  /// What it takes to stretch all membranes by 0.1 %: energies far below this are rounding. Lattice units.
  [[nodiscard]] double slight_energy() const { return slight_energy_; }
  [[nodiscard]] const contact::InteractionForces* interaction_forces() const { return interaction_forces_.get(); }

 private:
  void plan_cell_passes(const plan::Plan& plan);
  void find_slight_energy(const std::vector<membrane::MembraneLaws>& laws);
  void plan_corrections(const plan::Plan& plan, const std::vector<membrane::MembraneLaws>& laws);
  void plan_spreading(const plan::Plan& plan);
  void plan_advance();
  void locate(Worker worker);

  const plan::StageSetting* setting_;
  membrane::Membranes& membranes_;
  fluid::Fluid<T> fluid_;
  std::unique_ptr<membrane::MembraneForces> membrane_forces_;
  std::unique_ptr<contact::InteractionForces> interaction_forces_;
  std::unique_ptr<coupling::Coupling<T>> coupling_;
  std::unique_ptr<coupling::SlipCorrection> slip_correction_;
  std::unique_ptr<coupling::Indicator<T>> indicator_;
  bool keeps_areas_ = false;
  double slight_energy_ = 0;
  std::string indicator_name_;
  std::vector<Pass> forces_, advance_;
};

extern template class Solver<float>;
extern template class Solver<double>;

}  // namespace rouleau::solver
