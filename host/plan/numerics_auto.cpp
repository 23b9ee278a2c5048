#include "numerics_auto.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "base/text.hpp"
#include "constants.hpp"
#include "core/fluid/relaxation.hpp"
#include "error_model.hpp"
#include "estimate.hpp"
#include "flow.hpp"
#include "json/document.hpp"
#include "json/json_pointer.hpp"
#include "limits.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"
#include "scene/scene_reader.hpp"
#include "shape/extent.hpp"
#include "shape/outline.hpp"
#include "shape/random_cells.hpp"

namespace rouleau::plan {
namespace {

using Json = nlohmann::json;

constexpr double default_target = 0.01;
constexpr const char* origin = "numerics.auto";

constexpr double nearly = 0.999;  ///< as much of a limit as is taken
constexpr double nothing = 1e-6;  ///< an error that is none
constexpr std::array relaxation_times{0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0};
constexpr double finest_radius = 80;                    ///< spacings; more is never chosen
constexpr int fewest_rows = 16;                         ///< of a lattice without cells
constexpr CapillaryRange usual_capillary{0.0125, 0.2};  ///< before it is known

/// What a person would write: three digits, rounded down. Whole numbers stay whole.
Json three_digits_below(double value) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
  const double rounded = std::stod(number(std::floor(value / digit * (1 + 1e-12)) * digit, 3));
  if (rounded == std::floor(rounded) && rounded < 1e15) return static_cast<std::int64_t>(rounded);
  return rounded;
}

/// Whether a flow can bring the cells to a steady state: one that is alone in the middle between walls. Others drift and meet.
bool can_be_steady(const scene::Scene& scene) {
  constexpr double near_the_middle = 0.1;  // radii
  if (scene.cells.size() != 1 || !scene.packings.empty()) return false;
  const double off = near_the_middle * shape::smallest_radius(scene);
  const scene::Domain& domain = scene.domain;
  const scene::Vector from_middle = scene.cells[0].center - 0.5 * domain.size;
  for (int axis = 0; axis < domain.dimension(); ++axis) {
    if (!domain.periodic[axis] && std::abs(from_middle[axis]) > off) return false;
  }
  return true;
}

/// What the error and the cost of a scene depend on, and what it pins.
class Problem {
 public:
  Problem(const scene::Scene& draft, const Json& written, const NumericsBounds& bounds);
  [[nodiscard]] NumericsChoice solve() const;

