#include "observer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bonds.hpp"
#include "cell_sums.hpp"
#include "core/fluid/relaxation.hpp"
#include "energy.hpp"
#include "fields.hpp"
#include "profiles.hpp"
#include "rheology.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"

namespace rouleau::observe {

namespace {

/// The value nearest to `previous` that differs from `angle` by a multiple of `period`.
double continued(double angle, double previous, double period) {
  return angle + period * std::round((previous - angle) / period);
}

}  // namespace

Observer::Observer(const scene::Scene& scene, scene::Attractions attracting)
    : scene_(&scene), attracting_(std::move(attracting)), domain_(scene::lattice_domain(scene)) {}

template <class Cells>
void Observer::begin_with(const Cells& cells) {
  for (int k = 0; k < cells.cell_count(); ++k) {
    const auto number = static_cast<int>(angle_.size());
    if (cells.knows(k)) {
      begin_with(cells, k, number);
    } else {
      make_room_for(number);
    }
  }
}

void Observer::make_room_for(int cell) {
  const auto count = std::max(angle_.size(), static_cast<std::size_t>(cell) + 1);
  angle_.resize(count, 0);
  tank_treading_angle_.resize(count, std::nan(""));
  initial_area_.resize(count, std::nan(""));
  marker_.resize(count, 0);
}

template <class Cells>
void Observer::begin_with(const Cells& cells, int k, int number) {
  make_room_for(number);
  const auto at = static_cast<std::size_t>(number);
  angle_[at] = scene_->cells[at].angle;
  tank_treading_angle_[at] = std::nan("");
  initial_area_[at] = enclosed(cells, k);
  marker_[at] = outermost(cells, k);
}

bool Observer::fits(const core::CellNodes& nodes) const {
  const std::size_t count = initial_area_.size();
  if (angle_.size() != count || tank_treading_angle_.size() != count || marker_.size() != count ||
      count > nodes.cells.size())
    return false;
  for (const int c : nodes.known_cells()) {
    const auto k = static_cast<std::size_t>(c);
    if (k >= count || marker_[k] < 0 || marker_[k] >= nodes.cells[k].count) return false;
  }
  return true;
}

template <class Cells, int D>
double Observer::follow_area(const Cells& cells, const core::Ranks<D>& ranks, int* whose) {
  const Change most = largest_change(cells, ranks, [&](int c) { return enclosed(cells, c) / initial_area_[c] - 1; });
  if (whose != nullptr) *whose = most.cell;
  area_drift_max_ = std::max(area_drift_max_, most.share);
  return most.share;
}

template <int D>
double Observer::area_leakage(const core::CellNodes& cells, const core::Ranks<D>& ranks, int* whose) {
  if (cells.area_leakage.empty()) return std::nan("");
  const Change most = largest_change(cells, ranks, [&](int c) { return cells.area_leakage[c]; });
  if (whose != nullptr) *whose = most.cell;
  return most.share;
}

template <int D>
double Observer::momentum_residual(const core::CellNodes& m, const std::array<double, 3>& from_walls,
                                   const core::Ranks<D>& ranks) {
  const auto [net_x, net_y, net_z, magnitudes] = sums_over<4>(m, ranks, [&](int c) {
    std::array<double, 4> of_cell{};
    for (int i = m.cells[c].first; i < m.cells[c].end(); ++i) {
      const double along_z = m.position[2].empty() ? 0 : m.force[2][i];
      of_cell[0] += m.force[0][i];
      of_cell[1] += m.force[1][i];
      of_cell[2] += along_z;
      of_cell[3] += std::hypot(std::hypot(m.force[0][i], m.force[1][i]), along_z);
    }
    return of_cell;
  });
  const double net = std::hypot(std::hypot(net_x - from_walls[0], net_y - from_walls[1]), net_z - from_walls[2]);
  return magnitudes > 0 ? net / magnitudes : 0;
}

template <int D>
core::FluidMeasures<D> Observer::measure_fluid(core::AnyFluid<D>& fluid, const scene::StageSetting& setting,
                                               bool for_output) const {
  fluid.settle();
  return fluid.measure(
      {.energetics = for_output,
       .row_velocities = for_output && (is_driven_channel(setting, *scene_) || scene_->output.profiles)});
}

template <int D>
double Observer::follow_fluid(const core::AnyFluid<D>& fluid, const core::FluidMeasures<D>& measured) {
  double mass = measured.mass, whole = static_cast<double>(fluid.setting().domain.nodes());
  if (scene_->domain.is_open()) {  // what goes through openings is no loss
    for (const std::vector<double>& end : fluid.passed()) {
      const double in = std::accumulate(end.begin(), end.end(), 0.0);
      mass -= in, whole += std::max(in, 0.0);
    }
  }
  if (std::isnan(initial_mass_)) initial_mass_ = mass;
  mass_drift_ = std::max(mass_drift_, std::abs(mass - initial_mass_) / whole);
  const double mach = units::mach_number(measured.speed);
  mach_max_ = std::max(mach_max_, mach);
  return mach;
}

template <int D>
void Observer::observe_cells(core::Surroundings<D>& around, const units::LatticeUnits& units, Snapshot& snapshot) {
  const double length = units.length, touching = scene_->output.aggregate_gap / length;
  const auto& cells = around.cells();
  const core::Ranks<D> ranks = around.ranks();
  const core::Domain<D> domain = scene::lattice_domain<D>(*scene_);
  const core::RegionPointer<D> region = scene::fluid_region<D>(*scene_);
  around.show(touching);
  std::vector<CellContact> contacts = core::to_first(ranks, find_touching_cells(cells, domain, touching));
  const std::vector<double> gaps = smallest_gaps(around, domain);
  std::vector<CellMeasures> measures;
  for (const int c : cells.own_cells()) {
    measures.push_back(measure(cells, c, domain, region.get(), marker_[c]));
    measures.back().gap = gaps[c];
    measure_pulled(*scene_, cells, measures.back());
  }
  measures = core::to_first(ranks, std::move(measures));
  if (!ranks.first()) return;
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const CellContact& a, const CellContact& b) { return a.cell_a < b.cell_a; });
  std::sort(measures.begin(), measures.end(),
            [](const CellMeasures& a, const CellMeasures& b) { return a.cell < b.cell; });
  std::vector<int> there;
  there.reserve(measures.size());
  for (const CellMeasures& m : measures) there.push_back(m.cell);
  const Aggregates aggregates = find_aggregates(std::move(there), contacts);
  describe_contacts<D>(contacts, aggregates, length, snapshot);
  std::vector<Eigen::Vector2d> centers;  // as seen along z
  snapshot.cells.reserve(measures.size());
  for (const CellMeasures& m : measures) {
    const std::size_t k = centers.size();
    centers.emplace_back(m.x, m.y);
    CellSnapshot s;
    follow_angles(m, s);
    s.cell = m.cell;
    s.type = scene_->cell_types[cells.cells[m.cell].type].name;
    s.x = units::coordinate(m.x, length);
    s.y = units::coordinate(m.y, length);
    s.deformation = m.deformation;
    if (m.area) s.area = *m.area * length * length;
    if (m.perimeter) s.perimeter = *m.perimeter * length;
    s.min_gap = m.gap * length;
    s.wall_gap = m.wall_gap * length;
    s.aggregate = aggregates.label[k];
    s.through_image = aggregates.through_image[k];
    s.bonded = m.cell;
    follow_stretch(m.stretch, s);
    s.length_along_force = m.length_along_force * length;
    s.width_across_force = m.width_across_force * length;
    describe_surface(m, units, scene_->domain, s);
    snapshot.cells.push_back(std::move(s));
  }
  snapshot.rotation = rotation_.follow(contacts, aggregates, centers, domain_);
}

