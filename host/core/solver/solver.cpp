#include "solver.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "core/fluid/flow_rate.hpp"
#include "core/membrane/area_correction.hpp"
#include "core/membrane/motion.hpp"
#include "core/membrane/stiffness.hpp"

namespace rouleau::core {

namespace {

template <int D>
bool has_contrast(const BasicSolverSetup<D>& setup, const Membranes& membranes) {
  if (!setup.layers.empty()) return !membranes.cells.empty();
  return std::any_of(membranes.cells.begin(), membranes.cells.end(),
                     [&](const CellRange& cell) { return setup.cell_types[cell.type].viscosity_ratio != 1; });
}

template <int D>
FluidSetting<D> fluid_setting(const BasicSolverSetup<D>& setup, const Membranes& membranes) {
  for (const int nodes : setup.domain.size) {
    if (nodes < 1) throw std::invalid_argument("a lattice needs at least one node along every axis");
  }
  if (!setup.domain.periodic[0]) throw std::invalid_argument("a lattice without walls along y is periodic along x");
  if (D == 3 && !membranes.cells.empty()) throw std::invalid_argument("cells are computed in two dimensions only");
  if (D == 3 && setup.domain.walled(D - 1) && setup.developed)
    throw std::invalid_argument("the developed flow between walls across z is not known");
  if (!setup.layers.empty() && !membranes.cells.empty() && (setup.semi_implicit || setup.slip_correction))
    throw std::invalid_argument("cells in layers take neither the semi-implicit step nor the slip correction");
  if (!setup.layers.empty() && setup.developed && setup.oscillation.any())
    throw std::invalid_argument("the developed oscillation of layers is not known");
  if (setup.collision.table == nullptr) throw std::invalid_argument("a fluid needs a collision operator");
  FluidSetting<D> setting{.domain = setup.domain,
                          .relaxation_rate = 1 / setup.tau,
                          .viscosity_of_rows = viscosity_of_rows(setup.layers, setup.domain.size[1]),
                          .inertia = setup.inertia,
                          .walls = setup.walls,
                          .membranes = !membranes.cells.empty(),
                          .viscosity_contrast = has_contrast(setup, membranes)};
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
       layered_profile(viscosity_of_rows(setup.layers, setup.domain.size[1]), setup.viscosity(), {}, 1)) {
    sum += point.velocity;
  }
  return height * height * height / (12 * sum);
}

struct Stiffness {
  double stretching = 0, bending = 0;
};
Stiffness stiffness_of(const MembraneLaws& laws) {
  Stiffness sum;
  for (const MembraneLaw& law : laws) {
    sum.stretching += core::stretching_stiffness(law);
    sum.bending += core::bending_stiffness(law);
  }
  return sum;
}

/// What it takes to stretch all membranes by 0.1 %, and to bend them by as much.
double slight_energy_of(const std::vector<CellType>& types, const Membranes& membranes) {
  constexpr double strain = 1e-3;
  std::vector<Stiffness> of_type;
  of_type.reserve(types.size());
  for (const CellType& type : types) of_type.push_back(stiffness_of(type.laws));
  double energy = 0;
  for (const CellRange& cell : membranes.cells) {
    const double curvature = strain * 2 * std::numbers::pi / cell.rest_perimeter;  // of a circle
    const Stiffness& stiffness = of_type[cell.type];
    energy +=
        (stiffness.stretching * strain * strain + stiffness.bending * curvature * curvature) / 2 * cell.rest_perimeter;
  }
  return energy;
}

}  // namespace

template <class T, class Set>
Solver<T, Set>::Solver(Setup setup, Membranes& membranes, const Ranks<dimension>& ranks, std::vector<int> owner)
    : setup_(std::move(setup)),
      membranes_(membranes),
      fluid_(fluid_setting(setup_, membranes), setup_.collision, ranks) {
  if constexpr (dimension == 2) {
    if (ranks.several()) {
      if (owner.empty()) owner = CellExchange::owners_by_place(membranes, *ranks.blocks);
      membranes_.owned.clear();
      for (const int rank : owner) membranes_.owned.push_back(rank == ranks.transport->rank() ? 1 : 0);
      exchange_ = std::make_unique<CellExchange>(ranks, std::move(owner));
    }
  }
  if constexpr (dimension == 2) {
    if (!membranes.cells.empty()) make_cells();
  }
  if (setup_.mean_velocity != 0) {
    if (!setup_.domain.walled(1)) throw std::invalid_argument("a mean velocity is kept between walls");
    flow_control_.emplace(setup_.mean_velocity, setup_.body_force_x, channel_viscosity(setup_), setup_.domain.size[1]);
  }
  const Schedule schedule = make_schedule(features());
  for (const Step& step : schedule.steps) {
    Pass& pass = passes_.emplace_back(Pass{.name = step.name, .run = {}, .meeting = step.meeting});
    if (over_rows(step.task)) {
      pass.run_rows = [this, task = step.task](Range rows) { run_rows(task, rows); };
    } else {
      pass.run = [this, task = step.task](Worker worker) { run(task, worker); };
    }
  }
  rows_pass_ = schedule.rows;
  observable_pass_ = schedule.observable;
}

