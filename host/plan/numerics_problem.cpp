#include "numerics_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "constants.hpp"
#include "estimate.hpp"
#include "flow.hpp"
#include "limit_list.hpp"
#include "scene/scene_reader.hpp"
#include "shape/extent.hpp"
#include "shape/outline.hpp"

namespace rouleau::plan {

namespace {

using Json = nlohmann::json;

constexpr double default_target = 0.01;
constexpr double nearly = 0.999;  ///< as much of a limit as is taken
constexpr double nothing = 1e-6;  ///< an error that is none
constexpr std::array relaxation_times{0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0};
constexpr double finest_radius = 80;                    ///< spacings; more is never chosen
constexpr int fewest_rows = 16;                         ///< of a lattice without cells
constexpr CapillaryRange usual_capillary{0.0125, 0.2};  ///< before it is known

/// Whether a flow can bring the cells to a steady state: one that is alone in the middle between walls. Others drift
/// and meet.
bool can_be_steady(const scene::Scene& scene) {
  constexpr double near_the_middle = 0.1;  // radii
  if (scene.cells.size() != 1 || !scene.packings.empty() || scene.domain.is_open()) return false;
  const double off = near_the_middle * shape::smallest_radius(scene);
  const scene::Domain& domain = scene.domain;
  const scene::Vector from_middle = scene.cells[0].center - 0.5 * domain.size;
  for (int axis = 0; axis < domain.dimension(); ++axis)
    if (!domain.periodic[axis] && std::abs(from_middle[axis]) > off) return false;
  return true;
}

}  // namespace

NumericsProblem::NumericsProblem(const scene::Scene& draft, const Json& written, const NumericsBounds& bounds)
    : scene_(draft), written_(written), bounds_(bounds), numerics_(written.at("numerics")) {
  const Json wanted = numerics_.at("auto");
  target_ = wanted.value("error", default_target);
  capillary_ = usual_capillary;
  steady_ = wanted.value("of", "motion") == "steady";
  coupling_ = chosen_coupling();
  has_cells_ = !scene_.cells.empty();
  can_be_steady_ = can_be_steady(scene_);
  radius_ = shape::smallest_radius(scene_);
  std::vector<int> placed(scene_.cell_types.size());
  for (const scene::CellPlacement& cell : scene_.cells) ++placed[cell.type];
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (placed[i] == 0) continue;
    const scene::CellType& type = scene_.cell_types[i];
    const bool fixed = std::holds_alternative<scene::MeshFile>(type.shape) ||
                       written_.at("cell_types").at(type.name).contains("triangles");
    has_round_cells_ = has_round_cells_ || std::holds_alternative<scene::Circle>(type.shape) ||
                       std::holds_alternative<scene::Ellipse>(type.shape);
    used_types_.push_back({&type, placed[i], resolved_radius(type.shape), fixed ? shape::node_count(type) : 0});
    const double ratio = type.interior_viscosity / scene_.fluid.viscosity;
    if (std::abs(std::log(ratio)) > std::abs(std::log(viscosity_ratio_))) viscosity_ratio_ = ratio;
  }
  for (const scene::Stage& stage : scene_.stages) {
    const double rate = scene::mean_shear_rate(stage, scene_);
    const double by_strain = stage.strain && rate > 0 ? *stage.strain / rate : INFINITY;
    Flow flow{.rate = rate,
              .mean_wall_speed = std::abs(stage.mean_wall_speed) + std::abs(stage.oscillation.mean_wall_speed),
              .strain = stage.strain.value_or(stage.duration.value_or(0) * rate),
              .seconds = std::min(by_strain, stage.duration.value_or(INFINITY)),
              .lag = rate > 0 ? scene::start_up_strain(stage, scene_) : 0,
              .driven = stage.shear_rate == 0,
              .given_factor = {},
              .own_factor = stage.has_own_density_factor()};
    if (flow.own_factor || numerics_.contains("density_factor")) flow.given_factor = stage.density_factor;
    if (rate > 0) strain_ = std::max(strain_, flow.strain);
    flows_.push_back(flow);
  }
  if (bounds_.recovery && strain_ > 0) {
    capillary_ = {INFINITY, 0};
    for (const Flow& flow : flows_) {
      if (!(flow.rate > 0)) continue;
      capillary_ = {std::min(capillary_.least, flow.rate / bounds_.recovery->most),
                    std::max(capillary_.most, flow.rate / bounds_.recovery->least)};
    }
  }
  const double length = has_cells_ ? radius_ : scene_.domain.across(1) / 2;
  momentum_time_ = scene_.fluid.density * length * length / scene::viscosity_range(scene_.fluid).least;
}

