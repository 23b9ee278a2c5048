// The numerics that keep a target error at the least cost: what errors and costs of a scene depend on, and the search.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/fluid/relaxation.hpp"
#include "error_model.hpp"
#include "numerics_choice.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"

namespace rouleau::plan {

/// What the error and the cost of a scene depend on, and what it pins.
class NumericsProblem {
 public:
  NumericsProblem(const scene::Scene& draft, const nlohmann::json& written, const NumericsBounds& bounds);
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
  /// The target; where stages with factors of their own take most of it already, half of it on top of theirs: no
  /// lattice makes up for them.
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
  /// What a stage adds with this factor: inertia and start. `compression`: what the membranes make of the lattice's
  /// fluid with a factor of one (stiffness_error).
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
  [[nodiscard]] nlohmann::json pinned(const char* key) const {
    return numerics_.contains(key) ? numerics_.at(key) : nlohmann::json();
  }

  const scene::Scene& scene_;
  const nlohmann::json& written_;
  NumericsBounds bounds_;
  nlohmann::json numerics_;  ///< what the scene says of them
  double target_ = 0;
  bool steady_ = false;  ///< asked for
  bool can_be_steady_ = false;
  MembraneCoupling coupling_ = MembraneCoupling::plain;
  bool has_cells_ = false, has_round_cells_ = false;  ///< round: circles and ellipses
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
  CapillaryRange capillary_{0, 0};
  double momentum_time_ = 0;  ///< s, of the true fluid, over the cells' radius or, without cells, half the height
};

}  // namespace rouleau::plan