void Observer::follow_angles(const CellMeasures& measures, CellSnapshot& snapshot) {
  const auto cell = static_cast<std::size_t>(measures.cell);
  const bool round = std::isnan(measures.long_axis);
  double& treaded = tank_treading_angle_[cell];
  if (!round) angle_[cell] = continued(measures.long_axis, angle_[cell], std::numbers::pi);
  treaded = std::isnan(treaded) ? measures.marker : continued(measures.marker, treaded, 2 * std::numbers::pi);
  snapshot.angle = round ? std::nan("") : angle_[cell];
  snapshot.tank_treading_angle = treaded;
}

void Observer::follow_stretch(const core::StretchRange& stretch, CellSnapshot& snapshot) {
  snapshot.stretch_min = stretch.least;
  snapshot.stretch_max = stretch.most;
  stretch_.least = std::min(stretch_.least, stretch.least);
  stretch_.most = std::max(stretch_.most, stretch.most);
}

template <int D>
void Observer::observe_layers(const core::Cells<D>& cells, const core::Ranks<D>& ranks, double length,
                              Snapshot& snapshot) {
  const core::Domain<D> domain = scene::lattice_domain<D>(*scene_);
  const CellFreeLayer layer = [&] {
    if (scene_->domain.has_shapes()) {
      auto& points = std::get<std::vector<WallPoint<D>>>(wall_points_);
      if (points.empty()) points = wall_points(scene::fluid_region<D>(*scene_), domain);
      return cell_free_layer_at(points, cells, domain, ranks);
    }
    if constexpr (D == 3) {
      if (const std::optional<double> radius = scene_->domain.tube_radius)
        return cell_free_layer_in_tube(cells, domain, *radius / length, ranks);
    }
    return cell_free_layer(cells, domain, ranks);
  }();
  snapshot.cell_free_layer_lower = layer.lower * length;
  snapshot.cell_free_layer_upper = layer.upper * length;
  snapshot.cell_free_layer_empty = layer.empty;
}

