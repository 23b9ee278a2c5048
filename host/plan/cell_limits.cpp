#include "cell_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/text.hpp"
#include "constants.hpp"
#include "core/contact/cell_grid.hpp"
#include "core/contact/triangle_contacts.hpp"
#include "core/contact/wall_gap.hpp"
#include "core/membrane/geometry.hpp"
#include "placed_cells.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"
#include "shape/extent.hpp"

namespace rouleau::plan {

LimitedStage::LimitedStage(const Plan& of, const scene::StageSetting& setting)
    : plan(of),
      scene(*of.scene),
      stage(setting),
      facts(of.facts.stages[setting.index]),
      by_dimension(scene.domain.dimension() - 2),
      most_viscous_tau(relaxation_time_of(scene::viscosity_range(scene.fluid).most, scene)),
      where(" (stage " + stage.stage->name + ")"),
      lower("lower " + stage.stage->density_factor_key) {
  const bool chosen = plan.numerics_choice && plan.numerics_choice->has(stage.stage->density_factor_key);
  density = stage.stage->has_own_density_factor() && !chosen ? RemediedBy::nothing : RemediedBy::density_factor;
}

bool reports_moments(const Plan& plan) {
  if (plan.numerics_choice) return plan.has_cells && !plan.numerics_choice->steady;
  if (plan.scene->cells.size() != 1) return plan.has_cells;
  const scene::Shape& shape = plan.scene->cell_types[plan.scene->cells.front().type].shape;
  return !std::holds_alternative<scene::Circle>(shape) && !std::holds_alternative<scene::Sphere>(shape);
}

void add_compression(const LimitedStage& of, LimitList& limits) {
  if (of.facts.shear_rate > 0) {
    limits.below("compression of cells by the shear" + of.where,
                 compression_by_shear(of.most_viscous_tau, of.facts.shear_rate * of.stage.units.time),
                 largest_compression_by_shear, of.lower + " or numerics.tau: pressure compresses the lattice's fluid",
                 of.density);
  }
  if (const double compression = compression_by_held_force(of.stage, of.scene); compression > 0) {
    limits.below("compression of cells by a force across walls" + of.where, compression, largest_compression_by_shear,
                 of.lower + " or fluid.body_force: the walls' pressure compresses the lattice's fluid", of.density);
  }
  if (of.stage.openings) {  // from one to the other
    limits.below("compression of cells by the pressure between openings" + of.where,
                 compression_by_pressure * std::abs(of.stage.body_force[of.scene.domain.open_axis]) *
                     of.scene.domain.nodes[of.scene.domain.open_axis],
                 largest_compression_by_shear, of.lower + ": pressure compresses the lattice's fluid", of.density);
  }
}

/// Of second order in the spacing.
void add_leak(const LimitedStage& of, LimitList& limits) {
  const double leak = (of.scene.cells.size() > 1 ? leak_of_many : leak_of_one)[of.by_dimension];
  if (!(of.facts.shear_rate > 0 && leak > 0)) return;
  const bool kept = of.scene.numerics.area_correction;
  const double radius = shape::smallest_radius(of.scene) / scene::lattice_spacing(of.scene);
  const double of_strain = leak / (radius * radius);
  limits.below((kept ? "volume kept in a cell while the flow strains by 1, as measured"
                     : "volume that a cell is expected to leak") +
                   of.where,
               of_strain * (kept ? 1 : of.facts.strain), of.scene.checks.area_drift,
               kept ? "raise the resolution" : "set numerics.area_correction to true, or raise the resolution",
               RemediedBy::resolution);
}

void add_travel(const LimitedStage& of, LimitList& limits) {
  const auto add = [&](const char* what, double travel) {
    limits.below(std::string("Reynolds number of cells that ") + what + ", without convective inertia" + of.where,
                 travel, largest_travel,
                 of.lower + ", or set fluid.inertia to true: cells would drift across the flow wrongly", of.density);
  };
  const CellTravel& travel = of.facts.travel;
  if (!frame_follows[of.by_dimension] && travel.mean > 0) add("move through the lattice", travel.mean);
  if (travel.spread > 0) add("pass each other", travel.spread);
}

/// By Stokes' drag on a sphere; of a cylinder, which has none of its own, in the box.
void add_forces_on_cells(const LimitedStage& of, LimitList& limits) {
  const scene::Stage& stage = *of.stage.stage;
  const scene::Vector& gravity = of.scene.fluid.gravity;
  if (stage.forces.empty() && gravity == scene::Vector()) return;
  const int dimension = of.scene.domain.dimension();
  const double radius = shape::smallest_radius(of.scene), box = of.scene.domain.size.least();
  const double pi = std::numbers::pi, viscosity = of.scene.fluid.viscosity;
  const double drag =
      viscosity * std::array{4 * pi / std::max(1.0, std::log(box / radius)), 6 * pi * radius}[of.by_dimension];
  double patch = 0, cell = 0;  // speeds, m/s
  for (const scene::CellForce& pull : stage.forces)
    patch = std::max(
        patch, std::max(pull.force.norm(), pull.before.norm()) / drag / std::pow(pull.share, 1.0 / (dimension - 1)));
  for (std::size_t c = 0; c < of.scene.cells.size(); ++c) {
    const scene::CellType& type = of.scene.cell_types[of.scene.cells[c].type];
    scene::Vector force = (type.interior_density - of.scene.fluid.density) * shape::enclosed_by(type) * gravity;
    for (const scene::CellForce& pull : stage.forces)
      force += (pull.pulls_at(static_cast<int>(c)) ? 1 : 0) * pull.force;
    cell = std::max(cell, force.norm() / drag);
  }
  if (patch > 0)
    limits.below("Mach number of membranes that forces pull at" + of.where,
                 units::mach_number(patch * of.stage.units.time / of.stage.units.length), largest_driven_mach,
                 of.lower + " or the force, or let it act on a larger patch", of.density);
  if (cell > 0 && !of.scene.fluid.inertia)
    limits.below("Reynolds number of cells that forces move, without convective inertia" + of.where,
                 of.scene.fluid.density * stage.density_factor * cell * radius / viscosity, largest_travel,
                 of.lower + ", or set fluid.inertia to true", of.density);
}

namespace {

double stretching_gain_of(const Plan& plan) {
  const scene::Numerics& n = plan.scene->numerics;
  const int by_dimension = plan.scene->domain.dimension() - 2;
  const bool sharp_contrast = plan.viscosity_contrast && membrane_coupling(n) == MembraneCoupling::sharp;
  return n.tau < least_tau_of_full_gain[by_dimension][n.slip_correction] ||
                 n.tau > most_tau_of_full_gain[by_dimension][sharp_contrast]
             ? cautious_stretching_gain
             : stretching_gain;
}

/// Red cells turn over later by up to half of that strain, at a strain of five: with no more than the target of auto
/// that is a tenth of the target.
double largest_held_strain_of(const Plan& plan) {
  if (!plan.numerics_choice) return largest_held_strain;
  return std::min(largest_held_strain / held_on_companions, plan.numerics_choice->target);
}

/// What a well squeezes cells with, where nothing keeps a cell's own faces apart.
void add_depth(const LimitedStage& of, std::size_t i, const std::string& named, const Well& well, LimitList& limits) {
  const scene::Interaction& interaction = of.scene.interactions[i];
  const double depth = depth_over_bending(of.plan, of.plan.facts, of.stage, interaction, well.depth);
  if (!(depth > 0)) return;
  limits.below("depth of " + named + " over bending modulus / radius^2, without a repulsion within membranes", depth,
               deepest_well_of_bare_cells[of.by_dimension],
               "cells that come to rest may be squeezed until their own faces touch; add an interaction between [" +
                   in_quotes(of.scene.cell_types[interaction.between[0]].name) +
                   ", \"self\"], such as \"repulsion\" with about three times the well's depth and a cutoff below the "
                   "cells' least thickness");
}

/// Whether the lattice resolves the potential.
void add_lengths(const PotentialShape& shape, bool wall, const std::string& named, LimitList& limits) {
  constexpr RemediedBy resolution = RemediedBy::resolution;
  if (!shape.well) {
    limits.above("range of the repulsion of " + named + " in lattice spacings", shape.range, least_gap,
                 std::string("raise the resolution or the range: nearer than that the lattice ") +
                     (wall ? "holds a membrane to the wall" : "moves two membranes together") +
                     ", whatever acts between them",
                 resolution);
    return;
  }
  limits.above(
      "equilibrium gap of " + named + " in lattice spacings", shape.well->distance, least_gap,
      std::string("raise the resolution or move the well outwards: where the lattice does not resolve the gap, "
                  "membranes ") +
          (wall ? "never leave the wall" : "never separate"),
      resolution);
  limits.above("width of the well of " + named + " in lattice spacings", shape.well->width(),
               wall ? narrowest_well_of_a_wall : narrowest_well,
               std::string("raise the resolution or take a wider well: the corners of membranes catch ") +
                   (wall ? "in" : "on each other in") + " a narrow one",
               resolution);
}

/// Smallest gaps at the start, lattice spacings; infinite where nothing is near.
struct StartGaps {
  double cells = std::numeric_limits<double>::infinity();  ///< between two cells, images included
  double walls = cells;                                    ///< to plane walls
  double region = cells;                                   ///< to the wall of a tube, or of any shape, however far
};
constexpr double gap_reach = 2;  // spacings

double gap_between(const core::Membranes& cells, const core::Domain<2>& domain) {
  const core::CellGrid<2> grid(core::boxes_of<2>(cells), gap_reach, domain);
  double gap = std::numeric_limits<double>::infinity();
  std::vector<int> near;
  for (int cell = 0; cell < cells.cell_count(); ++cell) {
    grid.find(cell, near);
    for (const int other : near) gap = std::min(gap, core::smallest_gap(cells, cell, other, domain, gap_reach));
  }
  return gap;
}

double gap_between(const core::Surfaces& cells, const core::Domain<3>& domain) {
  const core::TriangleContacts contacts = core::TriangleContacts::within(gap_reach, cells, domain);
  double gap = std::numeric_limits<double>::infinity();
  std::vector<core::TriangleContact> of_cell;
  for (int cell = 0; cell < cells.cell_count(); ++cell) {
    contacts.find(cell, cells, of_cell);
    for (const core::TriangleContact& contact : of_cell) gap = std::min(gap, contact.distance);
  }
  return gap;
}

template <int D>
void measure(const scene::Scene& scene, StartGaps& gaps) {
  const core::Cells<D> cells = make_known_cells<D>(scene, [](int) { return true; });
  const core::Domain<D> domain = scene::lattice_domain<D>(scene);
  gaps.cells = std::min(gaps.cells, gap_between(cells, domain));
  if (const core::RegionPointer<D> region = scene::fluid_region<D>(scene))
    for (const core::CellRange& cell : cells.cells)
      gaps.region = std::min(gaps.region, core::nearest_to_border(cells, cell, *region).distance);
  if (scene.domain.tube_radius) return;
  const auto& places = cells.position;
  for (int k = 1; k < D; ++k) {
    if (!domain.walled(k)) continue;
    const auto [least, most] = std::minmax_element(places[k].begin(), places[k].end());
    const double gap = std::min(*least + 0.5, domain.size[k] - 0.5 - *most);
    if (gap < gap_reach) gaps.walls = std::min(gaps.walls, gap);
  }
}

/// Of cells that are nearer than two spacings. Cells at random, which need not have been placed, count with the gap
/// that they keep, in a tube and between walls of any shape always, else where it is below the least one. Of more than
/// 20 000 others gaps are not looked for: the file that has them is taken as it is.
StartGaps start_gaps(const scene::Scene& scene) {
  constexpr std::size_t most = 20'000;
  StartGaps gaps;
  scene::Scene placed = scene;
  placed.cells.resize(scene.placed().size());
  placed.fed = 0;
  for (auto packing = scene.packings.rbegin(); packing != scene.packings.rend(); ++packing) {
    const auto first = placed.cells.begin() + packing->first;
    placed.cells.erase(first, first + packing->count);
    const double gap = packing->gap / scene::lattice_spacing(scene);
    if (scene.domain.tube_radius || scene.domain.has_shapes()) gaps.region = std::min(gaps.region, gap);
    if (!(gap < least_gap_at_start)) continue;
    gaps.cells = std::min(gaps.cells, gap);
    if (scene::has_walls(scene.domain) && !scene.domain.tube_radius) gaps.walls = std::min(gaps.walls, gap);
  }
  if (placed.cells.empty() || placed.cells.size() > most) return gaps;
  scene::in_dimension(scene.domain.dimension(),
                      [&]<int D>(std::integral_constant<int, D>) { measure<D>(placed, gaps); });
  return gaps;
}

}  // namespace

void add_stiffness(const LimitedStage& of, LimitList& limits) {
  const Plan& plan = of.plan;
  const ModelFacts& membrane = *of.facts.models;
  const bool gains = plan.semi_implicit && semi_implicit_gains(of.scene);
  const std::string coupled = plan.semi_implicit ? ", semi-implicit step" : " in lattice units";
  const bool zigzags = kernel_named(of.scene.numerics.kernel).semi_implicit_from == nowhere;
  const std::string softer = of.lower + ", with which the lattice stiffness falls" +
                             (zigzags              ? ", or set numerics.kernel to \"peskin4\""
                              : plan.semi_implicit ? ""
                                                   : ", or set numerics.coupling to \"semi-implicit\"");
  const double loss = plan.semi_implicit && zigzags ? semi_implicit_loss : 1;
  limits.below("stretching stiffness" + coupled + of.where, membrane.stretching.value,
               (gains ? stretching_gain_of(plan) : loss) * membrane.stretching.limit, softer, of.density);
  limits.below("bending stiffness" + coupled + of.where, membrane.bending.value,
               (gains ? bending_gain : loss) * membrane.bending.limit, softer, of.density);
  if (gains && of.facts.shear_rate > 0 && membrane.steps_of_mean > 0) {
    limits.below("strain during which the semi-implicit step holds forces" + of.where,
                 membrane.steps_of_mean * of.facts.shear_rate * of.stage.units.time, largest_held_strain_of(plan),
                 of.lower + ": membranes turn against the forces that they hold", of.density, 2);
  }
}

void add_slip_and_prestress(const LimitedStage& of, LimitList& limits) {
  const ModelFacts& membrane = *of.facts.models;
  if (membrane.slip_smoothing > 0 && of.facts.shear_rate > 0 && reports_moments(of.plan)) {
    limits.below("smoothing of the slip, variance over radius^2" + of.where, membrane.slip_smoothing,
                 of.plan.numerics_choice ? of.plan.numerics_choice->target : largest_slip_smoothing,
                 of.lower +
                     " or raise the resolution: stiff membranes need their slip smoothed, and cells turn over late, or "
                     "early, by half of this",
                 of.density);
  }
  if (membrane.prestress_compression > 0) {
    limits.below("compression of cells by their prestress, 3 T/a" + of.where, membrane.prestress_compression,
                 largest_compression_by_prestress,
                 of.lower + ": pressure compresses the lattice's fluid the more, the longer the time step", of.density);
  }
}

void add_potentials(const LimitedStage& of, LimitList& limits) {
  const std::vector<PlannedModel>& interactions = of.plan.interactions;
  for (std::size_t i = 0; i < interactions.size(); ++i) {
    if (!of.facts.models->potentials[i]) continue;  // left out; or its stiffness is a matter of what it remembers
    const PotentialShape& shape = *of.facts.models->potentials[i];
    const PlannedModel& model = interactions[i];
    const auto same = [&](const PlannedModel& other) { return other.manifest->id == model.manifest->id; };
    const bool several = std::count_if(interactions.begin(), interactions.end(), same) > 1;
    const std::string named = model.manifest->id + (several ? " (" + of.plan.owner_of(model) + ")" : "");
    limits.below("contact stiffness of " + named + " in lattice units" + of.where, shape.stiffness,
                 interpolate(contact_limit, of.scene.numerics.tau),
                 of.lower + ", with which the lattice stiffness falls", of.density);
    const bool resolved_well = shape.well && shape.well->distance >= least_gap;
    if (resolved_well) {
      limits.below("compression by the attraction of " + named + of.where, 3 * shape.well->attraction,
                   largest_compression_by_attraction,
                   of.lower + ": the lattice's fluid gives way to it, and cells leak while they snap together",
                   of.density);
    }
    if (of.stage.index != 0) continue;
    const bool wall = of.scene.interactions[i].with_wall(), self = of.scene.interactions[i].with_self();
    if (resolved_well && !wall && !self && of.scene.cells.size() > 1) add_depth(of, i, named, *shape.well, limits);
    add_lengths(shape, wall, named, limits);
  }
}

void add_gaps(const LimitedStage& of, LimitList& limits) {
  const StartGaps gaps = start_gaps(of.scene);
  limits.above(
      "gap between cells, as placed, in lattice spacings", gaps.cells, least_gap_at_start,
      "move them apart, or raise the resolution: nearer than that the lattice moves two membranes together, and "
      "what acts between them throws them apart or never parts them");
  limits.above("gap between cells, as placed, and a wall in lattice spacings", gaps.walls, least_gap_at_start,
               "move cells away from the wall, or raise the resolution: nearer than that the lattice holds them to it");
  const bool tube = of.scene.domain.tube_radius.has_value();
  limits.above(std::string("gap between cells, as placed, and ") +
                   (tube ? "the wall of the tube" : "a wall of any shape") + " in lattice spacings",
               gaps.region, least_gap_to_tube,
               std::string("raise the resolution, or move cells ") + (tube ? "towards the axis" : "away from it") +
                   ": nearer than that they move too fast, on the wall "
                   "by a third of a spacing times the shear rate",
               RemediedBy::resolution);
}

void add_resolution(const LimitedStage& of, LimitList& limits) {
  limits.above("cell radius in lattice spacings", shape::smallest_radius(of.scene) / of.stage.units.length,
               least_radii(of.scene, membrane_coupling(of.scene.numerics)).run,
               "raise the resolution; results are converged from about 20", RemediedBy::resolution);
  double shortest = 1e300, longest = 0;
  for (const scene::CellPlacement& cell : of.scene.cells) {
    const double segment = of.plan.facts.types[cell.type].node_spacing / of.stage.units.length;
    shortest = std::min(shortest, segment);
    longest = std::max(longest, segment);
  }
  const scene::DimensionWords& words = of.scene.domain.words();
  const std::string piece = words.segment, pieces = words.segments, best = words.best_segments;
  limits.above("shortest " + piece + " in lattice spacings", shortest, shortest_segment,
               "take fewer " + pieces + "; " + best + words.are_best);
  limits.below("longest " + piece + " in lattice spacings", longest, longest_segment,
               "take more " + pieces + ", " + best + ": fluid leaks between nodes that lie far apart");
}

}  // namespace rouleau::plan