template <class T, class Set>
StepFeatures Solver<T, Set>::features() const {
  return {.cells = !membranes_.cells.empty(),
          .interactions = interaction_forces_ != nullptr,
          .wall_interactions = wall_contacts_ != nullptr,
          .self_interactions = self_contacts_ != nullptr,
          .viscosity_contrast = fluid_.setting().viscosity_contrast,
          .slip_correction = slip_correction_ != nullptr,
          .area_correction = setup_.area_correction,
          .moving_frame = setup_.follow_cells,
          .changing_drive = setup_.oscillation.any() || flow_control_.has_value(),
          .ranks = fluid_.ranks().several()};
}

template <class T, class Set>
void Solver<T, Set>::run(Task task, Worker worker) {
  switch (task) {
    case Task::set_drive:
      if (!worker.first()) return;
      oscillate(steps_);
      if (flow_control_ && flow_control_->due(steps_)) keep_mean_velocity();
      return;
    case Task::end_step:
      if (worker.first()) fluid_.end_step(), ++steps_;
      return;
    case Task::exchange_halo:
      if (worker.first()) fluid_.begin_halo(), fluid_.end_halo();
      return;
    case Task::clear_force:
    case Task::spread:
    case Task::collide_and_stream:
      return;  // over rows
    default:
      if constexpr (dimension == 2) run_cells(task, worker);
  }
}

template <class T, class Set>
void Solver<T, Set>::run_cells(Task task, Worker worker) {
  if constexpr (dimension == 2) {
    switch (task) {
      case Task::find_contacts:
        return interaction_forces_->run(worker, 0, membranes_);
      case Task::membrane_forces:
        return membrane_forces_->run(worker, membranes_);
      case Task::wall_forces:
        return wall_contacts_->run(worker, membranes_);
      case Task::self_forces:
        return self_contacts_->run(worker, membranes_);
      case Task::interaction_forces:
        return interaction_forces_->run(worker, 1, membranes_);
      case Task::take_reactions:
        return interaction_forces_->run(worker, 2, membranes_);
      case Task::complete_forces:
        if (setup_.area_correction) core::take_out_pressures(worker, membranes_);
        if (slip_correction_) slip_correction_->complete(worker, membranes_);
        return;
      case Task::find_nodes:
        viscosity_field_->measure(worker, membranes_);
        return viscosity_field_->cover(worker, membranes_);
      case Task::follow_cells:
        if (worker.first()) follow_cells(mean_velocity(membranes_));
        return;
      case Task::set_viscosity:
        if (viscosity_field_->due())
          viscosity_field_->update(worker, membranes_, fluid_.relaxation_rate(), fluid_.mask());
        return;
      case Task::interpolate:
        return coupling_->interpolate(worker, membranes_, fluid_.velocity());
      case Task::correct_velocities:
        if (slip_correction_) slip_correction_->correct(worker, membranes_);
        if (setup_.area_correction) core::keep_areas(worker, membranes_);
        return;
      case Task::move:
        return core::move_nodes(worker, membranes_);
      case Task::locate:
        return locate(worker);
      case Task::share_reactions:
      case Task::share_forces:
      case Task::collect_velocities:
      case Task::share_positions:
        if (worker.first()) exchange(task);
        return;
      default:
        return;  // of the fluid
    }
  }
}

template <class T, class Set>
void Solver<T, Set>::exchange(Task task) {
  if (task == Task::share_reactions) {
    exchange_->share_reactions(*interaction_forces_);
  } else if (task == Task::share_forces) {
    const auto [x, y] = slip_correction_ ? slip_correction_->forces_of_all()
                                         : std::array{membranes_.force_x.data(), membranes_.force_y.data()};
    exchange_->share_forces(membranes_, x, y);
  } else if (task == Task::collect_velocities) {
    exchange_->collect_velocities(membranes_, [this](int node) { return coupling_->base(node); });
  } else {
    exchange_->share_positions(membranes_);
  }
}