 private:
  struct Trial {
    scene::LatticeSize nodes;
    double tau = 1, cost = 0;
    std::vector<double> density_factors;  ///< of each stage
    ErrorShares error;                    ///< of the stage where it is largest
  };
  /// What a stage does, and what it has of its own.
  struct Flow {
    double rate;             ///< of shear, 1/s; 0: at rest
    double mean_wall_speed;  ///< largest, m/s
    double strain;
    double seconds;  ///< infinite where only `until` ends it
    double lag;      ///< of a flow that begins at rest, for each unit of density factor (scene::start_up_strain)
    bool driven;     ///< by a pressure gradient rather than by walls
    std::optional<double> given_factor;  ///< by the scene, for this stage or for all
    bool own_factor;                     ///< for this stage
    [[nodiscard]] bool at_rest() const { return rate == 0 && mean_wall_speed == 0; }
  };
  [[nodiscard]] std::vector<scene::LatticeSize> lattices() const;
  [[nodiscard]] bool meets_target(const Trial& trial) const { return trial.error.total() <= target_ * (1 + 1e-9); }
  [[nodiscard]] bool good_enough(const Trial& trial) const { return trial.error.total() <= goal() * (1 + 1e-9); }
  /// The target; where stages with factors of their own take most of it already, half of it on top of theirs: no lattice makes
  /// up for them.
  [[nodiscard]] double goal() const;
  [[nodiscard]] Trial cheapest() const;
  [[nodiscard]] Trial tried(const scene::LatticeSize& nodes, double tau) const;
  [[nodiscard]] double spacing_of(const scene::LatticeSize& nodes) const { return scene_.domain.size.y() / nodes[1]; }
  [[nodiscard]] double time_step_of_factor_one(double spacing, double tau) const {
    return core::time_step(tau, spacing, scene_.fluid.viscosity / scene_.fluid.density);
  }
  /// The relaxation time of the most viscous layer where that of the fluid is tau.
  [[nodiscard]] double most_viscous(double tau) const {
    const double ratio = scene::viscosity_range(scene_.fluid).most / scene_.fluid.viscosity;
    return core::relaxation_time_of(ratio * core::viscosity_of(tau));
  }
  [[nodiscard]] MembraneCoupling chosen_coupling() const;
  /// Half of the narrowest side that decides the lattice of a flow without cells, m.
  [[nodiscard]] double half_width() const;
  /// Of all cells.
  [[nodiscard]] double membrane_nodes(double spacing) const;
  [[nodiscard]] double resolution_error(double spacing, double tau) const;
  /// What a stage adds with this factor: inertia and start. `compression`: what the membranes make of the lattice's fluid with a
  /// factor of one (stiffness_error).
  [[nodiscard]] ErrorShares error_of(const Flow& flow, double density_factor, double compression) const;
  [[nodiscard]] double steady_error_at(double reynolds) const;
  [[nodiscard]] double compression_of(double spacing, double tau) const;
  /// The largest density factor that the limits of the plan leave a stage at this relaxation time.
  [[nodiscard]] double most_by_limits(std::size_t stage, double tau) const;
  /// The largest density factor with which inertia and start of a stage together leave at most this error.
  [[nodiscard]] double most_density_factor(const Flow& flow, double error, double compression) const;
  /// Of each stage: the largest that this much error beside the lattice's leaves room for.
  [[nodiscard]] std::vector<double> density_factors(double error, double spacing, double tau) const;
  /// Seconds of the scene over the factor of each stage.
  [[nodiscard]] double duration(const std::vector<double>& density_factors) const;
  /// `gain`: what to say of gain_by_developed_start().
  [[nodiscard]] std::string why_density_factor(const Trial& best, std::size_t stage, const std::string& gain) const;
  [[nodiscard]] std::string gain_by_developed_start(const Trial& best) const;
  /// Of the stages whose factor is left open.
  [[nodiscard]] std::optional<std::size_t> least_dense(const Trial& best) const;
  void choose_density_factors(const Trial& best, NumericsChoice& choice) const;
  [[nodiscard]] NumericsChoice chosen(const Trial& best) const;
  [[nodiscard]] std::string doubt_about(const Trial& best) const;
  [[nodiscard]] Json pinned(const char* key) const { return numerics_.contains(key) ? numerics_.at(key) : Json(); }

