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

double enclosed(const core::Membranes& membranes, int cell) {
  return core::enclosed_area(membranes, membranes.cells[cell]);
}
double enclosed(const core::Surfaces& surfaces, int cell) {
  return core::enclosed_volume(surfaces.type_of(cell).mesh, surfaces.nodes(cell));
}

/// The node of a surface farthest from the line along z through its centroid: its angle about that line is told best.
int outermost(const core::Surfaces& surfaces, int cell) {
  const core::Nodes nodes = surfaces.nodes(cell);
  const core::Vec<3> center = core::inertia_ellipsoid(surfaces.type_of(cell).mesh, nodes).center;
  int farthest = 0;
  double distance = -1;
  for (int i = 0; i < surfaces.cells[cell].count; ++i) {
    const double here = std::hypot(nodes.x[i] - center.x(), nodes.y[i] - center.y());
    if (here > distance) distance = here, farthest = i;
  }
  return farthest;
}

/// Distance of a surface to the nearest wall, spacings, negative beyond it; NaN without walls. `tube_radius`: 0 without one.
double wall_gap(const core::Surfaces& surfaces, int cell, const core::Domain<3>& domain, double tube_radius) {
  if (tube_radius > 0) return tube_radius - core::farthest_from_axis(surfaces, cell, domain);
  const core::CellRange& range = surfaces.cells[cell];
  const std::vector<double>* const along[] = {&surfaces.x, &surfaces.y, &surfaces.z};
  double gap = std::numeric_limits<double>::infinity();
  for (int axis = 1; axis < 3; ++axis) {
    if (!domain.walled(axis)) continue;
    const auto [least, most] =
        std::minmax_element(along[axis]->begin() + range.first, along[axis]->begin() + range.end());
    gap = std::min({gap, *least + 0.5, domain.size[axis] - 0.5 - *most});
  }
  return std::isinf(gap) ? std::nan("") : gap;
}

/// An axis has no direction: the one whose first component that is not 0 is positive.
std::array<double, 3> pointed(const core::Vec<3>& axis) {
  const double sign = axis.x() < 0 || (axis.x() == 0 && (axis.y() < 0 || (axis.y() == 0 && axis.z() < 0))) ? -1 : 1;
  return {sign * axis.x(), sign * axis.y(), sign * axis.z()};
}

void count_aggregates(const Aggregates& aggregates, Snapshot& snapshot) {
  snapshot.aggregate_count = aggregates.count;
  snapshot.aggregate_sizes = aggregate_sizes(aggregates.label);
  snapshot.aggregate_size_number_mean = number_mean(snapshot.aggregate_sizes);
  snapshot.aggregate_size_weight_mean = weight_mean(snapshot.aggregate_sizes);
}

/// Adds places, tensions and, of surfaces, curvatures and triangles.
template <class T>
void draw(core::OutlineTasks<T>& tasks, const core::Membranes& membranes, const units::LatticeUnits& units,
          OutlineSnapshot& outlines) {
  tasks.forces().tensions(membranes, outlines.tension);
  for (double& tension : outlines.tension) tension *= units.to_si(1, units::dimension::tension);
}
template <class T>
void draw(core::SurfaceTasks<T>& tasks, const core::Surfaces& surfaces, const units::LatticeUnits& units,
          OutlineSnapshot& outlines) {
  for (const double z : surfaces.z) outlines.z.push_back(units::coordinate(z, units.length));
  const double tension_unit = units.to_si(1, units::dimension::tension);
  for (int k = 0; k < surfaces.cell_count(); ++k) {
    const core::Mesh& mesh = surfaces.type_of(k).mesh;
    const std::vector<double> of_triangle = tasks.forces().tensions(surfaces, k);
    for (int i = 0; i < mesh.node_count(); ++i) {
      const auto begin = static_cast<std::size_t>(mesh.corners().first[i]),
                 end = static_cast<std::size_t>(mesh.corners().first[i + 1]);
      double sum = 0;
      for (std::size_t c = begin; c < end; ++c) sum += of_triangle[mesh.corners().entry[c] / 3];
      outlines.tension.push_back(sum / static_cast<double>(end - begin) * tension_unit);
    }
    const std::vector<double> area = core::node_areas(mesh, surfaces.nodes(k));
    std::size_t i = 0;
    for (const double integral : core::integrated_curvature(mesh, surfaces.nodes(k)))
      outlines.curvature.push_back(integral / area[i++] / units.length);
    const int first = surfaces.cells[k].first;
    for (const auto& [a, b, c] : mesh.triangles()) outlines.triangles.push_back({first + a, first + b, first + c});
  }
}

}  // namespace

Observer::Observer(const scene::Scene& scene) : scene_(&scene), domain_(plan::lattice_domain(scene)) {}

