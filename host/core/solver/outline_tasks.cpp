#include "outline_tasks.hpp"

#include <algorithm>
#include <numbers>

#include "core/membrane/area_correction.hpp"
#include "core/membrane/motion.hpp"
#include "core/membrane/stiffness.hpp"

namespace rouleau::core {

namespace {

Stiffness stiffness_of(const MembraneLaws& laws) {
  Stiffness sum;
  for (const MembraneLaw& law : laws) sum += law;
  return sum;
}

}  // namespace

template <class T>
OutlineTasks<T>::OutlineTasks(const SolverSetup& setup, Membranes& membranes, Fluid<T>& fluid,
                              std::optional<GhostCells<2>> ghosts)
    : setup_(setup),
      membranes_(membranes),
      fluid_(fluid),
      ranks_(fluid.ranks()),
      slip_correction_(make_slip_correction()),
      membrane_forces_(membranes, forces_setup()),
      viscosity_field_(membranes, viscosity_ratios(),
                       slip_correction_ ? ViscosityMean::harmonic : ViscosityMean::arithmetic, extra_reach(setup),
                       1 / setup.tau, setup.domain, fluid.setting().viscosity_of_rows, smooths_edges(setup.kernel, 2)),
      coupling_(setup.kernel, setup.domain) {
  membranes_.largest_step.resize(membranes_.cells.size(), 0.0);
  if (setup.area_correction) membranes_.area_leakage.resize(membranes_.cells.size(), 0.0);  // earlier leakage stays
  if (!setup.interactions.empty() || !setup.self_interactions.empty()) {
    interactions_ =
        std::make_unique<Interactions<2>>(membranes_, setup.interactions, setup.domain, setup.self_interactions);
  }
  if (!setup.wall_interactions.empty())
    wall_contacts_ =
        std::make_unique<WallContacts<2>>(membranes_, setup.wall_interactions, setup.domain, setup.tube_radius);
  coupling_.reserve(membranes_);
  if (ghosts) {
    exchange_ =
        std::make_unique<CellExchange<2>>(*std::move(ghosts), interactions_ && interactions_->needs_velocities());
  }
  locate(Worker{}, Whose::own);
  locate(Worker{}, Whose::others);
  forget_unknown();
}

template <class T>
std::unique_ptr<SlipCorrection> OutlineTasks<T>::make_slip_correction() const {
  if (!setup_.slip_correction) return nullptr;
  std::vector<SlipCorrection::Type> types;
  for (const CellType& type : setup_.cell_types) {
    const Stiffness stiffness = stiffness_of(type.laws);
    types.push_back(
        {core::slip_constants(setup_.kernel, type.viscosity_ratio, 2), stiffness.stretching, stiffness.bending});
  }
  return std::make_unique<SlipCorrection>(membranes_, std::move(types), setup_.viscosity());
}

template <class T>
MembraneForcesSetup OutlineTasks<T>::forces_setup() const {
  MembraneForcesSetup forces{.response = kernel_response(setup_.kernel),
                             .semi_implicit = setup_.semi_implicit,
                             .viscosity = setup_.viscosity(),
                             .tension_unit = setup_.tension_unit};
  for (const CellType& type : setup_.cell_types) forces.laws.push_back(type.laws);
  if (slip_correction_) forces.mobility = slip_correction_->mobility();
  return forces;
}

template <class T>
std::vector<double> OutlineTasks<T>::viscosity_ratios() const {
  std::vector<double> ratios;
  for (const CellType& type : setup_.cell_types) ratios.push_back(type.viscosity_ratio);
  return ratios;
}

template <class T>
void OutlineTasks<T>::describe(StepFeatures& features) const {
  features.cells = true;
  features.interactions = interactions_ != nullptr;
  features.wall_interactions = wall_contacts_ != nullptr;
  features.slip_correction = slip_correction_ != nullptr;
  features.area_correction = setup_.area_correction;
}

template <class T>
void OutlineTasks<T>::run(Task task, Worker worker) {
  switch (task) {
    case Task::find_contacts:
      return interactions_->run(worker, 0, membranes_);
    case Task::membrane_forces:
      return membrane_forces_.run(worker, membranes_);
    case Task::wall_forces:
      return wall_contacts_->run(worker, membranes_);
    case Task::interaction_forces:
      return interactions_->run(worker, 1, membranes_);
    case Task::take_reactions:
      return interactions_->run(worker, 2, membranes_);
    case Task::complete_forces:
      if (setup_.area_correction) core::take_out_pressures(worker, membranes_);
      if (slip_correction_) slip_correction_->complete(worker, membranes_);
      return;
    case Task::find_nodes:
      viscosity_field_.measure(worker, membranes_);
      return viscosity_field_.cover(worker, membranes_);
    case Task::follow_cells:
      if (worker.first()) follow(mean_velocity());
      return;
    case Task::set_viscosity:
      if (viscosity_field_.due()) viscosity_field_.update(worker, membranes_, fluid_.relaxation_rate(), fluid_.mask());
      return;
    case Task::interpolate:
      return coupling_.interpolate(worker, membranes_, fluid_.velocity(), Whose::own_at_borders);
    case Task::interpolate_inside:
      return coupling_.interpolate(worker, membranes_, fluid_.velocity(), Whose::own_inside);
    case Task::interpolate_ghosts:
      return coupling_.interpolate(worker, membranes_, fluid_.velocity(), Whose::others);
    case Task::correct_velocities:
      if (slip_correction_) slip_correction_->correct(worker, membranes_);
      if (setup_.area_correction) core::keep_areas(worker, membranes_, setup_.strain_per_step);
      return;
    case Task::move:
      return core::move_nodes(worker, membranes_);
    case Task::locate:
      return locate(worker, Whose::own);
    case Task::locate_ghosts:
      locate(worker, Whose::others);
      if (exchange_->took_over()) locate(worker, Whose::own);
      return;
    default:  // messages; the fluid's own tasks are none
      if (!exchange_ || !worker.first()) return;
      exchange_->run(task, parts());
      if (task == Task::send_positions && exchange_->lost_sight()) forget_unknown();
      return;
  }
}

template <class T>
CellExchange<2>::Parts OutlineTasks<T>::parts() {
  return {.cells = membranes_,
          .interactions = interactions_.get(),
          .viscosity = viscosity_field_.watch(),
          .force = slip_correction_ ? slip_correction_->forces_of_all()
                                    : std::array{membranes_.force[0].data(), membranes_.force[1].data()},
          .base = [this](int node) { return coupling_.base(node); },
          .escaped = [this] { return coupling_.any_escaped(membranes_); }};
}

template <class T>
void OutlineTasks<T>::forget_unknown() {
  if (!exchange_) return;
  const std::vector<Range> nodes = membranes_.unknown_nodes();
  if (nodes.empty()) return;
  membranes_.forget(nodes);
  viscosity_field_.watch().forget(membranes_, nodes);
  coupling_.forget(nodes);
  if (slip_correction_) slip_correction_->forget(nodes);
  if (interactions_) interactions_->forget(membranes_, nodes);
}

template <class T>
void OutlineTasks<T>::follow(const std::array<double, 3>& velocity) {
  if (setup_.follow_cells) fluid_.set_frame(velocity[0], setup_.domain.periodic[1] ? velocity[1] : 0);
}

/// Pass over cells: where the nodes touch the lattice.
template <class T>
void OutlineTasks<T>::locate(Worker worker, Whose whose) {
  if (slip_correction_) slip_correction_->measure(worker, membranes_, whose);
  coupling_.locate(worker, membranes_, slip_correction_ ? slip_correction_->positions() : membranes_.positions(),
                   whose);
}

template <class T>
double OutlineTasks<T>::slight_energy() const {
  constexpr double strain = 1e-3;
  std::vector<Stiffness> of_type;
  of_type.reserve(setup_.cell_types.size());
  for (const CellType& type : setup_.cell_types) of_type.push_back(stiffness_of(type.laws));
  double energy = 0;
  for (const CellRange& cell : membranes_.cells) {
    const double curvature = strain * 2 * std::numbers::pi / cell.rest_perimeter;  // of a circle
    const Stiffness& stiffness = of_type[cell.type];
    energy +=
        (stiffness.stretching * strain * strain + stiffness.bending * curvature * curvature) / 2 * cell.rest_perimeter;
  }
  return energy;
}

template class OutlineTasks<float>;
template class OutlineTasks<double>;

}  // namespace rouleau::core
