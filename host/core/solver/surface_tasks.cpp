#include "surface_tasks.hpp"

#include <cmath>

#include "core/membrane/motion.hpp"
#include "core/membrane/stiffness.hpp"
#include "core/surface/volume_correction.hpp"
#include "ghost_reach.hpp"

namespace rouleau::core {

namespace {

std::vector<MembraneLaws> laws_of(const BasicSolverSetup<3>& setup) {
  std::vector<MembraneLaws> laws;
  for (const CellType& type : setup.cell_types) laws.push_back(type.laws);
  return laws;
}

std::vector<double> ratios_of(const BasicSolverSetup<3>& setup) {
  std::vector<double> ratios;
  for (const CellType& type : setup.cell_types) ratios.push_back(type.viscosity_ratio);
  return ratios;
}

std::unique_ptr<SurfaceSlip> make_slip(const BasicSolverSetup<3>& setup, const Surfaces& surfaces) {
  if (!setup.slip_correction) return nullptr;
  std::vector<SurfaceSlip::Type> types;
  for (const CellType& type : setup.cell_types) {
    double stretching = 0;
    for (const MembraneLaw& law : type.laws) stretching += stretching_stiffness(law);
    types.push_back({slip_constants(setup.kernel, type.viscosity_ratio, 3), stretching});
  }
  return std::make_unique<SurfaceSlip>(surfaces, std::move(types), setup.viscosity());
}

/// How each type's membranes come back to their own forces.
std::vector<KernelResponse> responses_of(const BasicSolverSetup<3>& setup) {
  std::vector<KernelResponse> responses;
  for (const double ratio : ratios_of(setup)) {
    const double shift = setup.slip_correction ? slip_constants(setup.kernel, ratio, 3).shift : 0;
    responses.push_back(kernel_response(setup.kernel, shift));
  }
  return responses;
}

/// Second difference of a type's energy when its shape is stretched along x.
double energy_of_strain(const std::shared_ptr<const RestSurface>& rest, const MembraneLaws& laws, double strain) {
  MembraneLaws without_volume;
  for (const MembraneLaw& law : laws) {
    if (!law.reads("volume")) without_volume.push_back(law);
  }
  Surfaces one;
  one.types = {rest};
  add_cell(one, 0, Vec<3>::Zero());
  SurfaceForces forces(one, {without_volume});
  double sum = -2 * forces.energy(one);
  for (const double side : {-1.0, 1.0}) {
    Surfaces strained = one;
    for (double& x : strained.position[0]) x *= 1 + side * strain;
    sum += forces.energy(strained);
  }
  return std::abs(sum) / 2;
}

}  // namespace

template <class T>
SurfaceTasks<T>::SurfaceTasks(const BasicSolverSetup<3>& setup, Surfaces& surfaces, Fluid<T, D3Q19>& fluid,
                              std::optional<GhostCells<3>> ghosts)
    : surfaces_(surfaces),
      fluid_(fluid),
      forces_(surfaces, laws_of(setup)),
      keeps_volumes_(setup.area_correction),
      strain_per_step_(setup.strain_per_step),
      slip_(make_slip(setup, surfaces)),
      viscosity_field_(surfaces, ratios_of(setup), 1 / setup.tau, setup.domain, fluid.setting().viscosity_of_rows,
                       slip_ ? ViscosityMean::harmonic : ViscosityMean::arithmetic, extra_reach(setup),
                       smooths_edges(setup.kernel, 3)),
      coupling_(setup.kernel, setup.domain),
      ranks_(fluid.ranks()) {
  surfaces_.largest_step.resize(surfaces_.cells.size(), 0.0);
  if (setup.semi_implicit)
    forces_.take_semi_implicit_steps(surfaces_, setup.viscosity(), setup.tension_unit, responses_of(setup));
  std::vector<double> of_type;
  for (std::size_t t = 0; t < surfaces.types.size(); ++t)
    of_type.push_back(energy_of_strain(surfaces.types[t], setup.cell_types[t].laws, 1e-3));
  for (const CellRange& cell : surfaces.cells) slight_energy_ += of_type[cell.type];
  if (!setup.interactions.empty() || !setup.self_interactions.empty()) {
    interactions_ =
        std::make_unique<Interactions<3>>(surfaces_, setup.interactions, setup.domain, setup.self_interactions);
  }
  if (!setup.wall_interactions.empty())
    wall_contacts_ =
        std::make_unique<WallContacts<3>>(surfaces_, setup.wall_interactions, setup.domain, setup.tube_radius);
  if (corrects_motion()) normals_ = std::make_unique<SurfaceNormals>(surfaces_);
  if (keeps_volumes_) surfaces_.area_leakage.resize(surfaces_.cells.size(), 0.0);  // earlier leakage stays
  coupling_.reserve(surfaces_);
  if (ghosts) {
    exchange_ =
        std::make_unique<CellExchange<3>>(*std::move(ghosts), interactions_ && interactions_->needs_velocities());
  }
  for (const Whose whose : {Whose::own, Whose::others}) locate(Worker{}, whose);
  forget_unknown();
}

template <class T>
void SurfaceTasks<T>::run(Task task, Worker worker) {
  switch (task) {
    case Task::find_contacts:
      return interactions_->run(worker, 0, surfaces_);
    case Task::membrane_forces:
      return forces_.run(worker, surfaces_);
    case Task::wall_forces:
      return wall_contacts_->run(worker, surfaces_);
    case Task::interaction_forces:
      return interactions_->run(worker, 1, surfaces_);
    case Task::take_reactions:
      return interactions_->run(worker, 2, surfaces_);
    case Task::complete_forces:
      if (keeps_volumes_) take_out_pressures(worker, surfaces_, *normals_);
      if (slip_) slip_->complete(worker, surfaces_, *normals_);
      return;
    case Task::find_nodes:
      viscosity_field_.measure(worker, surfaces_);
      return viscosity_field_.cover(worker, surfaces_);
    case Task::set_viscosity:
      if (viscosity_field_.due()) viscosity_field_.update(worker, surfaces_, fluid_.relaxation_rate(), fluid_.mask());
      return;
    case Task::interpolate:
      return coupling_.interpolate(worker, surfaces_, fluid_.velocity(), Whose::own_at_borders);
    case Task::interpolate_inside:
      return coupling_.interpolate(worker, surfaces_, fluid_.velocity(), Whose::own_inside);
    case Task::interpolate_ghosts:
      return coupling_.interpolate(worker, surfaces_, fluid_.velocity(), Whose::others);
    case Task::correct_velocities:
      if (slip_) slip_->correct(worker, surfaces_, *normals_);
      if (keeps_volumes_) keep_volumes(worker, surfaces_, *normals_, strain_per_step_);
      return;
    case Task::move:
      return core::move_nodes(worker, surfaces_);
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
CellExchange<3>::Parts SurfaceTasks<T>::parts() {
  return {.cells = surfaces_,
          .interactions = interactions_.get(),
          .viscosity = viscosity_field_.watch(),
          .force = slip_ ? slip_->forces_of_all()
                         : std::array{surfaces_.force[0].data(), surfaces_.force[1].data(), surfaces_.force[2].data()},
          .base = [this](int node) { return coupling_.base(node); },
          .escaped = [this] { return coupling_.any_escaped(surfaces_); }};
}

template <class T>
void SurfaceTasks<T>::forget_unknown() {
  if (!exchange_) return;
  const std::vector<Range> nodes = surfaces_.unknown_nodes();
  if (nodes.empty()) return;
  surfaces_.forget(nodes);
  viscosity_field_.watch().forget(surfaces_, nodes);
  coupling_.forget(nodes);
  if (normals_) normals_->forget(surfaces_, nodes);
  if (slip_) slip_->forget(nodes);
  if (interactions_) interactions_->forget(surfaces_, nodes);
}

template <class T>
void SurfaceTasks<T>::locate(Worker worker, Whose whose) {
  if (normals_ && (slip_ || whose == Whose::own)) normals_->measure(worker, surfaces_, whose);
  if (slip_) slip_->measure(worker, surfaces_, *normals_, whose);
  coupling_.locate(worker, surfaces_, slip_ ? slip_->positions() : surfaces_.positions(), whose);
}

template class SurfaceTasks<float>;
template class SurfaceTasks<double>;

}  // namespace rouleau::core
