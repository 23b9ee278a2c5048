#include "energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cell_sums.hpp"

namespace rouleau::observe {

namespace {

/// Power that the membranes give away, at the velocities of their last step.
template <int D>
double given_away(const core::CellNodes& m, const core::Ranks<D>& ranks) {
  return sum_over(m, ranks, [&](int c) {
    double power = 0;
    for (int i = m.cells[c].first; i < m.cells[c].end(); ++i) {
      power += m.force[0][i] * m.velocity[0][i] + m.force[1][i] * m.velocity[1][i];
      for (int k = 2; k < D; ++k) power += m.force[k][i] * m.velocity[k][i];
    }
    return power;
  });
}

std::string without_energy(const char* kind, const std::string& model) {
  return std::string(kind) + " " + model + " gives no energy";
}

}  // namespace

template <int D>
CellEnergy cell_energy(core::AnySolver<D>& solver) {
  CellEnergy energy;
  auto* tasks = solver.cell_tasks();
  if (tasks == nullptr) return energy;
  const auto add = [&](double part) { energy.sum += part, energy.magnitude += std::abs(part); };
  const core::MembraneEnergy membrane = tasks->membrane_energy();
  add(membrane.tension + membrane.cell);
  add(membrane.bending);
  if (!membrane.unknown.empty()) energy.unknown = without_energy("membrane law", membrane.unknown);
  for (const auto& [part, silent] : tasks->interaction_energies()) {
    add(part);
    if (!silent.empty()) energy.unknown = without_energy("interaction", silent);
  }
  return energy;
}

template CellEnergy cell_energy(core::AnySolver<2>&);
template CellEnergy cell_energy(core::AnySolver<3>&);

template <int D>
EnergySnapshot observe_energy(core::AnySolver<D>& solver, const core::Energetics<D>& fluid,
                              const core::WallForces<D>& forces, const units::LatticeUnits& units) {
  const core::FluidSetting<D>& setting = solver.fluid().setting();
  // What the lattice has is summed over its depth.
  double depth = 1;
  for (int axis = 2; axis < D; ++axis) depth *= setting.domain.size[axis];
  const double joule = units.to_si(1, units::dimension::energy_per_depth) / depth,
               watt = units.to_si(1, units::dimension::power_per_depth) / depth;
  EnergySnapshot energy;
  energy.kinetic = fluid.kinetic * joule;
  energy.viscous_dissipation = fluid.dissipation * watt;
  energy.total = energy.kinetic;
  if (setting.domain.walled(1) || setting.solid) energy.wall_power = fluid.wall_power * watt;
  const core::WallVelocity& walls = solver.fluid().last_walls();
  if (setting.solid && (walls.lower != 0 || walls.upper != 0)) {
    energy.wall_power -= (forces.lower[0] * walls.lower + forces.upper[0] * walls.upper) * watt;
  } else if (setting.domain.walled(1) && !setting.solid) {
    const auto stress = solver.mean_wall_stress(forces);  // what is done to the walls
    energy.wall_power =
        -(stress.lower * walls.lower + stress.upper * walls.upper) * setting.domain.size[0] * depth * watt;
  }
  if (setting.body_force != std::array<double, D>{}) {
    double power = 0;
    for (int k = 0; k < D; ++k) power += setting.body_force[k] * fluid.velocity[k];
    energy.body_force_power = power * watt;
  }
  if (auto* tasks = solver.cell_tasks()) {
    const core::MembraneEnergy membrane = tasks->membrane_energy();
    energy.elastic = (membrane.tension + membrane.cell) * joule;
    energy.bending = membrane.bending * joule;
    energy.membrane_dissipation = membrane.dissipation * watt;
    if (solver.setup().external.any()) energy.external_power = tasks->external_sums()[3] * watt;
    energy.total += energy.elastic + energy.bending;
    // What corrected nodes give away and neither the lattice nor a wall gets is lost in the layers beside the
    // membranes, which the lattice does not resolve and the correction stands for.
    if (tasks->corrects_motion()) {
      const auto share = tasks->wall_share();
      const double to_walls = share.lower[0] * walls.lower + share.upper[0] * walls.upper;
      energy.viscous_dissipation +=
          (given_away(solver.cells(), solver.ranks()) - fluid.membrane_power - to_walls) * watt;
    }
    if (!membrane.unknown.empty()) energy.unknown = without_energy("membrane law", membrane.unknown);
    bool interact = false;
    for (const auto& [of_kind, silent] : tasks->interaction_energies()) {
      const double part = of_kind * joule;
      energy.interaction = interact ? energy.interaction + part : part;
      energy.total += part;
      interact = true;
      if (!silent.empty()) energy.unknown = without_energy("interaction", silent);
    }
  }
  if (!energy.unknown.empty()) energy.total = EnergySnapshot::none;
  return energy;
}

template EnergySnapshot observe_energy(core::AnySolver<2>&, const core::Energetics<2>&, const core::WallForces<2>&,
                                       const units::LatticeUnits&);
template EnergySnapshot observe_energy(core::AnySolver<3>&, const core::Energetics<3>&, const core::WallForces<3>&,
                                       const units::LatticeUnits&);

void EnergyHistory::follow(const Snapshot& snapshot, bool driven, double floor) {
  const EnergySnapshot& energy = snapshot.energy;
  if (!energy.unknown.empty()) unknown_ = energy.unknown;
  follows_ = !driven && std::isfinite(energy.total);
  if (!follows_) return;
  double magnitude = floor;
  for (const double part : {energy.kinetic, energy.elastic, energy.bending, energy.interaction})
    if (std::isfinite(part)) magnitude += std::abs(part);
  if (snapshot.stage != stage_) {
    stage_ = snapshot.stage;
    at_rest_.push_back({snapshot.stage_name, energy.total, 0, snapshot.time, magnitude});
  }
  Stage& stage = at_rest_.back();
  stage.magnitude = std::max(stage.magnitude, magnitude);
  if (energy.total - stage.least > stage.growth) {
    stage.growth = energy.total - stage.least;
    stage.growth_time = snapshot.time;
  }
  stage.least = std::min(stage.least, energy.total);
}

double EnergyHistory::relative_growth() const {
  if (!follows_ || at_rest_.empty() || !(at_rest_.back().magnitude > 0)) return 0;
  return at_rest_.back().growth / at_rest_.back().magnitude;
}

nlohmann::json EnergyHistory::summary() const {
  nlohmann::json stages = nlohmann::json::array(), largest, relative;
  double most = -1;
  for (const Stage& stage : at_rest_) {
    const nlohmann::json ratio =
        stage.magnitude > 0 ? nlohmann::json(stage.growth / stage.magnitude) : nlohmann::json();
    stages.push_back({{"stage", stage.name},
                      {"growth_J_per_m", stage.growth},
                      {"time_s", stage.growth > 0 ? nlohmann::json(stage.growth_time) : nlohmann::json()},
                      {"relative", ratio}});
    if (stage.growth <= most) continue;
    most = stage.growth;
    largest = stage.growth;
    relative = ratio;
  }
  return {{"largest_growth_at_rest_J_per_m", largest},
          {"largest_growth_at_rest_relative", relative},
          {"stages_at_rest", stages},
          {"unknown", unknown_.empty() ? nlohmann::json() : nlohmann::json(unknown_)}};
}

}  // namespace rouleau::observe