template <int D>
Snapshot Observer::observe(core::AnySolver<D>& solver, const core::FluidMeasures<D>& measured,
                           const scene::StageSetting& setting, bool with_fields) {
  const auto& cells = solver.cells();
  const units::LatticeUnits& units = setting.units;
  Snapshot snapshot;
  snapshot.stage = setting.index;
  snapshot.stage_name = setting.stage->name;
  snapshot.dimension = D;
  snapshot.mach_max = follow_fluid(solver.fluid(), measured);
  snapshot.mass_drift = mass_drift_;
  const double viscosity = core::viscosity_of(setting.tau);
  snapshot.relative_viscosity = snapshot.flow_rate = snapshot.mean_velocity = snapshot.area_leakage_max = std::nan("");
  snapshot.cell_free_layer_lower = snapshot.cell_free_layer_upper = snapshot.cell_free_layer_empty = std::nan("");
  snapshot.shear_rate = snapshot.wall_stress_lower = snapshot.wall_stress_upper = std::nan("");
  snapshot.pressure_gradient = snapshot.discharge_hematocrit = std::nan("");
  snapshot.aggregate_size_number_mean = snapshot.aggregate_size_weight_mean = std::nan("");
  snapshot.contacts_per_cell = snapshot.contact_gap = std::nan("");
  const core::AnyFluid<D>& fluid = solver.fluid();
  double drive = fluid.setting().body_force[0];
  if (scene_->domain.openings) drive = observe_openings(fluid, *scene_, units, snapshot);
  const bool oscillates = setting.oscillation.frequency != 0;
  const bool has_walls = scene_->domain.walled(1) || scene_->domain.has_shapes();  // across y, or of any shape
  const auto on_walls = has_walls ? solver.wall_forces() : core::WallForces<D>{};
  if (has_walls) {
    const auto stress = solver.mean_wall_stress(on_walls);
    snapshot.wall_stress_lower = units.to_si(stress.lower, units::dimension::pressure);
    snapshot.wall_stress_upper = units.to_si(stress.upper, units::dimension::pressure);
    const core::WallVelocity& walls = fluid.last_walls();
    const double rate =
        setting.oscillation.any() ? (walls.upper - walls.lower) / scene_->domain.nodes[1] : setting.shear_rate;
    if (scene::walls_move(*setting.stage) && rate != 0 && !oscillates)
      snapshot.relative_viscosity = (stress.lower - stress.upper) / 2 / (viscosity * rate);
  }
  if (scene::walls_move(*setting.stage)) {
    const core::WallVelocity& walls = fluid.last_walls();
    snapshot.shear_rate = units.to_si((walls.upper - walls.lower) / scene_->domain.nodes[1], units::dimension::rate);
  }
  if (is_driven_channel(setting, *scene_)) {
    const scene::Domain& box = scene_->domain;
    const double rate = flow_rate(fluid, measured.row_velocities);
    if (!oscillates)
      snapshot.relative_viscosity = apparent_viscosity(rate / scene::duct_share(box), drive, setting, box.nodes[1]);
    snapshot.flow_rate = units.to_si(rate, units::dimension::velocity) * units.length;
    snapshot.mean_velocity = snapshot.flow_rate;    // times what the flow rate is a mean over
    const int height = box.open_axis == 1 ? 0 : 1;  // the axis that it is an integral over
    for (int axis = 0; axis < box.dimension(); ++axis) snapshot.mean_velocity *= axis == height ? 1 : box.size[axis];
    snapshot.mean_velocity /= box.content();
    // Over one flow rate, along the length and of the whole depth.
    double flow = rate;
    for (int axis = 0; axis < D; ++axis) flow *= axis == height ? 1 : box.nodes[axis];
    const double carried = cells.cells.empty() ? 0 : cell_flux(cells, solver.ranks(), box.flow_axis());
    if (carried != 0 && flow != 0) snapshot.discharge_hematocrit = carried / flow;
  }
  if (setting.stage->pressure_gradient != scene::Vector() || setting.stage->mean_velocity ||
      setting.oscillation.body_force_x != 0) {
    snapshot.pressure_gradient =
        units.to_si(fluid.setting().body_force[0], units::dimension::force_density) - scene_->fluid.body_force.x();
  }
  if (scene_->output.profiles) {
    for (const double velocity : velocity_profile(measured.row_velocities, *scene_))
      snapshot.velocity_profile.push_back(units.to_si(velocity, units::dimension::velocity));
    snapshot.hematocrit_profile = hematocrit_profile(cells, *scene_, solver.ranks());
  }
  if (!cells.cells.empty()) {
    const core::Ranks<D>& ranks = solver.ranks();
    if (has_walls) observe_layers(cells, ranks, units.length, snapshot);
    core::Surroundings<D> around = solver.cell_tasks()->surroundings();
    observe_cells(around, units, snapshot);
    observe_interactions(solver, *scene_, attracting_, units, snapshot);
    snapshot.area_drift_max = follow_area(cells, ranks);
    snapshot.area_leakage_max = area_leakage(cells, ranks);
    snapshot.membranes = observe_membranes(solver, units);
  }
  snapshot.energy = observe_energy(solver, measured.energetics.value(), on_walls, units);
  if (with_fields) snapshot.fields = observe_fields(solver.fluid(), *scene_, units);
  return snapshot;
}

