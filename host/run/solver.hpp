// The passes of one time step: fluid, membranes and what couples them, in the order of the step.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cell/coupling.hpp"
#include "cell/indicator.hpp"
#include "cell/interaction_forces.hpp"
#include "cell/membrane_forces.hpp"
#include "cell/membranes.hpp"
#include "fluid/fluid.hpp"
#include "plan.hpp"
#include "worker.hpp"

namespace rouleau::host {

/// One pass: every worker runs its share, a barrier follows.
struct Pass {
  std::string name;
  std::function<void(Worker)> run;
};

/// What moving the nodes found, for checks that cost nothing.
struct StepResult {
  double largest_step = 0;  ///< largest displacement of a node in the step, lattice spacings; NaN if any is
  int node = -1;            ///< whose
};

/// Everything that lives for one stage; membranes belong to the run and outlive it.
template <class T>
class Solver {
 public:
  Solver(const Plan& plan, int stage, Membranes& membranes);

  [[nodiscard]] Fluid<T>& fluid() { return fluid_; }
  [[nodiscard]] const StageSetting& setting() const { return *setting_; }
  /// Force and spreading at the present positions; after them the state may be observed.
  [[nodiscard]] const std::vector<Pass>& forces() const { return forces_; }
  /// Fluid, interpolation, motion: from one step to the next.
  [[nodiscard]] const std::vector<Pass>& advance() const { return advance_; }
  [[nodiscard]] StepResult last_step() const;
  /// Node outside the domain, or -1.
  [[nodiscard]] int escaped_node() const { return coupling_ ? coupling_->escaped() : -1; }
  /// Tension of every segment at the present positions, lattice units.
  void tensions(std::vector<double>& tension) const;

 private:
  void plan_forces(const Plan& plan);
  void plan_advance();
  void move(Worker worker);

  const StageSetting* setting_;
  Membranes& membranes_;
  Fluid<T> fluid_;
  std::unique_ptr<MembraneForces> membrane_forces_;
  std::unique_ptr<InteractionForces> interaction_forces_;
  std::unique_ptr<Coupling<T>> coupling_;
  std::unique_ptr<Indicator<T>> indicator_;
  std::vector<Pass> forces_, advance_;
  std::vector<StepResult> cell_step_;  ///< of each cell, with the square of its largest step
};

extern template class Solver<float>;
extern template class Solver<double>;

}  // namespace rouleau::host
