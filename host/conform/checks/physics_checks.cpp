// Level "physics" for models of every kind: units, and the reference numbers of the manifest.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "json/shown.hpp"
#include "plugin/quantities.hpp"
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

/// Changes by some roundings what has a unit: what another lattice makes of the same SI number.
double jittered(double value, const units::Dimension& dimension, Random& random) {
  return dimension == units::Dimension{} ? value : value * (1 + 4 * epsilon * uniform(random, -1, 1));
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

/// How far outputs move when parameters and inputs are rounded differently: the largest of some tries.
Values sensitivity(const Subject& subject, const Trial& trial, const Values& inputs, const Values& outputs,
                   Random& random) {
  Values most = outputs;
  for (auto& [name, values] : most) std::fill(values.begin(), values.end(), 0.0);
  for (int i = 0; i < 8; ++i) {
    auto parameters = trial.parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      parameters[k] = jittered(parameters[k], subject.manifest().parameters[k].dimension, random);
    }
    Values near = inputs;
    for (auto& [name, values] : near) {
      const units::Dimension dimension = dimension_of_array(subject, name);
      for (double& value : values) value = jittered(value, dimension, random);
    }
    try {
      const Values moved = results(subject, subject.make(parameters, trial.setting), near, 1);
      for (auto& [name, values] : most) {
        for (std::size_t k = 0; k < values.size(); ++k) {
          values[k] = std::max(values[k], std::abs(moved.at(name)[k] - outputs.at(name)[k]));
        }
      }
    } catch (const plugin::ModelRefused&) {  // at the very limit of what it takes
    }
  }
  return most;
}

