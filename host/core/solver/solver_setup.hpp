// All that a simulation is made of, as plain values in lattice units.
#pragma once

#include <memory>
#include <vector>

#include "core/contact/contact_law.hpp"
#include "core/coupling/kernel_kind.hpp"
#include "core/domain/domain.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/fluid/openings/opening.hpp"
#include "core/fluid/relaxation.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/fluid/walls.hpp"
#include "core/membrane/membrane_forces.hpp"
#include "core/model/model.hpp"
#include "external_forces.hpp"

namespace rouleau::core {

struct CellType {
  /// They add up.
  MembraneLaws laws;
  /// Inside over the suspending fluid's.
  double viscosity_ratio = 1;
};

/// In D dimensions: two or three. Lattice units: spacing, time step and density of the fluid
/// are 1.
template <int D>
struct BasicSolverSetup {
  /// Along x periodic; along y and z periodic, or between walls; or along one axis between openings.
  Domain<D> domain = {};
  /// Of an x that is not periodic. Cells come and go between steps (AnySolver::renew_cells): their nodes stay so far
  /// from openings that no stencil of the kernel reaches beyond.
  Openings openings = {};
  /// Walls of any shape, beside those across y and z: the region of the fluid, with images along periodic axes, and the
  /// domain's nodes outside of it; null: none. `wall_time`: of a step, in the unit of their velocities; 0: they rest.
  RegionPointer<D> region = {};
  std::shared_ptr<const SolidNodes<D>> solid = {};
  double wall_time = 0;
  /// Area of their walls, in two dimensions length, that the mean stress on them is of; 0: not known.
  double wall_area = 0;
  /// From wall to wall at the widest place, which a mean velocity is kept by; 0: the domain's height.
  double width = 0;
  /// Relaxation time of the suspending fluid in time steps; its kinematic viscosity is (tau - 1/2)/3.
  double tau = 1;
  /// Parts of the suspending fluid with another viscosity, which do not move. With cells, neither the semi-implicit
  /// step nor the slip correction: both know of one viscosity.
  std::vector<Layer> layers = {};
  /// Quadratic equilibrium; false: linear, for creeping flow.
  bool inertia = false;
  /// Without inertia: the unsteady term is seen from a frame that moves with the cells, on average (moving_frame.hpp).
  bool follow_cells = false;
  WallVelocity walls = {};
  /// Force density everywhere.
  double body_force_x = 0, body_force_y = 0, body_force_z = 0;
  /// Added to the walls and the body force.
  Oscillation oscillation = {};
  /// Mean velocity along x of the fluid nodes, between walls at rest, that the body force is adapted to keep, from
  /// body_force_x on; 0: the force is what it is.
  double mean_velocity = 0;
  /// Begin with the developed flow of the walls, the body force and, between plane walls across y alone, their
  /// oscillation; false: with a fluid at rest, or the one before.
  bool developed = false;
  /// That flow in a section across x between walls of any shape; empty: it is not known.
  SectionFlow section_flow = {};
  CollisionOperator collision = {};

  KernelKind kernel = KernelKind::peskin4;
  /// What Membranes::cells name as their types.
  std::vector<CellType> cell_types = {};
  std::vector<Interaction> interactions = {};
  /// Only between walls.
  std::vector<WallInteraction> wall_interactions = {};
  std::vector<SelfInteraction> self_interactions = {};
  /// Whether any of these changes in the course of the setup.
  [[nodiscard]] bool strengths_change() const {
    const auto any = [](const auto& list) {
      return std::any_of(list.begin(), list.end(), [](const auto& each) { return each.strength.changes(); });
    };
    return any(interactions) || any(wall_interactions) || any(self_interactions);
  }
  /// On cells, from outside.
  ExternalForces<D> external = {};
  /// The step of stiff membranes (SemiImplicitFilter, SurfaceFilter).
  bool semi_implicit = false;
  /// Takes the tangential slip of the immersed boundary out.
  bool slip_correction = false;
  /// Keeps the areas that cells enclose, in three dimensions their volumes.
  bool area_correction = false;
  /// Strain of the flow in a step, a magnitude: what leaked is forgotten over a strain of one; 0: never.
  double strain_per_step = 0;

  /// Time step in any unit that all setups of a run share: velocities carried from one to the next scale with it.
  double time_step = 1;
  /// SI size of the lattice unit of tension, for state that is carried from one setup to the next.
  double tension_unit = 1;

  [[nodiscard]] double viscosity() const { return viscosity_of(tau); }
};
using SolverSetup = BasicSolverSetup<2>;

}  // namespace rouleau::core
