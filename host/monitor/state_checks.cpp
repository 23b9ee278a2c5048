#include "state_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"
#include "contact_remedy.hpp"
#include "core/contact/crossing.hpp"
#include "core/membrane/geometry.hpp"
#include "node_checks.hpp"
#include "plan/constants.hpp"
#include "plan/limits.hpp"
#include "scene/driving_flow.hpp"
#include "shape/extent.hpp"

namespace rouleau::monitor {

namespace {

Failure failure(std::string reason, const scene::Vector& place, int cell, double value, double limit,
                std::string message, std::string remedy) {
  return {.reason = std::move(reason),
          .place = place,
          .cell = cell,
          .value = value,
          .limit = limit,
          .message = std::move(message),
          .remedy = std::move(remedy)};
}

/// What else helps a membrane that is too stiff for the time step, if it is not so yet.
std::string explicit_remedy(const plan::Plan& plan) {
  const bool can = plan::kernel_named(plan.scene->numerics.kernel).semi_implicit_from != INFINITY;
  return can && !plan.semi_implicit ? " or set numerics.coupling to \"semi-implicit\"" : "";
}

/// What to do first about a cell that leaks, if its segments or edges (mean length in spacings) are the reason.
std::string leak_remedy(double length, const scene::DimensionWords& words) {
  if (!(length > plan::longest_segment)) return "";
  return std::string("take more ") + words.segments + " (this cell's " + words.edges_are + number(length, 2) +
         " lattice spacings long, and fluid leaks between nodes that lie more than " + number(plan::longest_segment) +
         " apart; about one for each spacing is best), ";
}

/// Node with the first value that is no number, else the one with the largest speed; on all ranks.
template <int D>
std::array<double, D> extreme_node(const core::AnyFluid<D>& fluid) {
  using Moments = core::Moments<D>;
  std::size_t extreme = 0, node = 0;
  double fastest = -1;
  bool finite = true;
  fluid.gather_moments(core::bands_of_all<D>(fluid.setting().domain.size, sizeof(Moments)),
                       [&](int, const std::vector<Moments>& moments) {
                         for (auto m = moments.begin(); finite && m != moments.end(); ++m, ++node) {
                           double square = 0;
                           for (const double u : m->velocity) square += u * u;
                           finite = std::isfinite(square) && std::isfinite(m->density);
                           if (!finite || square > fastest) extreme = node;
                           fastest = std::max(fastest, square);
                         }
                       });
  std::array<double, D> place;
  for (int k = 0; k < D; ++k) {
    const auto size = static_cast<std::size_t>(fluid.setting().domain.size[k]);
    place[k] = static_cast<double>(extreme % size);
    extreme /= size;
  }
  const std::vector<double> of_first = core::of_first(fluid.ranks(), std::vector<double>(place.begin(), place.end()));
  std::copy(of_first.begin(), of_first.end(), place.begin());
  return place;
}

/// Of a piece of a membrane, segment or edge, that is too short or too long.
Failure uneven_failure(const std::string& piece, int cell, double stretch, double limit, const scene::Stage& stage) {
  return failure("uneven_nodes", {0, 0}, cell, stretch, stretch < 1 ? 1 / limit : limit,
                 piece + (stretch < 1 ? " of a membrane has become too short against the length it was placed with"
                                      : " of a membrane has become too long against the length it was placed with"),
                 "lower " + stage.density_factor_key +
                     " or the load, stiffen the membrane, or raise checks.stretch if it is meant to give way so far");
}

/// The first of this rank's cells with an uneven segment.
std::optional<Failure> check_stretch(const core::Membranes& membranes, const scene::Scene& scene,
                                     const scene::Stage& stage, const units::LatticeUnits& units) {
  const double limit = scene.checks.stretch;
  for (const int k : membranes.own_cells()) {
    const core::CellRange& cell = membranes.cells[k];
    const core::RestShape& placed = membranes.type_of(cell);
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(cell.next(i));
      const double dx = membranes.position[0][to] - membranes.position[0][from],
                   dy = membranes.position[1][to] - membranes.position[1][from];
      const double stretch = std::hypot(dx, dy) / placed.first_length(static_cast<std::size_t>(i - cell.first));
      if (stretch <= limit && stretch * limit >= 1) continue;
      Failure found = uneven_failure("a segment", k, stretch, limit, stage);
      found.place = {units::coordinate(membranes.position[0][from], units.length),
                     units::coordinate(membranes.position[1][from], units.length)};
      return found;
    }
  }
  return std::nullopt;
}

Failure crossing_failure(int cell, int other, bool inside, const plan::Plan& plan, const scene::StageSetting& stage) {
  return failure("crossing", {0, 0}, cell, 0, 0,
                 cell == other ? "the membrane of a cell crosses itself"
                               : "the membranes of cells " + std::to_string(cell) + " and " + std::to_string(other) +
                                     (inside ? " lie one inside the other" : " cross"),
                 crossing_remedy(plan, stage, cell, other));
}

/// The cell whose area, or volume, has changed most, or would have without the correction.
struct Drift {
  int cell = -1;
  double share = 0;
  bool corrected = false;
};
template <class Cells, int D>
Drift largest_drift(observe::Observer& observer, const Cells& cells, const core::Ranks<D>& ranks) {
  Drift largest;
  largest.share = observer.follow_area(cells, ranks, &largest.cell);
  // Where areas are kept, the correction that this took is the leak.
  int leaking = -1;
  const double leakage = observe::Observer::area_leakage(cells, ranks, &leaking);
  if (leakage > largest.share) largest = {leaking, leakage, true};
  return largest;
}

/// What an area or a volume that drifts means, and what to do about it.
Failure drift_failure(const Drift& drift, const plan::Plan& plan, const scene::StageSetting& setting) {
  const scene::Scene& scene = *plan.scene;
  const std::string measure = scene.domain.words().content;
  const double spacing = shape::node_spacing(scene.cell_types[scene.cells[drift.cell].type]);
  const bool flows = scene::mean_shear_rate(*setting.stage, scene) > 0;
  std::string remedy = attraction_remedy(plan, setting);
  if (remedy.empty()) {
    remedy = "raise the resolution";
    const double rate = scene::mean_shear_rate(*setting.stage, scene) * setting.units.time;
    if (plan::compression_by_shear(setting.tau, rate) > plan::largest_compression_by_shear)
      remedy = "lower " + setting.stage->density_factor_key + ", or " + remedy;
    if (!scene.numerics.area_correction) remedy = "set numerics.area_correction to true, or " + remedy;
  }
  const std::string said =
      drift.corrected ? "numerics.area_correction had to put back more of a cell's " + measure +
                            (flows ? " than the limit while the flow strained by 1: fluid leaks through its membrane"
                                   : " than the limit: fluid leaks through its membrane")
                      : "a cell has changed its " + measure +
                            " by more than the limit: fluid leaks through its membrane or is compressed";
  return failure("area_drift", {0, 0}, drift.cell, drift.share, scene.checks.area_drift, said,
                 leak_remedy(spacing / setting.units.length, scene.domain.words()) + remedy +
                     ", or raise checks.area_drift if this error is acceptable");
}

/// By the number of the cell, of which another rank has none.
std::array<double, 2> by_cell(const std::optional<Failure>& found) {
  return {found ? static_cast<double>(found->cell) : 0.0, 0.0};
}

std::optional<Failure> check_cells(observe::Observer& observer, const scene::StageSetting& setting,
                                   core::Surroundings<2>& around, const plan::Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const core::Membranes& membranes = around.cells();
  const core::Ranks<2> ranks = around.ranks();
  if (const Drift drift = largest_drift(observer, membranes, ranks); !(drift.share <= scene.checks.area_drift)) {
    std::optional<Failure> found;
    if (membranes.owns(drift.cell)) {
      found = drift_failure(drift, plan, setting);
      found->place = in_metres(core::centroid(membranes, membranes.cells[drift.cell]), 2, setting.units.length);
    }
    return first_failure(ranks, found, by_cell(found));
  }
  const std::optional<Failure> uneven = check_stretch(membranes, scene, *setting.stage, setting.units);
  if (auto first = first_failure(ranks, uneven, by_cell(uneven))) return first;
  std::optional<Failure> crosses;
  std::array<double, 2> order{};
  around.show(0);
  if (const auto crossing = core::find_crossing(membranes, observer.domain())) {
    crosses = crossing_failure(crossing->cell, crossing->other, crossing->inside, plan, setting);
    crosses->place = in_metres(crossing->place, 2, setting.units.length);
    order[0] = std::min(crossing->cell, crossing->other);
  }
  return first_failure(ranks, crosses, order);
}

std::optional<Failure> check_cells(observe::Observer& observer, const scene::StageSetting& setting,
                                   core::Surroundings<3>& around, const plan::Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const core::Surfaces& surfaces = around.cells();
  const core::Ranks<3> ranks = around.ranks();
  const double limit = scene.checks.stretch;
  const auto at = [&](Failure found, const core::Vec<3>& place) {
    found.place = in_metres(place, 3, setting.units.length);
    return found;
  };
  const auto middle = [&](int cell) {
    return core::inertia_ellipsoid(surfaces.type_of(cell).mesh, surfaces.nodes(cell)).center;
  };
  if (const Drift drift = largest_drift(observer, surfaces, ranks); !(drift.share <= scene.checks.area_drift)) {
    std::optional<Failure> found;
    if (surfaces.owns(drift.cell)) found = at(drift_failure(drift, plan, setting), middle(drift.cell));
    return first_failure(ranks, found, by_cell(found));
  }
  std::optional<Failure> uneven;
  for (const int k : surfaces.own_cells()) {
    if (uneven) break;
    const core::StretchRange stretch = core::stretch_range(surfaces, k, surfaces.type_of(k).nodes());
    const bool shrunk = !(stretch.least * limit >= 1);
    if (!shrunk && stretch.most <= limit) continue;
    uneven = at(uneven_failure("an edge", k, shrunk ? stretch.least : stretch.most, limit, *setting.stage), middle(k));
  }
  if (auto first = first_failure(ranks, uneven, by_cell(uneven))) return first;
  std::optional<Failure> crosses;
  std::array<double, 2> order{};
  around.show(core::SurfaceCrossing::deepest);
  if (const auto crossing = core::find_crossing(surfaces, scene::lattice_domain<3>(scene))) {
    const auto node = static_cast<std::size_t>(crossing->node);
    crosses = at(crossing_failure(crossing->cell, crossing->other, false, plan, setting),
                 {surfaces.position[0][node], surfaces.position[1][node], surfaces.position[2][node]});
    order = {-crossing->depth, static_cast<double>(crossing->cell)};
  }
  return first_failure(ranks, crosses, order);
}

/// Cells beside walls of any shape; those of planes are left through (check_nodes).
template <int D>
std::optional<Failure> check_walls(core::AnySolver<D>& solver, const scene::StageSetting& setting,
                                   const plan::Plan& plan) {
  if (!solver.setup().region) return std::nullopt;
  std::optional<Failure> crosses;
  if (const auto beyond = solver.cell_tasks()->beyond_wall()) {
    const auto node = static_cast<std::size_t>(beyond->node);
    std::array<double, D> place;
    for (std::size_t k = 0; k < D; ++k) place[k] = solver.cells().position[k][node];
    crosses = failure("crossing", in_metres(place, D, setting.units.length), beyond->cell, beyond->depth, 0,
                      "the membrane of cell " + std::to_string(beyond->cell) + " crosses a wall (in lattice spacings)",
                      wall_crossing_remedy(plan, setting, beyond->cell));
  }
  return first_failure(solver.ranks(), crosses, by_cell(crosses));
}

}  // namespace