/// Corrected where errors were measured with the correction.
MembraneCoupling NumericsProblem::chosen_coupling() const {
  const int by_dimension = scene_.domain.dimension() - 2;
  scene::Numerics chosen;
  chosen.kernel = numerics_.value("kernel", kernel_of_auto[by_dimension]);
  chosen.slip_correction = true;
  const bool known = measured_capillary[by_dimension][static_cast<int>(membrane_coupling(chosen))].known;
  chosen.slip_correction =
      numerics_.value("slip_correction", bounds_.slip_correction && scene_.fluid.layers.empty() && known);
  return membrane_coupling(chosen);
}

std::vector<scene::LatticeSize> NumericsProblem::lattices() const {
  const Json nodes = written_.at("domain").value("nodes", Json());
  if (!nodes.is_null()) return {nodes.get<scene::LatticeSize>()};
  const scene::LatticeSize coarsest = *scene::coarsest_lattice(scene_.domain.size);  // the draft has found one
  // Beyond the finest lattice the plan's limits may be exceeded, and it warns.
  const double of_cells = std::min(std::max(bounds_.least_radius, least_radii(scene_, coupling_).run), finest_radius);
  const double least =
      has_cells_ ? of_cells : std::min(std::max(bounds_.least_radius, fewest_rows / 2.0), finest_radius);
  std::vector<scene::LatticeSize> found;
  scene::LatticeSize finest = coarsest;
  for (int factor = 1;; ++factor) {
    const std::optional<scene::LatticeSize> nodes_tried = scene::refined(coarsest, factor);
    if (!nodes_tried) break;
    const double size = (has_cells_ ? radius_ : half_width()) / spacing_of(*nodes_tried);
    finest = *nodes_tried;
    if (size >= least * (1 - 1e-9)) found.push_back(finest);
    if (size >= finest_radius * (1 - 1e-9)) break;
  }
  if (found.empty()) found.push_back(finest);
  return found;
}

/// In three dimensions a few layers with periodic sides stand for a plane flow: what counts is how far walls are apart.
double NumericsProblem::half_width() const {
  const scene::Domain& domain = scene_.domain;
  if (domain.has_shapes()) return domain.region_width / 2;
  if (domain.dimension() == 2 || !scene::has_walls(domain)) return domain.size.least() / 2;
  double apart = INFINITY;
  for (int axis = 1; axis < domain.dimension(); ++axis)
    if (!domain.periodic[axis]) apart = std::min(apart, domain.across(axis));
  return apart / 2;
}

double NumericsProblem::membrane_nodes(double spacing) const {
  double all = 0;
  for (const UsedType& used : used_types_) {
    double nodes = used.nodes_of_cell;
    if (scene_.domain.dimension() == 2)
      nodes = shape::shape_perimeter(used.type->shape) / spacing;
    else if (nodes == 0)
      nodes = shape::surface_nodes(scene::triangles_about(used.type->shape, spacing));
    all += used.cells * nodes;
  }
  return all;
}

NumericsChoice NumericsProblem::solve() const { return chosen(cheapest()); }

