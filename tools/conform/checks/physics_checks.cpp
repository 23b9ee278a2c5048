// Level "physics" for models of every kind: units.
#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "trials.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

plugin::ModelSetting rescaled(const plugin::ModelSetting& setting, Random& random) {
  const auto factor = [&] { return std::pow(10.0, uniform(random, -1, 1)); };
  plugin::ModelSetting other = setting;
  other.units.length *= factor();
  other.units.time *= factor();
  other.units.mass *= factor();
  return other;
}

Values converted(const Subject& subject, const Values& values, const plugin::ModelSetting& from,
                 const plugin::ModelSetting& to) {
  Values result = values;
  for (auto& [name, array] : result) {
    const units::Dimension dimension = dimension_of_array(subject, name);
    for (double& value : array) value = to.units.to_lattice(from.units.to_si(value, dimension), dimension);
  }
  return result;
}

/// Outputs in the lattice's own units, with an interaction's cutoff among them.
Values results(const Subject& subject, const plugin::ModelInstance& instance, const Values& inputs, double time_step) {
  Call call;
  call.time_step = time_step;
  Values outputs = compute(subject, instance, inputs, call);
  if (subject.manifest().kind == plugin::ModelKind::interaction) {
    outputs["distance"] = {instance.interaction().cutoff(instance.self())};
  }
  return outputs;
}

/// Where terms cancel, as beside the minimum of a potential, they are rounded by their own size. That is seen at other
/// distances, from half of this one on: the largest result there; of other models the result itself.
double size_of_terms(const Values& inputs, const std::vector<double>& values, std::size_t i) {
  double size = std::abs(values[i]);
  const auto distance = inputs.find("distance");
  if (distance == inputs.end() || distance->second.size() != values.size()) return size;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (distance->second[k] >= distance->second[i] / 2) size = std::max(size, std::abs(values[k]));
  }
  return size;
}

/// The same SI numbers on another lattice give the same SI numbers.
void compare_lattices(Worst& worst, const Subject& subject, const Trial& trial, Random& random) {
  const plugin::ModelSetting other = rescaled(trial.setting, random);
  const Values inputs = subject.random_inputs(trial.instance, 101, random);
  const double time_step = subject.manifest().state.empty() ? 1 : std::pow(10.0, uniform(random, 0, 5));
  const Values here = results(subject, trial.instance, inputs, time_step);
  const Values tolerance = sensitivity(
      subject, trial, inputs, random, 4, true,
      [&](const auto& instance, const Values& near) { return results(subject, instance, near, time_step); });
  const Values there = converted(
      subject,
      results(subject, subject.make(trial.parameters, other), converted(subject, inputs, trial.setting, other),
              time_step * trial.setting.units.time / other.units.time),
      other, trial.setting);
  for (const auto& [name, values] : here) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      // What rounding of the numbers themselves was seen to do, with a margin for eight tries being few, and that of
      // the result. Products of more than fifty units are not expected.
      double limit = 16 * tolerance.at(name)[i] + 64 * epsilon * std::abs(values[i]) +
                     16 * epsilon * size_of_terms(inputs, values, i);
      limit += std::numeric_limits<double>::min();  // numbers below have fewer digits
      // A new state may be a sum with the old one, which cancels.
      if (name.starts_with("state.")) limit += 4 * epsilon * std::abs(inputs.at(name)[i]);
      worst.add(std::abs(there.at(name)[i] - values[i]), limit, [&, &name = name, &values = values] {
        const std::string what = name == "distance" ? "the cutoff" : name;
        const double unit = trial.setting.units.unit(dimension_of_array(subject, name));
        return what + " is " + number(values[i] * unit, 17) + " SI on one lattice and " +
               number(there.at(name)[i] * unit, 17) + " SI on one with units of " +
               number(other.units.length / trial.setting.units.length, 3) + " times its length, " +
               number(other.units.time / trial.setting.units.time, 3) + " times its time, " +
               number(other.units.mass / trial.setting.units.mass, 3) + " times its mass" +
               (name == "distance" ? "" : ", at " + place(subject, trial.setting, inputs, i)) + trial.words +
               "; they differ in lattice units by";
      });
    }
  }
}

/// A collision operator lives in lattice units: the same numbers in these give the same bits whatever the units are.
Finding collision_units(const Subject& subject) {
  Random random = subject.random();
  for (const plugin::Parameter& parameter : subject.manifest().parameters) {
    if (parameter.dimension != units::Dimension{}) {
      return Finding::skipped("its parameter " + parameter.name + " has a unit, which another lattice would round");
    }
  }
  for (const Trial& trial : collision_trials(subject, random)) {
    const Values inputs = subject.random_inputs(trial.instance, 101, random);
    const Values here = compute(subject, trial.instance, inputs);
    for (int i = 0; i < 3; ++i) {
      const plugin::ModelSetting other = rescaled(trial.setting, random);
      const auto difference = first_difference(here, compute(subject, subject.make(trial.parameters, other), inputs));
      if (difference.empty()) continue;
      return Finding::failed("the same lattice numbers give others when the lattice's units change: " + difference +
                             trial.words);
    }
  }
  return Finding::passed("the same bits whatever the lattice's units are");
}

Finding units(const Subject& subject) {
  if (subject.manifest().kind == plugin::ModelKind::collision) return collision_units(subject);
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    for (int i = 0; i < 3; ++i) compare_lattices(worst, subject, trial, random);
  }
  return worst.finding("the same on all lattices");
}

}  // namespace

std::vector<Check> physics_checks() {
  return {
      {"units",
       Level::physics,
       "gives the same result in SI on lattices of other units",
       {"compute", "state-restored"},
       units},
  };
}

}  // namespace rouleau::conform
