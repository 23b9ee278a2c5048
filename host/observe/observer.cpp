#include "observer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/fluid/relaxation.hpp"
#include "core/membrane/geometry.hpp"
#include "energy.hpp"
#include "fields.hpp"
#include "particle_stress.hpp"
#include "plan/solver_setup.hpp"
#include "rheology.hpp"
#include "scene/driving_flow.hpp"

namespace rouleau::observe {

namespace {

/// A circle has no long axis: below this deformation its direction would be that of rounding errors.
constexpr double roundest = 1e-6;

/// The value nearest to `previous` that differs from `angle` by a multiple of `period`.
double continued(double angle, double previous, double period) {
  return angle + period * std::round((previous - angle) / period);
}

}  // namespace

Observer::Observer(const scene::Scene& scene, const core::Membranes& membranes)
    : scene_(&scene), domain_(plan::lattice_domain(scene)) {
  for (const core::CellRange& cell : membranes.cells) initial_area_.push_back(core::enclosed_area(membranes, cell));
  for (const scene::CellPlacement& cell : scene.cells) angle_.push_back(cell.angle);
  tank_treading_angle_.assign(membranes.cells.size(), 0.0);
}

double Observer::follow_area(const core::Membranes& membranes, int* whose) {
  double most = 0;
  for (std::size_t k = 0; k < membranes.cells.size(); ++k) {
    const double drift = std::abs(core::enclosed_area(membranes, membranes.cells[k]) / initial_area_[k] - 1);
    if (drift > most || !std::isfinite(drift)) {
      most = drift;
      if (whose != nullptr) *whose = static_cast<int>(k);
    }
  }
  area_drift_max_ = std::max(area_drift_max_, most);
  return most;
}

double Observer::area_leakage(const core::Membranes& membranes, int* whose) {
  if (membranes.area_leakage.empty()) return std::nan("");
  double most = 0;
  for (std::size_t k = 0; k < membranes.area_leakage.size(); ++k) {
    const double leakage = std::abs(membranes.area_leakage[k]);
    if (leakage > most || !std::isfinite(leakage)) {
      most = leakage;
      if (whose != nullptr) *whose = static_cast<int>(k);
    }
  }
  return most;
}

double Observer::momentum_residual(const core::Membranes& m, double from_walls) {
  double net_x = 0, net_y = -from_walls, magnitudes = 0;
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    net_x += m.force_x[i];
    net_y += m.force_y[i];
    magnitudes += std::hypot(m.force_x[i], m.force_y[i]);
  }
  return magnitudes > 0 ? std::hypot(net_x, net_y) / magnitudes : 0;
}

template <class T, class Set>
double Observer::follow_fluid(core::Fluid<T, Set>& fluid) {
  fluid.settle();
  const auto [mass, speed] = fluid.mass_and_speed();
  if (std::isnan(initial_mass_)) initial_mass_ = mass;
  const auto nodes = static_cast<double>(fluid.setting().domain.nodes());
  mass_drift_ = std::max(mass_drift_, std::abs(mass - initial_mass_) / nodes);
  const double mach = units::mach_number(speed);
  mach_max_ = std::max(mach_max_, mach);
  return mach;
}

void Observer::observe_cells(const core::Membranes& membranes, const units::LatticeUnits& units, Snapshot& snapshot) {
  const double length = units.length;
  const auto contacts = find_touching_cells(membranes, domain_, scene_->output.aggregate_gap / length);
  const Aggregates aggregates = find_aggregates(static_cast<int>(membranes.cells.size()), contacts);
  snapshot.aggregate_count = aggregates.count;
  snapshot.aggregate_sizes = aggregate_sizes(aggregates.label);
  snapshot.aggregate_size_number_mean = number_mean(snapshot.aggregate_sizes);
  snapshot.aggregate_size_weight_mean = weight_mean(snapshot.aggregate_sizes);
  for (const CellContact& c : contacts) {
    snapshot.contacts.push_back(
        {c.cell_a, c.cell_b, {c.image.x, c.image.y}, c.gap * length, c.contact_length * length});
  }
  const std::vector<double> gaps = smallest_gaps(membranes, domain_);
  std::vector<Eigen::Vector2d> centers;
  for (std::size_t k = 0; k < membranes.cells.size(); ++k) {
    const core::CellRange& cell = membranes.cells[k];
    const Eigen::Vector2d c = core::centroid(membranes, cell);
    centers.push_back(c);
    const core::InertiaEllipse ellipse = core::inertia_ellipse(membranes, cell);
    const double marker = core::marker_angle(membranes, cell);
    const bool round = !(ellipse.deformation > roundest);
    if (!round) angle_[k] = continued(ellipse.angle, angle_[k], std::numbers::pi);
    tank_treading_angle_[k] = started_ ? continued(marker, tank_treading_angle_[k], 2 * std::numbers::pi) : marker;
    CellSnapshot s;
    s.cell = static_cast<int>(k);
    s.type = scene_->cell_types[cell.type].name;
    s.x = units::coordinate(c.x(), length);
    s.y = units::coordinate(c.y(), length);
    s.angle = round ? std::nan("") : angle_[k];
    s.deformation = ellipse.deformation;
    s.area = core::enclosed_area(membranes, cell) * length * length;
    s.perimeter = core::perimeter(membranes, cell) * length;
    s.tank_treading_angle = tank_treading_angle_[k];
    s.min_gap = gaps[k] * length;
    s.wall_gap = wall_gap(membranes, cell, domain_) * length;
    s.aggregate = aggregates.label[k];
    s.through_image = aggregates.through_image[k];
    const core::StretchRange stretch = core::stretch_range(membranes, cell);
    s.stretch_min = stretch.least;
    s.stretch_max = stretch.most;
    stretch_.least = std::min(stretch_.least, stretch.least);
    stretch_.most = std::max(stretch_.most, stretch.most);
    snapshot.cells.push_back(std::move(s));
  }
  snapshot.rotation = rotation_.follow(contacts, aggregates, centers, domain_);
  started_ = true;
}

