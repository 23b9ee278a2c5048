// The limits that cells bring in: how far the fluid gives way to them, how stiff they are, what acts between them,
// where they lie.
#pragma once

#include <string>
#include <vector>

#include "limit_list.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// What the limits of a stage are found from.
struct LimitedStage {
  LimitedStage(const Plan& of, const scene::StageSetting& setting);
  const Plan& plan;
  const scene::Scene& scene;
  const scene::StageSetting& stage;
  const StageFacts& facts;
  int by_dimension;          ///< where constants for two and for three dimensions stand: the dimension less 2
  double most_viscous_tau;   ///< relaxation time of the most viscous layer
  std::string where, lower;  ///< " (stage shear)", "lower numerics.density_factor"
  RemediedBy density;        ///< nothing where the scene gives the stage a factor, which is not auto's to change
};

/// Whether a run is about when things happen, which is late by as much as the flow: cells that turn over or meet
/// others. A round cell alone becomes steady and forgets its start. `auto` is told which.
bool reports_moments(const Plan& plan);

void add_compression(const LimitedStage& of, LimitList& limits);
void add_leak(const LimitedStage& of, LimitList& limits);
void add_travel(const LimitedStage& of, LimitList& limits);
void add_forces_on_cells(const LimitedStage& of, LimitList& limits);
void add_stiffness(const LimitedStage& of, LimitList& limits);
void add_slip_and_prestress(const LimitedStage& of, LimitList& limits);
void add_potentials(const LimitedStage& of, LimitList& limits);
/// Of the first stage alone.
void add_gaps(const LimitedStage& of, LimitList& limits);
void add_resolution(const LimitedStage& of, LimitList& limits);

}  // namespace rouleau::plan