NumericsProblem::Trial NumericsProblem::cheapest() const {
  std::vector<double> taus(relaxation_times.begin(), relaxation_times.end());
  // In layers of little viscosity tau is nearer to 1/2.
  const double thinnest = scene::viscosity_range(scene_.fluid).least / scene_.fluid.viscosity;
  std::erase_if(taus,
                [&](double tau) { return tau < relaxation_times.back() && thinnest * (tau - 0.5) < least_of_layers; });
  if (!pinned("tau").is_null()) taus = {pinned("tau").get<double>()};
  std::vector<Trial> trials;
  double least = INFINITY;  // error that can be had
  for (const auto& nodes : lattices())
    for (const double tau : taus) least = std::min(least, trials.emplace_back(tried(nodes, tau)).error.total());
  // Where none keeps the target, a tenth more than the least error may come from the lattice: a finer one would hardly
  // help.
  const double enough = std::max(goal() * (1 + 1e-9), 1.1 * least);
  const bool kept = least <= goal() * (1 + 1e-9);
  std::erase_if(trials, [&](const Trial& trial) { return kept ? !good_enough(trial) : trial.error.total() > enough; });
  return *std::min_element(trials.begin(), trials.end(),
                           [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
}

/// The densest fluid that the error leaves room for, and what it costs.
NumericsProblem::Trial NumericsProblem::tried(const scene::LatticeSize& nodes, double tau) const {
  Trial trial{nodes, tau, 0, {}, {}};
  const double spacing = spacing_of(nodes);
  scene::Domain domain = scene_.domain;
  domain.nodes = nodes;
  trial.error.resolution = resolution_error(spacing, most_viscous(tau));
  trial.density_factors = density_factors(goal() - trial.error.resolution, spacing, tau);
  for (std::size_t i = 0; i < flows_.size(); ++i) {
    ErrorShares of_stage = error_of(flows_[i], trial.density_factors[i], compression_of(spacing, tau));
    of_stage.resolution = trial.error.resolution;
    if (of_stage.total() > trial.error.total()) trial.error = of_stage;
  }
  const bool sharp = coupling_ == MembraneCoupling::sharp;
  trial.cost = step_cost(scene::fluid_nodes(domain), membrane_nodes(spacing), scene_.numerics.precision,
                         scene_.domain.dimension(), {.sharp_kernel = sharp, .slip_correction = sharp}) /
               time_step_of_factor_one(spacing, tau) * duration(trial.density_factors);
  return trial;
}

std::vector<double> NumericsProblem::density_factors(double error, double spacing, double tau) const {
  const double step = time_step_of_factor_one(spacing, tau), sound = 1 / std::sqrt(3.0);
  std::vector<double> found;
  // What is left of a flow dies out in a fluid that is no denser than it was in the flow.
  double at_rest = has_cells_ ? density_factor_at_rest : 1;
  for (std::size_t i = 0; i < flows_.size(); ++i) {
    const Flow& flow = flows_[i];
    const double most = most_by_limits(i, tau);
    double factor = 1;
    if (flow.given_factor) {
      factor = *flow.given_factor;
    } else if (flow.at_rest()) {
      factor = std::min(at_rest, most);
    } else {
      // Walls at rate x height / 2 around their mean in units of the spacing over the time step.
      const double wall_speed = flow.rate * scene_.domain.across(1) / 2 + flow.mean_wall_speed;
      const double wall_mach = wall_speed * step / spacing / sound;
      // Without cells what is computed is how the fluid's own inertia lets a flow start.
      const double wanted = has_cells_ ? most_density_factor(flow, error, compression_of(spacing, tau)) : 1;
      const double pressed = has_cells_ ? compression_by_shear(most_viscous(tau), flow.rate * step) : 0;
      factor = std::max(1.0, std::min({wanted, nearly * scene::largest_wall_mach(scene_.fluid.inertia) / wall_mach,
                                       nearly * largest_compression_by_shear / pressed, most}));
    }
    if (!flow.at_rest()) at_rest = std::min(at_rest, factor);
    found.push_back(factor);
  }
  return found;
}

/// That of the cell type for which it is largest, and that of the flow.
double NumericsProblem::resolution_error(double spacing, double tau) const {
  const scene::Domain& domain = scene_.domain;
  double largest = 0;
  for (const UsedType& used : used_types_)
    largest = std::max(largest, lattice_error(used.type->shape, used.radius / spacing, viscosity_ratio_, tau,
                                              domain.dimension(), coupling_, capillary_));
  if (scene_.cells.size() > 1)
    largest = std::max(largest, passing_error(radius_ / spacing, domain.dimension(), coupling_));
  if (!has_cells_) largest = flow_start_error(domain, spacing, tau);
  return largest + steady_flow_error(domain, spacing);
}

/// Events of a motion come late by the lag of the start, the first of them by the largest share. The steady state
/// misses what the slowest mode of the start has left, in the flow and in the relative viscosity.
ErrorShares NumericsProblem::error_of(const Flow& flow, double density_factor, double compression) const {
  ErrorShares error;
  if (!has_cells_) return error;
  if (const double reynolds = momentum_time_ * flow.rate * density_factor; reynolds > 0) {
    // Convective inertia does not die out on the way to a steady state.
    const bool dies_out = steady_ && can_be_steady_ && !scene_.fluid.inertia;
    error.inertia = steady_ ? steady_error_at(reynolds) : 0;
    if (!dies_out) error.inertia = std::max(error.inertia, motion_error(reynolds, scene_));
    error.inertia += stiffness_error(compression * density_factor, reynolds, viscosity_ratio_);
    if (error.inertia < nothing) error.inertia = 0;
  }
  if (const FlowStart start{density_factor * flow.lag, flow.driven}; start.delay > 0) {
    error.start = steady_ ? std::max(start.left_at(flow.strain), start.left_of_viscosity(flow.strain))
                          : start.delay / std::min(flow.strain, first_events);
  }
  return error;
}

double NumericsProblem::steady_error_at(double reynolds) const {
  if (scene_.domain.dimension() == 3) return steady_error_in_space(reynolds, strain_, viscosity_ratio_);
  const double height = scene_.domain.across(1), length = scene_.domain.size.x();
  double area = 0;
  for (const UsedType& used : used_types_) area += used.cells * std::numbers::pi * used.radius * used.radius;
  return steady_error(
      {reynolds, strain_, viscosity_ratio_, height / radius_, area / (height * length), capillary_.most});
}

double NumericsProblem::compression_of(double spacing, double tau) const {
  return has_round_cells_ && bounds_.recovery
             ? (tau - 0.5) * time_step_of_factor_one(spacing, tau) * bounds_.recovery->most
             : 0;
}

double NumericsProblem::goal() const {
  double given = 0;
  for (const Flow& flow : flows_)
    if (flow.own_factor) given = std::max(given, error_of(flow, *flow.given_factor, 0).total());
  return std::max(target_, target_ / 2 + given);
}

double NumericsProblem::most_by_limits(std::size_t stage, double tau) const {
  const auto of_tau = bounds_.most_density_factor_at.find({stage, tau});
  const auto of_all = bounds_.most_density_factor.find(stage);
  return std::min(of_tau != bounds_.most_density_factor_at.end() ? of_tau->second : INFINITY,
                  of_all != bounds_.most_density_factor.end() ? of_all->second : INFINITY);
}

double NumericsProblem::most_density_factor(const Flow& flow, double error, double compression) const {
  if (!(error > 0)) return 0;
  double low = 1e-6, high = 1e12;  // the error grows with the factor
  if (error_of(flow, high, compression).total() <= error) return high;
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (error_of(flow, middle, compression).total() <= error ? low : high) = middle;
  }
  return low;
}

/// A scene that says how long only by `until` counts as a second in each stage.
double NumericsProblem::duration(const std::vector<double>& density_factors) const {
  double all = 0, without_end = 0;
  for (std::size_t i = 0; i < flows_.size(); ++i)
    if (std::isfinite(flows_[i].seconds))
      all += flows_[i].seconds / density_factors[i];
    else
      without_end += 1 / density_factors[i];
  return all > 0 ? all : without_end;
}

}  // namespace rouleau::plan