template <class T, class Set>
Snapshot Observer::observe(core::Solver<T, Set>& solver, const plan::StageSetting& setting,
                           const core::Membranes& membranes, bool with_fields) {
  const units::LatticeUnits& units = setting.units;
  Snapshot snapshot;
  snapshot.stage = setting.index;
  snapshot.stage_name = setting.stage->name;
  snapshot.mach_max = follow_fluid(solver.fluid());
  snapshot.mass_drift = mass_drift_;
  const double viscosity = core::viscosity_of(setting.tau);
  snapshot.relative_viscosity = snapshot.flow_rate = snapshot.area_leakage_max = std::nan("");
  snapshot.cell_free_layer_lower = snapshot.cell_free_layer_upper = std::nan("");
  snapshot.shear_rate = snapshot.wall_stress_lower = snapshot.wall_stress_upper = std::nan("");
  snapshot.pressure_gradient = std::nan("");
  snapshot.aggregate_size_number_mean = snapshot.aggregate_size_weight_mean = std::nan("");
  const core::Fluid<T, Set>& fluid = solver.fluid();
  const bool oscillates = setting.oscillation.any();
  if (!scene_->domain.periodic_y) {
    const auto stress = fluid.wall_stress();
    snapshot.wall_stress_lower = units.to_si(stress.lower, units::dimension::pressure);
    snapshot.wall_stress_upper = units.to_si(stress.upper, units::dimension::pressure);
    if (setting.shear_rate != 0 && !oscillates)
      snapshot.relative_viscosity = (stress.lower - stress.upper) / 2 / (viscosity * setting.shear_rate);
  }
  if (scene::walls_move(*setting.stage)) {
    const core::WallVelocity& walls = fluid.last_walls();
    snapshot.shear_rate = units.to_si((walls.upper - walls.lower) / scene_->domain.nodes[1], units::dimension::rate);
  }
  if (is_driven_channel(setting, *scene_)) {
    const double rate = flow_rate(fluid);
    if (!oscillates)
      snapshot.relative_viscosity = apparent_viscosity(rate / scene::duct_share(scene_->domain),
                                                       fluid.setting().body_force[0], setting, scene_->domain.nodes[1]);
    snapshot.flow_rate = units.to_si(rate, units::dimension::velocity) * units.length;
  }
  if (setting.stage->pressure_gradient.x() != 0 || setting.stage->mean_velocity ||
      setting.oscillation.body_force_x != 0) {
    snapshot.pressure_gradient =
        units.to_si(fluid.setting().body_force[0], units::dimension::force_density) - scene_->fluid.body_force.x();
  }
  if (!membranes.cells.empty()) {
    if (!scene_->domain.periodic_y) {
      const auto layer = cell_free_layer(membranes, domain_);
      snapshot.cell_free_layer_lower = layer.lower * units.length;
      snapshot.cell_free_layer_upper = layer.upper * units.length;
    }
    // In layers a cell's share in the stress is not a matter of its membrane alone.
    snapshot.particle_stress =
        scene_->fluid.layers.empty()
            ? units.to_si(particle_stress(membranes, *scene_, viscosity), units::dimension::pressure)
            : std::numeric_limits<double>::quiet_NaN();
    observe_cells(membranes, units, snapshot);
    snapshot.area_drift_max = follow_area(membranes);
    snapshot.area_leakage_max = area_leakage(membranes);
    std::vector<double> tension;
    solver.tensions(tension);
    const double tension_unit = units.to_si(1, units::dimension::tension);
    OutlineSnapshot& outlines = snapshot.outlines;
    for (const core::CellRange& cell : membranes.cells) outlines.first.push_back(cell.first);
    outlines.first.push_back(membranes.node_count());
    for (std::size_t i = 0; i < membranes.x.size(); ++i) {
      outlines.x.push_back(units::coordinate(membranes.x[i], units.length));
      outlines.y.push_back(units::coordinate(membranes.y[i], units.length));
      outlines.tension.push_back(tension[i] * tension_unit);
    }
  }
  snapshot.energy = observe_energy(solver, membranes, units);
  if (with_fields) snapshot.fields = observe_fields(solver.fluid(), *scene_, units);
  return snapshot;
}

void Observer::start_stage() { initial_mass_ = std::nan(""); }

template Snapshot Observer::observe(core::Solver<float>&, const plan::StageSetting&, const core::Membranes&, bool);
template Snapshot Observer::observe(core::Solver<double>&, const plan::StageSetting&, const core::Membranes&, bool);
template Snapshot Observer::observe(core::Solver<float, core::D3Q19>&, const plan::StageSetting&,
                                    const core::Membranes&, bool);
template Snapshot Observer::observe(core::Solver<double, core::D3Q19>&, const plan::StageSetting&,
                                    const core::Membranes&, bool);
template double Observer::follow_fluid(core::Fluid<float>&);
template double Observer::follow_fluid(core::Fluid<double>&);
template double Observer::follow_fluid(core::Fluid<float, core::D3Q19>&);
template double Observer::follow_fluid(core::Fluid<double, core::D3Q19>&);

}  // namespace rouleau::observe