void Observer::start_stage() { initial_mass_ = std::nan(""); }

template void Observer::begin_with(const core::Membranes&);
template void Observer::begin_with(const core::Surfaces&);
template void Observer::begin_with(const core::Membranes&, int, int);
template void Observer::begin_with(const core::Surfaces&, int, int);
template double Observer::follow_area(const core::Membranes&, const core::Ranks<2>&, int*);
template double Observer::follow_area(const core::Surfaces&, const core::Ranks<3>&, int*);
template double Observer::area_leakage(const core::CellNodes&, const core::Ranks<2>&, int*);
template double Observer::area_leakage(const core::CellNodes&, const core::Ranks<3>&, int*);
template double Observer::momentum_residual(const core::CellNodes&, const std::array<double, 3>&,
                                            const core::Ranks<2>&);
template double Observer::momentum_residual(const core::CellNodes&, const std::array<double, 3>&,
                                            const core::Ranks<3>&);
template core::FluidMeasures<2> Observer::measure_fluid(core::AnyFluid<2>&, const scene::StageSetting&, bool) const;
template core::FluidMeasures<3> Observer::measure_fluid(core::AnyFluid<3>&, const scene::StageSetting&, bool) const;
template Snapshot Observer::observe(core::AnySolver<2>&, const core::FluidMeasures<2>&, const scene::StageSetting&,
                                    bool);
template Snapshot Observer::observe(core::AnySolver<3>&, const core::FluidMeasures<3>&, const scene::StageSetting&,
                                    bool);
template double Observer::follow_fluid(const core::AnyFluid<2>&, const core::FluidMeasures<2>&);
template double Observer::follow_fluid(const core::AnyFluid<3>&, const core::FluidMeasures<3>&);

}  // namespace rouleau::observe