template <class Cells>
void Observer::begin_with(const Cells& cells) {
  for (int k = 0; k < cells.cell_count(); ++k) {
    angle_.push_back(scene_->cells[angle_.size()].angle);
    tank_treading_angle_.push_back(0);
    initial_area_.push_back(enclosed(cells, k));
    if constexpr (std::is_same_v<Cells, core::Surfaces>) marker_.push_back(outermost(cells, k));
  }
}

template <class Cells>
double Observer::follow_area(const Cells& cells, int* whose) {
  double most = 0;
  for (int k = 0; k < cells.cell_count(); ++k) {
    const double drift = std::abs(enclosed(cells, k) / initial_area_[k] - 1);
    if (drift > most || !std::isfinite(drift)) {
      most = drift;
      if (whose != nullptr) *whose = k;
    }
  }
  area_drift_max_ = std::max(area_drift_max_, most);
  return most;
}

double Observer::area_leakage(const core::CellNodes& cells, int* whose) {
  if (cells.area_leakage.empty()) return std::nan("");
  double most = 0;
  for (std::size_t k = 0; k < cells.area_leakage.size(); ++k) {
    const double leakage = std::abs(cells.area_leakage[k]);
    if (leakage > most || !std::isfinite(leakage)) {
      most = leakage;
      if (whose != nullptr) *whose = static_cast<int>(k);
    }
  }
  return most;
}

double Observer::momentum_residual(const core::CellNodes& m, double from_walls) {
  double net_x = 0, net_y = -from_walls, net_z = 0, magnitudes = 0;
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    const double along_z = m.z.empty() ? 0 : m.force_z[i];
    net_x += m.force_x[i];
    net_y += m.force_y[i];
    net_z += along_z;
    magnitudes += std::hypot(std::hypot(m.force_x[i], m.force_y[i]), along_z);
  }
  return magnitudes > 0 ? std::hypot(std::hypot(net_x, net_y), net_z) / magnitudes : 0;
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
  count_aggregates(aggregates, snapshot);
  for (const CellContact& c : contacts) {
    snapshot.contacts.push_back(
        {c.cell_a, c.cell_b, {c.image.x, c.image.y, 0}, c.gap * length, c.contact_length * length});
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
    CellSnapshot s;
    follow_angles(k, round ? std::nullopt : std::optional(ellipse.angle), marker, s);
    s.cell = static_cast<int>(k);
    s.type = scene_->cell_types[cell.type].name;
    s.x = units::coordinate(c.x(), length);
    s.y = units::coordinate(c.y(), length);
    s.deformation = ellipse.deformation;
    s.area = core::enclosed_area(membranes, cell) * length * length;
    s.perimeter = core::perimeter(membranes, cell) * length;
    s.min_gap = gaps[k] * length;
    s.wall_gap = wall_gap(membranes, cell, domain_) * length;
    s.aggregate = aggregates.label[k];
    s.through_image = aggregates.through_image[k];
    follow_stretch(core::stretch_range(membranes, cell), s);
    snapshot.cells.push_back(std::move(s));
  }
  snapshot.rotation = rotation_.follow(contacts, aggregates, centers, domain_);
  started_ = true;
}

void Observer::observe_cells(const core::Surfaces& surfaces, const units::LatticeUnits& units, Snapshot& snapshot) {
  const double length = units.length;
  const core::Domain<3> domain = plan::lattice_domain<3>(*scene_);
  const auto contacts = find_touching_cells(surfaces, domain, scene_->output.aggregate_gap / length);
  const Aggregates aggregates = find_aggregates(surfaces.cell_count(), contacts);
  for (const CellContact& c : contacts) {
    snapshot.contacts.push_back({c.cell_a,
                                 c.cell_b,
                                 {c.image.x, c.image.y, c.image.z},
                                 c.gap * length,
                                 std::nan(""),
                                 c.contact_length * length * length});
  }
  const std::vector<double> gaps = smallest_gaps(surfaces, domain);
  std::vector<Eigen::Vector2d> centers;  // as seen along z
  count_aggregates(aggregates, snapshot);
  for (int k = 0; k < surfaces.cell_count(); ++k) {
    const core::Mesh& mesh = surfaces.type_of(k).mesh;
    const core::Nodes nodes = surfaces.nodes(k);
    const core::InertiaEllipsoid ellipsoid = core::inertia_ellipsoid(mesh, nodes);
    const core::PlaneDeformation plane = core::deformation_in_xy(ellipsoid);
    const core::Vec<3> marker = nodes[marker_[k]] - ellipsoid.center;
    centers.emplace_back(ellipsoid.center.x(), ellipsoid.center.y());
    CellSnapshot s;
    follow_angles(static_cast<std::size_t>(k), plane.deformation > roundest ? std::optional(plane.angle) : std::nullopt,
                  std::atan2(marker.y(), marker.x()), s);
    s.cell = k;
    s.type = scene_->cell_types[surfaces.cells[k].type].name;
    s.x = units::coordinate(ellipsoid.center.x(), length);
    s.y = units::coordinate(ellipsoid.center.y(), length);
    s.deformation = plane.deformation;
    s.area = s.perimeter = std::nan("");
    s.min_gap = gaps[k] * length;
    s.wall_gap = wall_gap(surfaces, k, domain, scene_->domain.tube_radius.value_or(0) / length) * length;
    s.aggregate = aggregates.label[k];
    s.through_image = aggregates.through_image[k];
    follow_stretch(core::stretch_range(surfaces, k), s);
    CellSnapshot::InSpace& space = s.in_space.emplace();
    space.z = units::coordinate(ellipsoid.center.z(), length);
    space.volume = core::enclosed_volume(mesh, nodes) * length * length * length;
    space.surface_area = core::surface_area(mesh, nodes) * length * length;
    for (std::size_t axis = 0; axis < 3; ++axis) space.semi_axes[axis] = ellipsoid.semi_axes[axis] * length;
    space.short_axis = pointed(ellipsoid.axes[2]);
    snapshot.cells.push_back(std::move(s));
  }
  snapshot.rotation = rotation_.follow(contacts, aggregates, centers, domain_);
  started_ = true;
}