template <class T, class Set>
void Solver<T, Set>::run_rows(Task task, Range rows) {
  if (task == Task::clear_force) {
    fluid_.clear_force(rows);
  } else if (task == Task::spread) {
    if constexpr (dimension == 2) {
      coupling_->spread(rows, membranes_, slip_correction_ ? slip_correction_->forces() : membranes_.forces(),
                        fluid_.force());
    }
  } else {
    fluid_.step(rows);
  }
}

template <class T, class Set>
RowBands Solver<T, Set>::bands() const {
  // Force and velocity of a band's active nodes should stay in a cache of this size until they have been used; about ten
  // of the lattice are active for one of a membrane.
  constexpr int cache = 1 << 19, active_per_node = 10;
  const int rows = row_count(setup_.domain.block), columns = setup_.domain.block.size(0);
  const int active = std::clamp(active_per_node * membranes_.node_count() / rows, 1, columns);  // of a row
  const int height = std::max(8, cache / (active * static_cast<int>(dimension * sizeof(T))));
  return {.rows = rows, .height = height, .upwards = fluid_.sweeps_up()};
}

template <class T, class Set>
void Solver<T, Set>::make_cells() {
  if constexpr (dimension == 2) {
    if (setup_.slip_correction) make_slip_correction();
    membranes_.largest_step.resize(membranes_.cells.size(), 0.0);
    if (setup_.area_correction) membranes_.area_leakage.resize(membranes_.cells.size(), 0.0);  // earlier leakage stays

    MembraneForcesSetup membrane_setup{
        .semi_implicit = setup_.semi_implicit, .viscosity = setup_.viscosity(), .tension_unit = setup_.tension_unit};
    std::vector<double> viscosity_ratio;
    for (const CellType& type : setup_.cell_types) {
      membrane_setup.laws.push_back(type.laws);
      viscosity_ratio.push_back(type.viscosity_ratio);
    }
    if (slip_correction_) membrane_setup.mobility = slip_correction_->mobility();
    membrane_forces_ = std::make_unique<MembraneForces>(membranes_, membrane_setup);
    slight_energy_ = slight_energy_of(setup_.cell_types, membranes_);
    if (!setup_.interactions.empty()) {
      interaction_forces_ = std::make_unique<InteractionForces>(membranes_, setup_.interactions, setup_.domain);
    }
    if (!setup_.wall_interactions.empty()) {
      wall_contacts_ = std::make_unique<WallContacts>(membranes_, setup_.wall_interactions, setup_.domain);
    }
    if (!setup_.self_interactions.empty()) {
      self_contacts_ = std::make_unique<SelfContacts>(membranes_, setup_.self_interactions);
    }
    viscosity_field_ = std::make_unique<ViscosityField<T>>(
        membranes_, std::move(viscosity_ratio), slip_correction_ ? ViscosityMean::harmonic : ViscosityMean::arithmetic,
        slip_correction_ ? slip_correction_->largest_shift() : 0.0, 1 / setup_.tau, setup_.domain,
        fluid_.setting().viscosity_of_rows);
    coupling_ = std::make_unique<Coupling<T>>(setup_.kernel, setup_.domain);
    coupling_->reserve(membranes_);
    locate(Worker{});
  }
}

template <class T, class Set>
void Solver<T, Set>::make_slip_correction() {
  std::vector<SlipCorrection::Type> types;
  for (const CellType& type : setup_.cell_types) {
    const Stiffness stiffness = stiffness_of(type.laws);
    types.push_back(
        {core::slip_constants(setup_.kernel, type.viscosity_ratio), stiffness.stretching, stiffness.bending});
  }
  slip_correction_ = std::make_unique<SlipCorrection>(membranes_, std::move(types), setup_.viscosity());
}

