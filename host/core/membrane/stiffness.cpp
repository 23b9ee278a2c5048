#include "stiffness.hpp"

#include <algorithm>
#include <cmath>

namespace rouleau::core {

namespace {

/// What one law gives for a few elements, which differ in one input only; the others are those of a membrane at rest.
class Probe {
 public:
  Probe(const MembraneLaw& law, std::vector<double> arguments)
      : law_(law),
        arguments_(std::move(arguments)),
        zero_(arguments_.size(), 0.0),
        result_(arguments_.size(), 0.0),
        first_state_(law.state.size()) {
    block_.struct_size = sizeof block_;
    block_.count = static_cast<std::uint32_t>(arguments_.size());
    for (const StateVariable& variable : law.state) state_.emplace_back(arguments_.size(), variable.initial);
    for (std::size_t k = 0; k < state_.size(); ++k) first_state_[k] = state_[k].data();
    if (!state_.empty()) block_.state = first_state_.data();
  }

  std::vector<double> tension_by_stretch() { return segments(&rouleau_membrane_block::tension_by_stretch); }
  std::vector<double> tension() {
    if (law_.writes("stress_1")) return tension_along();
    if (law_.writes("tension")) return segments(&rouleau_membrane_block::tension);
    // The area grows as the stretch, where the other direction is held at rest.
    block_.area_ratio = arguments_.data();
    return compute(&rouleau_membrane_block::area_tension);
  }
  std::vector<double> moment_by_curvature() {
    block_.curvature = arguments_.data();
    if (law_.reads("rest_curvature")) block_.rest_curvature = zero_.data();
    return compute(&rouleau_membrane_block::moment_by_curvature);
  }
  std::vector<double> viscosities() {
    block_.invariant_1 = block_.invariant_2 = arguments_.data();
    std::vector<double> shear(arguments_.size(), 0.0), area(shear);
    if (law_.writes("shear_viscosity")) block_.shear_viscosity = shear.data();
    if (law_.writes("area_viscosity")) block_.area_viscosity = area.data();
    law_.compute(&block_);
    for (std::size_t i = 0; i < shear.size(); ++i) result_[i] = shear[i] + area[i];
    return result_;
  }

 private:
  /// Of a law of triangles: the tension along one principal direction, stretched so, while the other is held at rest.
  std::vector<double> tension_along() {
    std::vector<double> invariant(arguments_), first(arguments_.size(), 0.0), second(first);
    for (double& value : invariant) value = value * value - 1;
    block_.invariant_1 = block_.invariant_2 = invariant.data();
    block_.stress_1 = first.data();
    if (law_.writes("stress_2")) block_.stress_2 = second.data();
    law_.compute(&block_);
    for (std::size_t i = 0; i < first.size(); ++i) result_[i] = 2 * arguments_[i] * (first[i] + second[i]);
    return result_;
  }
  std::vector<double> segments(double* rouleau_membrane_block::*output) {
    if (law_.reads("stretch")) block_.stretch = arguments_.data();
    if (law_.reads("stretch_rate")) block_.stretch_rate = zero_.data();
    return compute(output);
  }
  std::vector<double> compute(double* rouleau_membrane_block::*output) {
    block_.*output = result_.data();
    law_.compute(&block_);
    return result_;
  }

  const MembraneLaw& law_;
  std::vector<double> arguments_, zero_, result_;
  std::vector<std::vector<double>> state_;
  std::vector<const double*> first_state_;
  rouleau_membrane_block block_{};  // a time step of 0: as the law answers at once
};

bool has_tension(const MembraneLaw& law) {
  return law.writes("tension") || law.writes("stress_1") || law.writes("area_tension");
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

double stretching_stiffness(const MembraneLaw& law, const std::vector<double>& stretches) {
  if (law.writes("tension_by_stretch")) return largest(Probe(law, stretches).tension_by_stretch());
  if (!has_tension(law)) return 0;
  constexpr double h = 1e-5;
  std::vector<double> below, above;
  for (const double stretch : stretches) {
    below.push_back(stretch - h);
    above.push_back(stretch + h);
  }
  std::vector<double> difference = Probe(law, above).tension();
  const std::vector<double> lower = Probe(law, below).tension();
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] = (difference[i] - lower[i]) / (2 * h);
  return largest(difference);
}

double tension_at(const MembraneLaw& law, double stretch) {
  return has_tension(law) ? Probe(law, {stretch}).tension().front() : 0;
}

double bending_stiffness(const MembraneLaw& law) {
  if (!law.writes("moment_by_curvature")) return 0;
  return largest(Probe(law, {0.0}).moment_by_curvature());
}

double surface_viscosity(const MembraneLaw& law) {
  if (!law.writes("shear_viscosity") && !law.writes("area_viscosity")) return 0;
  return Probe(law, {0.0}).viscosities().front();
}

}  // namespace rouleau::core