template <int D>
std::optional<Failure> check_state(observe::Observer& observer, core::AnySolver<D>& solver,
                                   const core::FluidMeasures<D>& measured, const scene::StageSetting& setting,
                                   const plan::Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const double mach = observer.follow_fluid(solver.fluid(), measured);
  if (!(mach <= scene.checks.mach)) {
    const scene::Vector place = in_metres(extreme_node(solver.fluid()), D, setting.units.length);
    const bool by_cells = std::isfinite(mach) && !solver.cells().cells.empty() &&
                          units::mach_number(setting.fastest_wall()) <= scene.checks.mach;
    Failure found =
        std::isfinite(mach)
            ? failure("mach", place, -1, mach, scene.checks.mach,
                      "the flow is too fast for the lattice: Mach number above its limit",
                      "lower " + setting.stage->density_factor_key + (by_cells ? explicit_remedy(plan) : "") +
                          ", or lower the shear rate or the driving force, or raise the resolution")
            : failure("non_finite", place, -1, std::nan(""), 0, "the fluid holds a value that is no number",
                      blown_up_remedy(*setting.stage));
    if (by_cells) {
      core::Surroundings<D> around = solver.cell_tasks()->surroundings();
      blame_contact(found, around, plan, setting);
    }
    return found;
  }
  if (solver.cells().cells.empty()) return std::nullopt;
  if (auto found = check_walls(solver, setting, plan)) return found;
  core::Surroundings<D> around = solver.cell_tasks()->surroundings();
  return check_cells(observer, setting, around, plan);
}