template <class T, class Set>
void Solver<T, Set>::start(Solver* former) {
  steps_ = 0;
  double faster = 0;  // what the membranes' last displacement is worth in the new time step
  if (setup_.developed && !setup_.layers.empty()) {
    const auto profile =
        layered_profile(fluid_.setting().viscosity_of_rows, setup_.viscosity(), setup_.walls, setup_.body_force_x);
    const auto at = [&](double y) { return profile[static_cast<std::size_t>(y)]; };
    fluid_.set_profile([&](double y) { return at(y).velocity; }, [&](double y) { return at(y).slope; });
  } else if (setup_.developed) {
    // Couette and Poiseuille flow and what oscillates around them, y from the middle of the channel.
    const int height = setup_.domain.size[1];
    const double half_height = height / 2.0, middle = half_height - 0.5;
    const double rate = (setup_.walls.upper - setup_.walls.lower) / height;
    const double mean = (setup_.walls.upper + setup_.walls.lower) / 2;
    const double curvature = setup_.body_force_x / setup_.viscosity();
    const auto oscillating = [&](double s) {
      return setup_.oscillation.any() ? oscillating_profile(setup_.oscillation, setup_.viscosity(), height, s)
                                      : ProfilePoint{0, 0};
    };
    fluid_.set_profile(
        [&](double y) {
          const double s = y - middle;
          return mean + rate * s + curvature * (half_height * half_height - s * s) / 2 + oscillating(s).velocity;
        },
        [&](double y) { return rate - curvature * (y - middle) + oscillating(y - middle).slope; });
  } else if (former != nullptr) {
    faster = setup_.time_step / former->setup_.time_step;
    if constexpr (dimension == 2) {
      const auto [u, v] = mean_velocity(membranes_);
      former->follow_cells({u, v});
      follow_cells({faster * u, faster * v});
    }
    fluid_.take_over(former->fluid_, faster);
  }
  for (auto* velocity : {&membranes_.velocity_x, &membranes_.velocity_y}) {
    for (double& v : *velocity) v *= faster;
  }
  std::fill(membranes_.largest_step.begin(), membranes_.largest_step.end(), 0.0);
}

template <class T, class Set>
void Solver<T, Set>::start(const SolverState<T>& state) {
  steps_ = state.steps;
  if (steps_ > 0) oscillate(steps_ - 1);
  if (flow_control_ && state.flow_control) {
    flow_control_->restore(*state.flow_control);
    fluid_.set_drive(setup_.walls, state.flow_control->force);
  }
  fluid_.restore(state.populations, state.walls_have_acted);
  if constexpr (dimension == 2) {
    if (viscosity_field_)
      viscosity_field_->restore(state.viscosity, membranes_, fluid_.relaxation_rate(), fluid_.mask());
  }
}

template <class T, class Set>
void Solver<T, Set>::follow_cells(const std::array<double, 2>& velocity) {
  if constexpr (dimension == 2) {
    if (setup_.follow_cells) fluid_.set_frame(velocity[0], setup_.domain.periodic[1] ? velocity[1] : 0);
  }
}

/// Walls in the middle of the step and the force at its beginning make the scheme one of second order in time: a
/// population meets the wall half a step after its collision, and the velocity at t has half of the force at t in it.
template <class T, class Set>
void Solver<T, Set>::oscillate(long steps) {
  const Oscillation& oscillation = setup_.oscillation;
  if (!oscillation.any()) return;
  const double at = static_cast<double>(steps), wall = oscillation.sine(at + 0.5), force = oscillation.sine(at);
  fluid_.set_drive(
      {setup_.walls.lower + wall * oscillation.walls.lower, setup_.walls.upper + wall * oscillation.walls.upper},
      setup_.body_force_x + force * oscillation.body_force_x);
}

template <class T, class Set>
void Solver<T, Set>::keep_mean_velocity() {
  fluid_.settle();
  const Domain<dimension>& domain = setup_.domain;
  const double rate = flow_rate(fluid_.row_velocities_without_membranes(), setup_.walls, domain);
  double section = 1;
  for (int k = 1; k < dimension; ++k) section *= domain.size[k];
  fluid_.set_drive(setup_.walls, flow_control_->follow(rate / section));
}

template <class T, class Set>
void Solver<T, Set>::step(long count) {
  for (; count > 0; --count) run_alone(0, passes_.size());
}

template <class T, class Set>
void Solver<T, Set>::compute_forces() {
  run_alone(0, observable_pass_);
}

template <class T, class Set>
void Solver<T, Set>::advance() {
  run_alone(observable_pass_, passes_.size());
}

template <class T, class Set>
void Solver<T, Set>::run_alone(std::size_t first, std::size_t last) {
  Barrier nobody(1);
  run_passes(passes_, first, last, bands(), Worker{}, nobody, nullptr);
}

/// Pass over cells: where the nodes touch the lattice.
template <class T, class Set>
void Solver<T, Set>::locate(Worker worker) {
  if (slip_correction_) slip_correction_->measure(worker, membranes_);
  coupling_->locate(worker, membranes_, slip_correction_ ? slip_correction_->positions() : membranes_.positions());
}

template <class T, class Set>
void Solver<T, Set>::tensions(std::vector<double>& tension) const {
  membrane_forces_->tensions(membranes_, tension);
}

template class Solver<float>;
template class Solver<double>;
template class Solver<float, D3Q19>;
template class Solver<double, D3Q19>;

}  // namespace rouleau::core