  const scene::Scene& scene_;
  const Json& written_;
  NumericsBounds bounds_;
  Json numerics_;  ///< what the scene says of them
  double target_ = default_target;
  bool steady_ = false;  ///< asked for
  bool can_be_steady_ = false;
  MembraneCoupling coupling_ = MembraneCoupling::plain;
  bool has_cells_ = false, has_round_cells_ = false;  ///< round: in two dimensions, and not biconcave
  struct UsedType {
    const scene::CellType* type;
    int cells;
    double radius;         ///< that a lattice must resolve, m
    double nodes_of_cell;  ///< of a surface that does not follow the lattice; else 0
  };
  std::vector<UsedType> used_types_;
  double radius_ = 0;           ///< of the smallest cell, m
  double viscosity_ratio_ = 1;  ///< the furthest from 1
  std::vector<Flow> flows_;     ///< of each stage
  double strain_ = 0;           ///< of the stage with the largest
  CapillaryRange capillary_ = usual_capillary;
  double momentum_time_ = 0;  ///< s, of the true fluid, over the cells' radius or, without cells, half the height
};

Problem::Problem(const scene::Scene& draft, const Json& written, const NumericsBounds& bounds)
    : scene_(draft), written_(written), bounds_(bounds), numerics_(written.at("numerics")) {
  const Json wanted = numerics_.at("auto");
  target_ = wanted.value("error", default_target);
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
    has_round_cells_ =
        has_round_cells_ || (scene_.domain.dimension() == 2 && !std::holds_alternative<scene::Biconcave>(type.shape));
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

/// In three dimensions the correction was measured with the sharp kernel.
MembraneCoupling Problem::chosen_coupling() const {
  const bool in_space = scene_.domain.dimension() == 3;
  scene::Numerics chosen;
  const std::string kernel = numerics_.value("kernel", in_space ? sharp_kernel : chosen.kernel);
  const bool corrected =
      bounds_.slip_correction && scene_.fluid.layers.empty() && (!in_space || kernel == sharp_kernel);
  chosen.slip_correction = numerics_.value("slip_correction", corrected);
  chosen.kernel = kernel;
  return membrane_coupling(chosen);
}

std::vector<scene::LatticeSize> Problem::lattices() const {
  const Json nodes = written_.at("domain").value("nodes", Json());
  if (!nodes.is_null()) return {nodes.get<scene::LatticeSize>()};
  const scene::LatticeSize coarsest = *scene::coarsest_lattice(scene_.domain.size);  // the draft has found one
  // Beyond the finest lattice the plan's limits may be exceeded, and it warns.
  const double of_cells = std::min(std::max(bounds_.least_radius, least_radii(scene_, coupling_).run), finest_radius);
  const double least = has_cells_ ? of_cells : fewest_rows / 2.0;
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
double Problem::half_width() const {
  const scene::Domain& domain = scene_.domain;
  if (domain.dimension() == 2 || !scene::has_walls(domain)) return domain.size.least() / 2;
  double apart = INFINITY;
  for (int axis = 0; axis < domain.dimension(); ++axis) {
    if (!domain.periodic[axis]) apart = std::min(apart, domain.across(axis));
  }
  return apart / 2;
}

double Problem::membrane_nodes(double spacing) const {
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

NumericsChoice Problem::solve() const { return chosen(cheapest()); }

Problem::Trial Problem::cheapest() const {
  std::vector<double> taus(relaxation_times.begin(), relaxation_times.end());
  // In layers of little viscosity tau is nearer to 1/2.
  const double thinnest = scene::viscosity_range(scene_.fluid).least / scene_.fluid.viscosity;
  std::erase_if(taus,
                [&](double tau) { return tau < relaxation_times.back() && thinnest * (tau - 0.5) < least_of_layers; });
  if (!pinned("tau").is_null()) taus = {pinned("tau").get<double>()};
  std::vector<Trial> trials;
  double least = INFINITY;  // error that can be had
  for (const auto& nodes : lattices()) {
    for (const double tau : taus) least = std::min(least, trials.emplace_back(tried(nodes, tau)).error.total());
  }
  // Where none keeps the target, a tenth more than the least error may come from the lattice: a finer one would hardly
  // help.
  const double enough = std::max(goal() * (1 + 1e-9), 1.1 * least);
  const bool kept = least <= goal() * (1 + 1e-9);
  std::erase_if(trials, [&](const Trial& trial) { return kept ? !good_enough(trial) : trial.error.total() > enough; });
  return *std::min_element(trials.begin(), trials.end(),
                           [](const Trial& a, const Trial& b) { return a.cost < b.cost; });
}

/// The densest fluid that the error leaves room for, and what it costs.
Problem::Trial Problem::tried(const scene::LatticeSize& nodes, double tau) const {
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

std::vector<double> Problem::density_factors(double error, double spacing, double tau) const {
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
double Problem::resolution_error(double spacing, double tau) const {
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

/// Events of a motion come late by the lag of the start, the first of them by the largest share. The steady state misses what
/// the slowest mode of the start has left, in the flow and in the relative viscosity.
ErrorShares Problem::error_of(const Flow& flow, double density_factor, double compression) const {
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

double Problem::steady_error_at(double reynolds) const {
  if (scene_.domain.dimension() == 3) return steady_error_in_space(reynolds, strain_, viscosity_ratio_);
  const double height = scene_.domain.across(1), length = scene_.domain.size.x();
  double area = 0;
  for (const UsedType& used : used_types_) area += used.cells * std::numbers::pi * used.radius * used.radius;
  return steady_error(
      {reynolds, strain_, viscosity_ratio_, height / radius_, area / (height * length), capillary_.most});
}

double Problem::compression_of(double spacing, double tau) const {
  return has_round_cells_ && bounds_.recovery
             ? (tau - 0.5) * time_step_of_factor_one(spacing, tau) * bounds_.recovery->most
             : 0;
}

double Problem::goal() const {
  double given = 0;
  for (const Flow& flow : flows_)
    if (flow.own_factor) given = std::max(given, error_of(flow, *flow.given_factor, 0).total());
  return std::max(target_, target_ / 2 + given);
}

double Problem::most_by_limits(std::size_t stage, double tau) const {
  const auto of_tau = bounds_.most_density_factor_at.find({stage, tau});
  const auto of_all = bounds_.most_density_factor.find(stage);
  return std::min(of_tau != bounds_.most_density_factor_at.end() ? of_tau->second : INFINITY,
                  of_all != bounds_.most_density_factor.end() ? of_all->second : INFINITY);
}

double Problem::most_density_factor(const Flow& flow, double error, double compression) const {
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
double Problem::duration(const std::vector<double>& density_factors) const {
  double all = 0, without_end = 0;
  for (std::size_t i = 0; i < flows_.size(); ++i) {
    if (std::isfinite(flows_[i].seconds))
      all += flows_[i].seconds / density_factors[i];
    else
      without_end += 1 / density_factors[i];
  }
  return all > 0 ? all : without_end;
}

std::string Problem::why_density_factor(const Trial& best, std::size_t stage, const std::string& gain) const {
  if (!has_cells_) return "without cells the fluid's own inertia is what decides";
  const Flow& flow = flows_[stage];
  const double factor = best.density_factors[stage];
  const bool limited = factor >= most_by_limits(stage, best.tau) * 0.99;
  if (flow.at_rest()) {
    return limited                           ? "at rest, as large as the limits of the membranes' stiffness allow"
           : factor < density_factor_at_rest ? "at rest, no larger than in the flow before"
                                             : "at rest, the largest with which cells were measured to come to rest";
  }
  if (flow.rate == 0) return "carried along by both walls, as large as their Mach number allows";
  const ErrorShares error = error_of(flow, factor, compression_of(spacing_of(best.nodes), best.tau));
  std::string why = "simulated Reynolds number " + number(momentum_time_ * flow.rate * factor, 3) + ": " +
                    number(100 * error.inertia, 2) + " % of error";
  if (error.start > 0) {
    why += ", and " + number(100 * error.start, 2) + " % by the start of the flow" + gain;
  }
  if (limited) why += "; more is beyond a limit of the plan";
  return why;
}

std::optional<std::size_t> Problem::least_dense(const Trial& best) const {
  std::optional<std::size_t> least;
  for (std::size_t i = 0; i < flows_.size(); ++i) {
    if (!flows_[i].given_factor && (!least || best.density_factors[i] < best.density_factors[*least])) least = i;
  }
  return least;
}

/// The least one is that of the scene; stages that bear a much denser fluid get their own.
void Problem::choose_density_factors(const Trial& best, NumericsChoice& choice) const {
  constexpr double much = 1.25;
  const std::optional<std::size_t> least = least_dense(best);
  if (!least) return;
  const std::string gain = gain_by_developed_start(best);
  const auto choose = [&](const std::string& of, std::size_t stage) {
    choice.values.push_back({of + "/density_factor", three_digits_below(best.density_factors[stage]),
                             why_density_factor(best, stage, gain)});
  };
  choose("/numerics", *least);
  for (std::size_t i = 0; i < flows_.size(); ++i) {
    if (!flows_[i].given_factor && best.density_factors[i] > much * best.density_factors[*least])
      choose(scene_.stages[i].pointer, i);
  }
}

/// What flows that are developed from the start would save; empty: little.
std::string Problem::gain_by_developed_start(const Trial& best) const {
  constexpr double little = 0.8;
  if (std::none_of(flows_.begin(), flows_.end(), [](const Flow& flow) { return flow.lag > 0; })) return {};
  Problem developed = *this;
  for (Flow& flow : developed.flows_) flow.lag = 0;
  const Trial other = developed.cheapest();
  if (!good_enough(best) || !developed.meets_target(other) || other.cost > little * best.cost) return {};
  return ", without which (\"start\": \"developed\") the run would take " + number(other.cost / best.cost, 2) +
         " times as long";
}

NumericsChoice Problem::chosen(const Trial& best) const {
  NumericsChoice choice{target_, steady_, best.error, {}, {}};
  const auto choose = [&](const std::string& pointer, const Json& value, const std::string& why) {
    choice.values.push_back({pointer, value, why});
  };
  const auto percent = [](double share) { return number(100 * share, 2) + " %"; };
  const double spacing = spacing_of(best.nodes);
  const bool in_space = scene_.domain.dimension() == 3;
  if (!written_.at("domain").contains("nodes")) {
    choose("/domain/nodes", best.nodes,
           has_cells_ ? "the smallest cell's radius is " + number(radius_ / spacing, 3) +
                            " spacings: " + percent(best.error.resolution) + " of error"
                      : std::to_string(best.nodes[1]) + " rows: " + percent(best.error.resolution) + " of error");
  }
  for (const scene::CellType& type : scene_.cell_types) {
    if (in_space || written_.at("cell_types").at(type.name).contains("segments")) continue;
    const double segments = std::clamp(std::round(shape::shape_perimeter(type.shape) / spacing), 8.0, 100000.0);
    choose("/cell_types/" + type.name + "/segments", static_cast<int>(segments), "one for each spacing");
  }
  const auto set = [&](const char* key, const Json& value, const std::string& why) {
    if (!numerics_.contains(key)) choose(std::string("/numerics/") + key, value, why);
  };
  set("tau", best.tau, "the cheapest with this resolution");
  choose_density_factors(best, choice);
  if (has_cells_) {
    set("coupling", "auto", "explicit or semi-implicit, by the limits of the membranes' stiffness");
    const bool corrected = coupling_ != MembraneCoupling::plain;
    if (coupling_ == MembraneCoupling::sharp && in_space)
      set("kernel", sharp_kernel,
          "has no second moment: what the slip correction leaves is a fifth of that of peskin4");
    set("slip_correction", corrected,
        corrected  ? "takes the first-order error of the immersed boundary out"
        : in_space ? "left out: in three dimensions it was measured with the kernel sharp6 alone, and without layers"
                   : "left out, for plasma between cells drains with it, and some that attract each other strongly "
                     "then become so thin that they cross themselves");
    set("area_correction", true, std::string("cells keep their ") + scene_.domain.words().contents);
  }
  choice.doubt = doubt_about(best);
  return choice;
}

/// Why the target may not be met, or only at a price; empty: it should.
std::string Problem::doubt_about(const Trial& best) const {
  const auto percent = [](double share) { return number(100 * share, 2) + " %"; };
  const auto unknown = [](const std::string& what, double value, double least, double most) {
    return "numerics.auto: the " + what + " " + number(value, 3) + " lies outside of what errors were measured for (" +
           number(least) + " to " + number(most) + ")";
  };
  if (!meets_target(best)) {
    std::string pins;
    for (const char* key : {"density_factor", "tau"})
      if (!pinned(key).is_null()) pins += (pins.empty() ? "" : " and ") + std::string("numerics.") + key;
    for (const scene::Stage& stage : scene_.stages)
      if (stage.has_own_density_factor()) pins += (pins.empty() ? "" : " and ") + stage.density_factor_key;
    if (written_.at("domain").contains("nodes")) pins += (pins.empty() ? "" : " and ") + std::string("domain.nodes");
    const ErrorShares& error = best.error;
    std::string total = percent(error.total());
    if (total == percent(target_)) total = number(100 * error.total(), 4) + " %";
    return "numerics.auto: the expected error is " + total + ", more than the target of " + percent(target_) + ": " +
           percent(error.resolution) + " by the lattice, " + percent(error.inertia) + " by the fluid's density, " +
           percent(error.start) + " by the start; " +
           (pins.empty() ? "allow a larger error" : "leave " + pins + " open, or allow a larger error");
  }
  if (!has_cells_) return {};
  constexpr double most_of_the_target = 0.8;
  const std::optional<std::size_t> least_dense_stage = least_dense(best);
  if (best.error.resolution > most_of_the_target * target_ && least_dense_stage &&
      flows_[*least_dense_stage].rate > 0 && written_.at("domain").contains("nodes")) {
    return "numerics.auto: the lattice that domain.nodes names takes " + percent(best.error.resolution) +
           " of error already, and what is left of " + percent(target_) + " asks for small steps (density_factor " +
           number(best.density_factors[*least_dense_stage], 3) + "); leave domain.nodes out, or allow a larger error";
  }
  if (!scene_.fluid.layers.empty())
    return "numerics.auto: the error of cells was measured in a fluid of one viscosity, and fluid.layers has others";
  if (viscosity_ratio_ < 0.99 || viscosity_ratio_ > 1.01 * measured_ratio)
    return unknown("viscosity ratio", viscosity_ratio_, 1, measured_ratio);
  const bool in_space = scene_.domain.dimension() == 3;
  if ((in_space && coupling_ != MembraneCoupling::sharp) || !bounds_.recovery) return {};
  const auto& [least, most] = capillary_;
  const auto& [least_measured, most_measured] = in_space ? measured_capillary_in_space : measured_capillary;
  if (in_space && !std::isfinite(most))
    return "numerics.auto: the error of cells was measured with membranes that resist stretching";
  if (least < least_measured) return unknown("capillary number", least, least_measured, most_measured);
  if (most > most_measured && std::isfinite(most))
    return unknown("capillary number", most, least_measured, most_measured);
  return {};
}

/// Gives "numerics": "auto" the form of an object.
void spell_out_numerics(json::Document& document) {
  if (!document.root().at("numerics").is_object()) document.put("/numerics", {{"auto", Json::object()}}, origin);
}

/// Gives a document values with which it can be read; they mean nothing.
void put_draft_numerics(json::Document& document) {
  const Json root = document.root();
  const scene::SceneFields fields(document);
  const bool in_space = root.at("domain").at("size").size() == 3;
  if (!root.at("domain").contains("nodes")) {
    const auto lattice =
        scene::coarsest_lattice(fields.quantities("/domain/size", "m", scene::range::length, in_space ? 3 : 2));
    if (!lattice) {
      const std::string most = std::to_string(scene::most_coarse_rows);
      fields.refuse(
          "/domain/size",
          in_space ? "the ratios of these sides are not those of whole numbers up to " + most +
                         ", or want more nodes than can be computed (" + std::to_string(scene::most_nodes_of_block) +
                         "), so that no lattice with the same spacing along all three can be chosen\n"
                         "write sides with simple ratios, such as [\"50 um\", \"25 um\", \"25 um\"], or give nodes"
                   : "the ratio of these sides is not one of whole numbers up to " + most +
                         ", so that no lattice with the same spacing along both can be chosen\n"
                         "write sides with a simple ratio, such as [\"50 um\", \"25 um\"], or give nodes");
    }
    // As fine as a lattice that might be chosen: a region of output must hold nodes.
    const int factor = std::max(1, 1024 / *std::max_element(lattice->begin(), lattice->end()));
    document.put("/domain/nodes", scene::refined(*lattice, factor).value(), origin);
  }
  const Json types = root.value("cell_types", Json::object());
  for (const auto& [name, type] : types.items()) {
    const std::string cell = json::child_pointer("/cell_types", name);
    if (in_space && !type.contains("triangles") && !type.at("shape").contains("mesh"))
      document.put(cell + "/triangles", 320, origin);
    if (!in_space && !type.contains("segments")) document.put(cell + "/segments", 64, origin);
  }
}

bool leaves_numerics_open(const Json& numerics) {
  return numerics == "auto" || (numerics.is_object() && numerics.contains("auto"));
}

}  // namespace

std::optional<NumericsChoice> fill_in_numerics(json::Document& document, const NumericsBounds& bounds) {
  if (!leaves_numerics_open(document.root().value("numerics", Json()))) return std::nullopt;
  spell_out_numerics(document);
  auto draft = std::make_shared<json::Document>(document);
  put_draft_numerics(*draft);
  Faults faults;
  scene::Scene scene = scene::read_scene(draft, faults);
  if (faults.empty()) faults.attempt([&] { shape::add_random_cells(scene); });
  if (!faults.empty()) {
    document = *draft;  // whose reading says them
    return std::nullopt;
  }
  NumericsChoice choice = Problem(scene, document.root(), bounds).solve();
  for (const ChosenValue& value : choice.values) document.put(value.pointer, value.value, origin);
  return choice;
}

}  // namespace rouleau::plan