template std::optional<Failure> check_state(observe::Observer&, core::AnySolver<2>&, const core::FluidMeasures<2>&,
                                            const scene::StageSetting&, const plan::Plan&);
template std::optional<Failure> check_state(observe::Observer&, core::AnySolver<3>&, const core::FluidMeasures<3>&,
                                            const scene::StageSetting&, const plan::Plan&);

template <int D>
std::optional<Failure> check_energy(const observe::EnergyHistory& energy, const core::CellNodes& cells,
                                    const core::Ranks<D>& ranks, const plan::Plan& plan,
                                    const scene::StageSetting& setting) {
  const double growth = core::of_first(ranks, energy.relative_growth());
  const double limit = plan.scene->checks.energy_growth;
  if (growth <= limit) return std::nullopt;
  const bool bonds =
      std::any_of(plan.interactions.begin(), plan.interactions.end(),
                  [](const plan::PlannedModel& model) { return model.active() && !model.manifest->state.empty(); });
  if (bonds) return std::nullopt;
  Failure failure;
  failure.reason = "energy_growth";
  failure.value = growth;
  failure.limit = limit;
  failure.message =
      "cells and fluid at rest have gained energy (as a share of what there is), which they can only lose";
  failure.remedy = "lower " + setting.stage->density_factor_key;
  if (plan::kernel_named(plan.scene->numerics.kernel).semi_implicit_from == INFINITY)
    failure.remedy = "set numerics.kernel to \"peskin4\", or " + failure.remedy;
  else if (plan.semi_implicit)
    failure.remedy += ", so far that numerics.coupling may be \"explicit\" (the plan has the margins)";
  failure.remedy += ", or raise checks.energy_growth if this error is acceptable";
  const FoundNode fastest = farthest_node(cells, ranks);
  if (fastest.node >= 0) locate_failure<D>(failure, fastest, setting.units.length);
  return failure;
}

template std::optional<Failure> check_energy(const observe::EnergyHistory&, const core::CellNodes&,
                                             const core::Ranks<2>&, const plan::Plan&, const scene::StageSetting&);
template std::optional<Failure> check_energy(const observe::EnergyHistory&, const core::CellNodes&,
                                             const core::Ranks<3>&, const plan::Plan&, const scene::StageSetting&);

}  // namespace rouleau::monitor