/// `angle`: of the long axis; none where there is no long axis.
void Observer::follow_angles(std::size_t cell, std::optional<double> angle, double marker, CellSnapshot& snapshot) {
  double& treaded = tank_treading_angle_[cell];
  if (angle) angle_[cell] = continued(*angle, angle_[cell], std::numbers::pi);
  treaded = started_ ? continued(marker, treaded, 2 * std::numbers::pi) : marker;
  snapshot.angle = angle ? angle_[cell] : std::nan("");
  snapshot.tank_treading_angle = treaded;
}

void Observer::follow_stretch(const core::StretchRange& stretch, CellSnapshot& snapshot) {
  snapshot.stretch_min = stretch.least;
  snapshot.stretch_max = stretch.most;
  stretch_.least = std::min(stretch_.least, stretch.least);
  stretch_.most = std::max(stretch_.most, stretch.most);
}

template <class T, class Set>
Snapshot Observer::observe(core::Solver<T, Set>& solver, const plan::StageSetting& setting,
                           const typename core::Solver<T, Set>::Cells& cells, bool with_fields) {
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
  if (!cells.cells.empty() && solver.ranks().first()) {
    if constexpr (Set::dimension == 2) {
      if (!scene_->domain.periodic_y) {
        const auto layer = cell_free_layer(cells, domain_);
        snapshot.cell_free_layer_lower = layer.lower * units.length;
        snapshot.cell_free_layer_upper = layer.upper * units.length;
      }
    }
    // In layers a cell's share in the stress is not a matter of its membrane alone.
    snapshot.particle_stress = scene_->fluid.layers.empty()
                                   ? units.to_si(particle_stress(cells, *scene_, viscosity), units::dimension::pressure)
                                   : std::numeric_limits<double>::quiet_NaN();
    observe_cells(cells, units, snapshot);
    snapshot.area_drift_max = follow_area(cells);
    snapshot.area_leakage_max = area_leakage(cells);
    OutlineSnapshot& outlines = snapshot.outlines;
    for (const core::CellRange& cell : cells.cells) outlines.first.push_back(cell.first);
    outlines.first.push_back(cells.node_count());
    for (const double x : cells.x) outlines.x.push_back(units::coordinate(x, units.length));
    for (const double y : cells.y) outlines.y.push_back(units::coordinate(y, units.length));
    draw(*solver.cell_tasks(), cells, units, outlines);
  }
  snapshot.energy = observe_energy(solver, units);
  if (with_fields) snapshot.fields = observe_fields(solver.fluid(), *scene_, units);
  return snapshot;
}

void Observer::start_stage() { initial_mass_ = std::nan(""); }

template void Observer::begin_with(const core::Membranes&);
template void Observer::begin_with(const core::Surfaces&);
template double Observer::follow_area(const core::Membranes&, int*);
template double Observer::follow_area(const core::Surfaces&, int*);
template Snapshot Observer::observe(core::Solver<float>&, const plan::StageSetting&, const core::Membranes&, bool);
template Snapshot Observer::observe(core::Solver<double>&, const plan::StageSetting&, const core::Membranes&, bool);
template Snapshot Observer::observe(core::Solver<float, core::D3Q19>&, const plan::StageSetting&, const core::Surfaces&,
                                    bool);
template Snapshot Observer::observe(core::Solver<double, core::D3Q19>&, const plan::StageSetting&,
                                    const core::Surfaces&, bool);
template double Observer::follow_fluid(core::Fluid<float>&);
template double Observer::follow_fluid(core::Fluid<double>&);
template double Observer::follow_fluid(core::Fluid<float, core::D3Q19>&);
template double Observer::follow_fluid(core::Fluid<double, core::D3Q19>&);

}  // namespace rouleau::observe
