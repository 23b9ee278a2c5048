#include "solver.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/fluid/developed_flow.hpp"
#include "core/membrane/motion.hpp"

namespace rouleau::core {

namespace {

template <int D>
bool has_contrast(const BasicSolverSetup<D>& setup, const CellNodes& cells) {
  if (!setup.layers.empty()) return !cells.cells.empty();
  return std::any_of(cells.cells.begin(), cells.cells.end(),
                     [&](const CellRange& cell) { return setup.cell_types[cell.type].viscosity_ratio != 1; });
}

/// A cell's type has laws in the setup and a state of rest among the cells'.
template <int D, class Cells>
void require_types(const BasicSolverSetup<D>& setup, const Cells& cells) {
  if (cells.cells.empty()) return;
  if (cells.types.size() < setup.cell_types.size())
    throw std::invalid_argument("every cell type needs a state of rest");
  for (const CellRange& cell : cells.cells)
    if (cell.type < 0 || cell.type >= static_cast<int>(setup.cell_types.size()))
      throw std::invalid_argument("a cell is of a type that the setup does not have");
}

/// Whether walls close the section of the flow all around: a duct, or a tube.
template <int D>
bool is_enclosed(const BasicSolverSetup<D>& setup) {
  return D == 3 && setup.domain.walled(D - 1);
}

/// What cannot be between openings, yet or at all.
template <int D>
void require_openings(const BasicSolverSetup<D>& setup) {
  const int axis = setup.domain.open_axis;
  if (setup.openings.has_value() != (axis >= 0 && !setup.domain.periodic[axis]) ||
      !(setup.domain.periodic[0] || axis == 0))
    throw std::invalid_argument("a lattice has openings where its open axis is, and is periodic along x else");
  if (!setup.openings) return;
  if (axis > 0 && (setup.walls.lower != 0 || setup.walls.upper != 0))
    throw std::invalid_argument("walls that move along x go with openings along x alone");
  if (setup.domain.size[axis] < 2) throw std::invalid_argument("between two openings there are at least two nodes");
  if (setup.follow_cells) throw std::invalid_argument("between openings the frame does not follow the cells");
  if (setup.developed || setup.mean_velocity != 0)
    throw std::invalid_argument("between openings no developed flow is known to begin with, and no mean velocity kept");
  if (setup.oscillation.any() || !setup.layers.empty())
    throw std::invalid_argument("the flow through an opening knows neither layers nor oscillations");
}

template <int D, class Cells>
FluidSetting<D> fluid_setting(const BasicSolverSetup<D>& setup, const Cells& cells) {
  require_types(setup, cells);
  for (const int nodes : setup.domain.size)
    if (nodes < 1) throw std::invalid_argument("a lattice needs at least one node along every axis");
  require_openings(setup);
  if (is_enclosed(setup) && setup.developed && (setup.oscillation.any() || !setup.layers.empty()))
    throw std::invalid_argument(
        "between walls across z, the developed flow of layers or of an oscillation is not known");
  if (setup.solid && setup.solid->size() != setup.domain.size)
    throw std::invalid_argument("solid nodes are those of the whole lattice");
  if (setup.solid && setup.developed && !setup.section_flow)
    throw std::invalid_argument("the developed flow between these walls is not known");
  if (!setup.layers.empty() && !cells.cells.empty() && (setup.semi_implicit || setup.slip_correction))
    throw std::invalid_argument("cells in layers take neither the semi-implicit step nor the slip correction");
  if (!setup.layers.empty() && setup.developed && setup.oscillation.any())
    throw std::invalid_argument("the developed oscillation of layers is not known");
  if (setup.developed && setup.oscillation.ramp != 0)
    throw std::invalid_argument("what a ramp begins with is not developed");
  if (setup.collision.table == nullptr) throw std::invalid_argument("a fluid needs a collision operator");
  FluidSetting<D> setting{.domain = setup.domain,
                          .relaxation_rate = 1 / setup.tau,
                          .viscosity_of_rows = viscosity_of_rows(setup.layers, setup.domain.size[1]),
                          .inertia = setup.inertia,
                          .walls = setup.walls,
                          .membranes = !cells.cells.empty(),
                          .stencil_above = stencil_above(setup.kernel),
                          .viscosity_contrast = has_contrast(setup, cells),
                          .solid = setup.solid,
                          .wall_time = setup.wall_time,
                          .openings = setup.openings};
  const double body_force[] = {setup.body_force_x, setup.body_force_y, setup.body_force_z};
  std::copy_n(body_force, D, setting.body_force.begin());
  return setting;
}

/// Of a fluid without layers that the same force drives through a channel at the same mean velocity.
template <int D>
double channel_viscosity(const BasicSolverSetup<D>& setup) {
  if (setup.layers.empty()) return setup.viscosity();
  const double height = setup.domain.size[1];
  double sum = 0;
  for (const ProfilePoint& point :
       layered_profile(viscosity_of_rows(setup.layers, setup.domain.size[1]), setup.viscosity(), {}, 1))
    sum += point.velocity;
  return height * height * height / (12 * sum);
}

/// The developed flow of a duct or a tube.
template <class T>
void set_section_flow(Fluid<T, D3Q19>& fluid, const BasicSolverSetup<3>& setup) {
  const auto& size = setup.domain.size;
  const double force = setup.body_force_x / setup.viscosity();
  const DuctFlow duct{static_cast<double>(size[1]), static_cast<double>(size[2]), setup.walls, force};
  std::array<int, 2> known{-1, -1};  // a row has one velocity
  SectionPoint point;
  fluid.set_state([&](int, int y, int z) {
    if (known != std::array{y, z}) {
      const double from_y = y - (size[1] - 1) / 2.0, from_z = z - (size[2] - 1) / 2.0;
      point = setup.section_flow ? setup.section_flow(from_y, from_z, force) : duct.at(from_y, from_z);
      known = {y, z};
    }
    typename Fluid<T, D3Q19>::State state{};
    state.velocity[0] = point.velocity;
    state.gradient[1] = point.slope_y, state.gradient[2] = point.slope_z;
    return state;
  });
}

}  // namespace

template <class T, class Set>
Solver<T, Set>::Solver(Setup setup, Cells& cells, const Ranks<dimension>& ranks,
                       std::optional<GhostCells<dimension>> ghosts)
    : Any(std::move(setup), cells), fluid_(fluid_setting(setup_, cells), setup_.collision, ranks) {
  if (!cells.cells.empty()) {
    if (ranks.several()) {
      if (!ghosts) ghosts.emplace(ranks, boxes_of<dimension>(cells), ghost_reach(setup_));
      ghosts->set_parts(cells);
    }
    cell_tasks_ = std::make_unique<CellTasks>(setup_, cells_, fluid_, std::move(ghosts));
  }
  if (setup_.mean_velocity != 0) {
    if (!setup_.domain.walled(1) && !setup_.solid) throw std::invalid_argument("a mean velocity is kept between walls");
    flow_control_.emplace(setup_.mean_velocity, setup_.body_force_x, channel_viscosity(setup_),
                          setup_.width > 0 ? setup_.width : setup_.domain.size[1]);
  }
  make_passes();
}

template <class T, class Set>
void Solver<T, Set>::make_passes() {
  const bool ranks = fluid_.ranks().several();
  StepFeatures features{
      .viscosity_contrast = fluid_.setting().viscosity_contrast,
      .moving_frame = setup_.follow_cells,
      .changing_drive = setup_.oscillation.any() || flow_control_.has_value(),
      .changing_forces = cell_tasks_ != nullptr && (!setup_.external.pulls.empty() || setup_.strengths_change()),
      .uneven_rows = !fluid_.fluid_below().empty(),
      .ranks = ranks};
  if (cell_tasks_) cell_tasks_->describe(features);
  const Schedule schedule = make_schedule(features);
  for (const Step& step : schedule.steps) {
    Pass& pass = passes_.passes.emplace_back(Pass{.name = step.name, .run = {}, .meeting = step.meeting});
    if (over_rows(step.task)) {
      pass.run_rows = [this, task = step.task](Range rows) { run_rows(task, rows); };
      if (step.task == Task::collide_and_stream && ranks) pass.after_ends = [this] { fluid_.begin_halo_of_ends(); };
    } else {
      pass.run = [this, task = step.task](Worker worker) { run(task, worker); };
    }
  }
  passes_.rows = schedule.rows;
  passes_.observable = schedule.observable;
  passes_.bands = [this] { return bands(); };
  passes_.names = pass_names(features);
}

template <class T, class Set>
void Solver<T, Set>::run(Task task, Worker worker) {
  switch (task) {
    case Task::set_drive:
      if (!worker.first()) return;
      oscillate(steps_);
      setup_.external.steps = steps_;
      if (setup_.strengths_change()) cell_tasks_->set_time(static_cast<double>(steps_));
      if (flow_control_ && flow_control_->due(steps_)) this->end_messages(), keep_mean_velocity();
      return;
    case Task::end_step:
      if (worker.first()) fluid_.end_step(), ++steps_;
      return;
    case Task::send_halo:
      if (worker.first()) fluid_.begin_halo();
      return;
    case Task::receive_halo:
      if (worker.first()) fluid_.end_halo();
      return;
    default:
      return cell_tasks_->run(task, worker);
  }
}

template <class T, class Set>
void Solver<T, Set>::run_rows(Task task, Range rows) {
  if (task == Task::clear_force)
    fluid_.clear_force(rows);
  else if (task == Task::spread)
    cell_tasks_->spread(rows);
  else
    fluid_.step(rows);
}

template <class T, class Set>
RowBands Solver<T, Set>::bands() const {
  // Force and velocity of a band's active nodes should stay in a cache of this size until they have been used; about
  // ten of the lattice are active for one of a membrane. A node is spread once for each band that it reaches: in space
  // a band has planes for some stencils, a row at a time in the plane (docs/results/speed-2026-11.md).
  constexpr int cache = 1 << 19, active_per_node = 10, least = dimension == 3 ? 24 : 8;
  const int rows = row_count(setup_.domain.block), columns = setup_.domain.block.size(0);
  const int active = std::clamp(active_per_node * cells_.known_node_count() / rows, 1, columns);  // of a row
  const int layer = dimension == 3 ? setup_.domain.block.size(1) : 1;                             // rows of a plane
  const int height = std::max(least * layer, cache / (active * static_cast<int>(dimension * sizeof(T))));
  const EndRows ends = fluid_.end_rows();
  return {.rows = rows,
          .height = height,
          .upwards = fluid_.sweeps_up(),
          .below = ends.below,
          .above = ends.above,
          .cost_below = fluid_.fluid_below()};
}

template <class T, class Set>
void Solver<T, Set>::start(Any* of_any_precision) {
  auto* const former = static_cast<Solver*>(of_any_precision);
  steps_ = 0;
  double faster = 0;  // what the membranes' last displacement is worth in the new time step
  if (setup_.developed && is_enclosed(setup_)) {
    if constexpr (dimension == 3) set_section_flow(fluid_, setup_);
  } else if (setup_.developed && !setup_.layers.empty()) {
    const auto profile =
        layered_profile(fluid_.setting().viscosity_of_rows, setup_.viscosity(), setup_.walls, setup_.body_force_x);
    const auto at = [&](double y) { return profile[static_cast<std::size_t>(y)]; };
    fluid_.set_profile([&](double y) { return at(y).velocity; }, [&](double y) { return at(y).slope; });
  } else if (setup_.developed) {
    const ChannelFlow flow = channel_flow(setup_);
    const auto oscillating = [&](double y) {
      return setup_.oscillation.any() ? oscillating_profile(setup_.oscillation, setup_.viscosity(),
                                                            setup_.domain.size[1], flow.from_middle(y))
                                      : ProfilePoint{0, 0};
    };
    fluid_.set_profile([&](double y) { return flow.velocity(y) + oscillating(y).velocity; },
                       [&](double y) { return flow.slope(y) + oscillating(y).slope; });
  } else if (former != nullptr) {
    faster = setup_.time_step / former->setup_.time_step;
    if (cell_tasks_) {
      const auto [u, v, w] = cell_tasks_->mean_velocity();
      former->cell_tasks_->follow({u, v, w});
      cell_tasks_->follow({faster * u, faster * v, faster * w});
    }
    fluid_.take_over(former->fluid_, faster);
  } else {
    fluid_.set_rest();
  }
  for (const int c : cells_.known_cells()) {
    const CellRange& cell = cells_.cells[c];
    for (auto& velocity : cells_.velocity)
      for (int i = cell.first; i < cell.end() && !velocity.empty(); ++i) velocity[i] *= faster;
  }
  std::fill(cells_.largest_step.begin(), cells_.largest_step.end(), 0.0);
  cells_.largest_step_of_others = 0;
}

template <class T, class Set>
void Solver<T, Set>::start(SolverState state) {
  steps_ = state.steps;
  if (steps_ > 0) oscillate(steps_ - 1);
  if (flow_control_ && state.flow_control) {
    flow_control_->restore(*state.flow_control);
    fluid_.set_drive(setup_.walls, state.flow_control->force);
  }
  fluid_.restore(state.populations, state.walls_have_acted);
  fluid_.recall_links(state.links);
  if (cell_tasks_) cell_tasks_->restore(std::move(state.viscosity));
}

template <class T, class Set>
void Solver<T, Set>::renew_cells(std::optional<GhostCells<dimension>> ghosts) {
  cell_tasks_.reset();
  fluid_.forget_cells();
  cell_tasks_ = std::make_unique<CellTasks>(setup_, cells_, fluid_, std::move(ghosts));
}

/// Walls in the middle of the step and the force at its beginning make the scheme one of second order in time: a
/// population meets the wall half a step after its collision, and the velocity at t has half of the force at t in it.
template <class T, class Set>
void Solver<T, Set>::oscillate(long steps) {
  const Oscillation& oscillation = setup_.oscillation;
  if (!oscillation.any()) return;
  const double at = static_cast<double>(steps), wall = oscillation.at(at + 0.5), force = oscillation.at(at);
  fluid_.set_drive(
      {setup_.walls.lower + wall * oscillation.walls.lower, setup_.walls.upper + wall * oscillation.walls.upper},
      setup_.body_force_x + force * oscillation.body_force_x);
}

template <class T, class Set>
void Solver<T, Set>::keep_mean_velocity() {
  fluid_.settle();
  const Domain<dimension>& domain = setup_.domain;
  const double rate =
      flow_rate(fluid_.row_velocities_without_membranes(), setup_.walls, domain, setup_.solid != nullptr);
  double section = setup_.solid ? static_cast<double>(setup_.solid->fluid_count()) / domain.size[0] : 1;
  for (int k = 1; k < dimension && !setup_.solid; ++k) section *= domain.size[k];
  fluid_.set_drive(setup_.walls, flow_control_->follow(rate / section));
}

template <int D>
WallForces<D> AnySolver<D>::wall_forces() const {
  WallForces<D> forces = fluid().wall_forces();
  if (cell_tasks() != nullptr) forces += cell_tasks()->wall_share();
  return forces;
}

template <int D>
typename AnyFluid<D>::WallStress AnySolver<D>::mean_wall_stress(const WallForces<D>& forces) const {
  if (!setup_.solid) return fluid().mean_wall_stress(forces);
  const double mean = setup_.wall_area > 0 ? forces.all(setup_.domain.flow_axis()) / setup_.wall_area : NAN;
  return {mean, mean};
}

template <int D>
void AnySolver<D>::step(long count) {
  for (; count > 0; --count) run_alone(0, passes_.passes.size());
  end_messages();
}

template <int D>
void AnySolver<D>::compute_forces() {
  run_alone(0, passes_.observable);
}

template <int D>
void AnySolver<D>::advance() {
  run_alone(passes_.observable, passes_.passes.size());
  end_messages();
}

template <int D>
void AnySolver<D>::run_alone(std::size_t first, std::size_t last) {
  Barrier nobody(1);
  passes_.run(first, last, Worker{}, nobody);
}

template <int D>
std::unique_ptr<AnySolver<D>> make_solver(bool single_precision, BasicSolverSetup<D> setup,
                                          typename AnySolver<D>::Cells& cells, const Ranks<D>& ranks,
                                          std::optional<GhostCells<D>> ghosts) {
  using Set = std::conditional_t<D == 2, D2Q9, D3Q19>;
  if (single_precision) return std::make_unique<Solver<float, Set>>(std::move(setup), cells, ranks, std::move(ghosts));
  return std::make_unique<Solver<double, Set>>(std::move(setup), cells, ranks, std::move(ghosts));
}

template class AnySolver<2>;
template class AnySolver<3>;
template std::unique_ptr<AnySolver<2>> make_solver(bool, SolverSetup, Membranes&, const Ranks<2>&,
                                                   std::optional<GhostCells<2>>);
template std::unique_ptr<AnySolver<3>> make_solver(bool, BasicSolverSetup<3>, Surfaces&, const Ranks<3>&,
                                                   std::optional<GhostCells<3>>);
template class Solver<float>;
template class Solver<double>;
template class Solver<float, D3Q19>;
template class Solver<double, D3Q19>;

}  // namespace rouleau::core