/// The same SI numbers on another lattice give the same SI numbers.
void compare_lattices(Worst& worst, const Subject& subject, const Trial& trial, Random& random) {
  const plugin::ModelSetting other = rescaled(trial.setting, random);
  const Values inputs = subject.random_inputs(trial.instance, 101, random);
  const Values here = results(subject, trial.instance, inputs, 1);
  const Values tolerance = sensitivity(subject, trial, inputs, here, random);
  const Values there =
      converted(subject,
                results(subject, subject.make(trial.parameters, other),
                        converted(subject, inputs, trial.setting, other), trial.setting.units.time / other.units.time),
                other, trial.setting);
  for (const auto& [name, values] : here) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      // What rounding of the numbers themselves was seen to do, with a margin for eight tries being few, and that of
      // the result. Products of more than fifty units are not expected.
      double limit = 16 * tolerance.at(name)[i] + 64 * epsilon * std::abs(values[i]);
      limit += std::numeric_limits<double>::min();  // numbers below have fewer digits
      // A new state may be a sum with the old one, which cancels.
      if (name.starts_with("state.")) limit += 4 * epsilon * std::abs(inputs.at(name)[i]);
      worst.add(std::abs(there.at(name)[i] - values[i]), limit, [&, &name = name, &values = values] {
        const std::string what = name == "distance" ? "the cutoff" : name;
        const double unit = trial.setting.units.unit(dimension_of_array(subject, name));
        return what + " is " + number(values[i] * unit, 10) + " SI on one lattice and " +
               number(there.at(name)[i] * unit, 10) + " SI on one with units of " +
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
  for (const Trial& trial : trials(subject, random, Subject::typical_setting())) {
    for (int i = 0; i < 3; ++i) compare_lattices(worst, subject, trial, random);
  }
  return worst.finding("the same on all lattices");
}

/// Parameters of a reference in SI: its own, else defaults.
std::vector<double> parameters_of(const Subject& subject, const nlohmann::json& reference, const std::string& at) {
  const nlohmann::json given = reference.value("parameters", nlohmann::json::object());
  std::vector<double> values;
  for (const plugin::Parameter& parameter : subject.manifest().parameters) {
    if (!given.contains(parameter.name)) {
      if (!parameter.default_value) {
        throw Error(Cause::plugin_refused, at + " gives no value for " + parameter.name + ", which has no default");
      }
      values.push_back(*parameter.default_value);
    } else if (parameter.choices.empty() && given[parameter.name].is_number()) {
      values.push_back(given[parameter.name]);
    } else {
      const auto& words = parameter.choices;
      const auto word = std::find(words.begin(), words.end(), given[parameter.name]);
      if (word == words.end()) {
        throw Error(Cause::plugin_refused,
                    at + ": " + parameter.name + " cannot be " + json::shown(given[parameter.name]));
      }
      values.push_back(static_cast<double>(word - words.begin()));
    }
  }
  return values;
}

/// The reference's inputs as the first element; further ones have each input changed by a tenth.
Values inputs_of(const Subject& subject, const Trial& trial, const nlohmann::json& reference, const std::string& at) {
  const nlohmann::json& given = reference["inputs"];
  Values inputs;
  const std::size_t count = subject.input_arrays().size();
  const auto add = [&](const std::string& array, double si, const units::Dimension& dimension) {
    const std::size_t place = inputs.size();
    auto& values = inputs[array];
    values.assign(1 + 2 * count, trial.setting.units.to_lattice(si, dimension));
    values[1 + 2 * place] *= 0.9;
    values[2 + 2 * place] *= 1.1;
  };
  for (const std::string& name : subject.manifest().needs) {
    if (!given.contains(name)) throw Error(Cause::plugin_refused, at + " gives no value for the input " + name);
    add(name, given[name], plugin::dimension_of(subject.manifest(), name));
  }
  for (std::size_t k = 0; k < subject.manifest().state.size(); ++k) {
    const plugin::StateVariable& variable = subject.manifest().state[k];
    add("state." + std::to_string(k), given.value(variable.name, variable.initial), variable.dimension);
  }
  return inputs;
}

Finding reference(const Subject& subject) {
  const plugin::Manifest& manifest = subject.manifest();
  if (manifest.kind == plugin::ModelKind::collision) {
    return Finding::skipped("one number for each input cannot say what nine populations are");
  }
  if (manifest.checks.empty()) {
    return Finding::warned("its manifest has no reference numbers (\"checks\") from the model's source");
  }
  Worst worst;
  for (std::size_t i = 0; i < manifest.checks.size(); ++i) {
    const nlohmann::json& entry = manifest.checks[i];
    const std::string at = manifest.file.string() + " /checks/" + std::to_string(i);
    const auto parameters = parameters_of(subject, entry, at);
    const plugin::ModelSetting setting = Subject::typical_setting();
    const Trial trial{subject.make(parameters, setting), parameters, setting, {}};
    Call look;
    look.time_step = 0;
    const Values inputs = inputs_of(subject, trial, entry, at);
    const Values outputs = compute(subject, trial.instance, inputs, look);
    for (const auto& [name, wanted] : entry["outputs"].items()) {
      if (name.starts_with("x-")) continue;
      const auto& found = outputs.at(name);
      const double expected = setting.units.to_lattice(wanted, plugin::dimension_of(manifest, name));
      double size = std::abs(expected);
      for (std::size_t k = 1; expected == 0 && k < found.size(); ++k) size = std::max(size, std::abs(found[k]));
      const double limit = entry.value("tolerance", 1e-9) * size;
      const double scale = expected == 0 ? 1 : 1 / std::abs(expected);
      worst.add(std::abs(found[0] - expected) * scale, limit * scale, [&, &name = name, &wanted = wanted] {
        const double unit = setting.units.unit(plugin::dimension_of(manifest, name));
        return name + " is " + number(found[0] * unit, 10) + " SI at " + place(subject, setting, inputs, 0) +
               ", the manifest's check " + std::to_string(i) + " says " + json::shown(wanted) +
               (entry.contains("source") ? " (" + entry["source"].get<std::string>() + ')' : "") +
               "; the difference is";
      });
    }
  }
  return worst.finding("exactly the reference numbers");
}

}  // namespace

std::vector<Check> physics_checks() {
  return {
      {"units",
       Level::physics,
       "means SI by its units: the lattice's do not matter",
       {"compute", "state-restored"},
       units},
      {"reference",
       Level::physics,
       "gives the reference numbers of its manifest",
       {"units", "gradient", "derivative", "derivatives", "cutoff", "rigid-motion", "moduli", "dissipation",
        "closed-loop"},
       reference},
  };
}

}  // namespace rouleau::conform
