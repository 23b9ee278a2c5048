#include "cell_tasks.hpp"

#include "core/membrane/area_correction.hpp"
#include "core/surface/volume_correction.hpp"
#include "ghost_cells.hpp"

namespace rouleau::core {

namespace {

template <int D>
std::vector<double> viscosity_ratios(const BasicSolverSetup<D>& setup) {
  std::vector<double> ratios;
  for (const CellType& type : setup.cell_types) ratios.push_back(type.viscosity_ratio);
  return ratios;
}

}  // namespace

template <class T, int D>
CellTasks<T, D>::CellTasks(const BasicSolverSetup<D>& setup, Cells<D>& cells, Fluid& fluid,
                           std::optional<GhostCells<D>> ghosts)
    : setup_(setup),
      cells_(cells),
      fluid_(fluid),
      ranks_(fluid.ranks()),
      slip_(make_slip(setup, cells)),
      forces_(make_forces(setup, cells, slip_.get())),
      slight_energy_(core::slight_energy(setup, cells)),
      viscosity_field_(cells, viscosity_ratios(setup), slip_ ? ViscosityMean::harmonic : ViscosityMean::arithmetic,
                       extra_reach(setup), 1 / setup.tau, setup.domain, fluid.setting().viscosity_of_rows,
                       smooths_edges(setup.kernel, D)),
      coupling_(setup.kernel, setup.domain, setup.solid.get(), setup.region, setup.wall_time) {
  cells_.largest_step.resize(cells_.cells.size(), 0.0);
  if (setup.area_correction) cells_.area_leakage.resize(cells_.cells.size(), 0.0);  // earlier leakage stays
  if (!setup.interactions.empty() || !setup.self_interactions.empty()) {
    interactions_ =
        std::make_unique<Interactions<D>>(cells_, setup.interactions, setup.domain, setup.self_interactions);
  }
  if (!setup.wall_interactions.empty())
    wall_contacts_ = std::make_unique<WallContacts<D>>(cells_, setup.wall_interactions, setup.domain, setup.region);
  if (setup.region) region_border_ = std::make_unique<const NearBorder<D>>(setup.region, setup.domain, 0);
  if constexpr (D == 3) {
    if (corrects_motion()) normals_ = std::make_unique<SurfaceNormals>(cells_);
  }
  coupling_.reserve(cells_);
  if (ghosts) {
    exchange_ =
        std::make_unique<CellExchange<D>>(*std::move(ghosts), interactions_ && interactions_->needs_velocities());
  }
  for (const Whose whose : {Whose::own, Whose::others}) locate(Worker{}, whose);
  forget_unknown();
}

template <class T, int D>
void CellTasks<T, D>::describe(StepFeatures& features) const {
  features.cells = true;
  features.interactions = interactions_ != nullptr;
  features.wall_interactions = wall_contacts_ != nullptr;
  features.slip_correction = slip_ != nullptr;
  features.area_correction = setup_.area_correction;
}

template <class T, int D>
void CellTasks<T, D>::run(Task task, Worker worker) {
  switch (task) {
    case Task::find_contacts:
      return interactions_->run(worker, 0, cells_);
    case Task::membrane_forces:
      forces_.run(worker, cells_);
      return setup_.external.run(worker, cells_);
    case Task::wall_forces:
      return wall_contacts_->run(worker, cells_);
    case Task::interaction_forces:
      return interactions_->run(worker, 1, cells_);
    case Task::take_reactions:
      return interactions_->run(worker, 2, cells_);
    case Task::complete_forces:
      return correct([&](auto&... of_cells) {
        if (setup_.area_correction) take_out_pressures(worker, of_cells...);
        if (slip_) slip_->complete(worker, of_cells...);
      });
    case Task::find_nodes:
      viscosity_field_.measure(worker, cells_);
      return viscosity_field_.cover(worker, cells_);
    case Task::follow_cells:
      if (worker.first()) follow(mean_velocity());
      return;
    case Task::set_viscosity:
      if (viscosity_field_.due()) viscosity_field_.update(worker, cells_, fluid_.relaxation_rate(), fluid_.mask());
      return;
    case Task::interpolate:
      return coupling_.interpolate(worker, cells_, fluid_.velocity(), Whose::own_at_borders);
    case Task::interpolate_inside:
      return coupling_.interpolate(worker, cells_, fluid_.velocity(), Whose::own_inside);
    case Task::interpolate_ghosts:
      return coupling_.interpolate(worker, cells_, fluid_.velocity(), Whose::others);
    case Task::correct_velocities:
      return correct([&](auto&... of_cells) {
        if (slip_) slip_->correct(worker, of_cells...);
        if (setup_.area_correction) keep_enclosed(worker, of_cells..., setup_.strain_per_step);
      });
    case Task::move:
      return move_nodes(worker, cells_);
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

template <class T, int D>
typename CellExchange<D>::Parts CellTasks<T, D>::parts() {
  return {.cells = cells_,
          .interactions = interactions_.get(),
          .viscosity = viscosity_field_.watch(),
          .force = slip_ ? slip_->forces_of_all() : pointers<D>(cells_.force),
          .base = [this](int node) { return coupling_.base(node); },
          .escaped = [this] { return coupling_.any_escaped(cells_); }};
}

template <class T, int D>
void CellTasks<T, D>::forget_unknown() {
  if (cells_.part.empty()) return;
  const std::vector<Range> nodes = cells_.unknown_nodes();
  if (nodes.empty()) return;
  cells_.forget(nodes);
  viscosity_field_.watch().forget(cells_, nodes);
  coupling_.forget(nodes);
  if constexpr (D == 3) {
    if (normals_) normals_->forget(cells_, nodes);
  }
  if (slip_) slip_->forget(nodes);
  if (interactions_) interactions_->forget(cells_, nodes);
}

template <class T, int D>
void CellTasks<T, D>::follow(const std::array<double, 3>& velocity) {
  if constexpr (D == 2) {  // the fluid has no other frame in three dimensions
    if (setup_.follow_cells) fluid_.set_frame(velocity[0], setup_.domain.periodic[1] ? velocity[1] : 0);
  }
}

template <class T, int D>
void CellTasks<T, D>::locate(Worker worker, Whose whose) {
  if constexpr (D == 3) {
    if (normals_ && (slip_ || whose == Whose::own)) normals_->measure(worker, cells_, whose);
  }
  if (slip_) correct([&](auto&... of_cells) { slip_->measure(worker, of_cells..., whose); });
  coupling_.locate(worker, cells_, slip_ ? slip_->positions() : cells_.positions(), whose);
}

template class CellTasks<float, 2>;
template class CellTasks<double, 2>;
template class CellTasks<float, 3>;
template class CellTasks<double, 3>;

}  // namespace rouleau::core
