// The reference numbers of a manifest ("checks"): level "physics" computes them again, level "publish" asks for enough.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "effects.hpp"
#include "json/shown.hpp"
#include "plugin/quantities.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

using Json = nlohmann::json;

/// One of the manifest's checks: what is given and what must come out, lattice units.
struct Reference {
  Trial trial;
  Values inputs;    ///< of one element
  Values expected;  ///< by array
  Call call;
  double tolerance;
  std::string source, at;
};

/// Where a manifest's check stands, for messages.
struct Entry {
  const Subject& subject;
  const Json& json;
  std::string at;

  [[noreturn]] void refuse(const std::string& what) const { throw Error(Cause::plugin_refused, at + what); }

  /// Parameters in SI: its own, else defaults.
  [[nodiscard]] std::vector<double> parameters() const {
    const Json given = json.value("parameters", Json::object());
    std::vector<double> values;
    for (const plugin::Parameter& parameter : subject.manifest().parameters) {
      if (!given.contains(parameter.name)) {
        if (!parameter.default_value) refuse(" gives no value for " + parameter.name + ", which has no default");
        values.push_back(*parameter.default_value);
      } else if (parameter.choices.empty() && given[parameter.name].is_number()) {
        values.push_back(given[parameter.name]);
      } else {
        const auto& words = parameter.choices;
        const Json& chosen = given[parameter.name];
        const auto word = std::find_if(words.begin(), words.end(), [&](const auto& w) { return chosen == Json(w); });
        if (word == words.end()) refuse(": " + parameter.name + " cannot be " + json::shown(chosen));
        values.push_back(static_cast<double>(word - words.begin()));
      }
    }
    return values;
  }

  /// Adds a quantity's numbers; those of one with components are a list.
  void add(Values& values, const std::string& name, const Json& given, const units::LatticeUnits& units,
           const units::Dimension& dimension) const {
    const auto arrays = arrays_of(subject, name);
    const Json list = given.is_array() ? given : Json::array({given});
    if (list.size() != arrays.size()) refuse(": " + name + " has " + std::to_string(arrays.size()) + " components");
    for (std::size_t k = 0; k < arrays.size(); ++k) values[arrays[k]] = {units.to_lattice(list[k], dimension)};
  }
};

std::string state_array(std::size_t k) { return "state." + std::to_string(k); }

Reference read(const Subject& subject, const Entry& entry) {
  const plugin::Manifest& manifest = subject.manifest();
  plugin::ModelSetting setting = subject.typical_setting();
  setting.inertia = entry.json.value("inertia", false);
  const auto parameters = entry.parameters();
  Reference reference{{subject.make(parameters, setting), parameters, setting, {}}, {}, {}, {}, 0, {}, {}};
  const Json& given = entry.json["inputs"];
  for (const std::string& name : manifest.needs) {
    if (!given.contains(name)) entry.refuse(" gives no value for the input " + name);
    entry.add(reference.inputs, name, given[name], setting.units, plugin::dimension_of(manifest, name));
  }
  if (manifest.needs.empty()) reference.inputs[subject.drawn().front()] = {1};
  const Json& outputs = entry.json["outputs"];
  for (std::size_t k = 0; k < manifest.state.size(); ++k) {
    const plugin::StateVariable& variable = manifest.state[k];
    reference.inputs[state_array(k)] = {
        setting.units.to_lattice(given.value(variable.name, variable.initial), variable.dimension)};
    if (!outputs.contains(variable.name)) continue;
    reference.expected[state_array(k)] = {setting.units.to_lattice(outputs[variable.name], variable.dimension)};
  }
  for (const std::string& name : manifest.gives) {
    if (!outputs.contains(name)) continue;
    entry.add(reference.expected, name, outputs[name], setting.units, plugin::dimension_of(manifest, name));
  }
  reference.call.time_step = entry.json.value("time_step", 0.0) / setting.units.time;
  reference.tolerance = entry.json.value("tolerance", 1e-9);
  reference.source = entry.json.value("source", std::string());
  return reference;
}

/// Those of this dimension: an operator's on the lattice that has as many populations.
std::vector<Reference> references_of(const Subject& subject) {
  const plugin::Manifest& manifest = subject.manifest();
  const std::optional<Subject> other = subject.in_other_dimension();
  std::vector<Reference> references;
  for (std::size_t i = 0; i < manifest.checks.size(); ++i) {
    const Json& entry = manifest.checks[i];
    const Json populations = entry["inputs"].value("populations", Json());
    if (other && populations.is_array() && populations.size() == arrays_of(*other, "populations").size()) continue;
    const bool of_surface = other && subject.dimension() == 3 && manifest.kind == plugin::ModelKind::membrane;
    const std::string at = (of_surface ? "/in_3d/checks/" : "/checks/") + std::to_string(i);
    references.push_back(read(subject, {subject, entry, manifest.file.string() + ' ' + at}));
    references.back().at = at;
  }
  return references;
}

std::string no_references(const Subject& subject) {
  const bool of_lattice = subject.manifest().kind == plugin::ModelKind::collision;
  return "its manifest has no reference numbers (\"checks\") from the model's source" +
         (of_lattice ? " with " + std::to_string(arrays_of(subject, "populations").size()) + " populations"
                     : std::string());
}

/// The reference's element, and further ones with each of its inputs a tenth smaller and larger.
Values with_neighbours(const Values& inputs) {
  Values all;
  for (const auto& [name, values] : inputs) {
    const std::size_t place = all.size();
    auto& array = all[name];
    array.assign(1 + 2 * inputs.size(), values[0]);
    array[1 + 2 * place] *= 0.9;
    array[2 + 2 * place] *= 1.1;
  }
  return all;
}

Finding compare_references(const Subject& subject) {
  const plugin::Manifest& manifest = subject.manifest();
  const auto references = references_of(subject);
  if (references.empty()) {
    const bool is_pinned_elsewhere = manifest.kind == plugin::ModelKind::collision;
    return (is_pinned_elsewhere ? Finding::skipped : Finding::warned)(no_references(subject));
  }
  Worst worst;
  for (const Reference& reference : references) {
    const Values inputs = with_neighbours(reference.inputs);
    const Values outputs = compute(subject, reference.trial.instance, inputs, reference.call);
    for (const auto& [name, wanted] : reference.expected) {
      const auto& found = outputs.at(name);
      const double expected = wanted[0];
      double size = std::abs(expected);
      // Populations cancel in sums of all of them.
      if (manifest.kind == plugin::ModelKind::collision) {
        for (const auto& entry : reference.expected) size = std::max(size, std::abs(entry.second[0]));
      }
      for (std::size_t k = 1; size == 0 && k < found.size(); ++k) size = std::max(size, std::abs(found[k]));
      const double scale = expected == 0 ? 1 : 1 / std::abs(expected);
      worst.add(std::abs(found[0] - expected) * scale, reference.tolerance * size * scale, [&, &name = name] {
        const double unit = reference.trial.setting.units.unit(dimension_of_array(subject, name));
        return name + " is " + number(found[0] * unit, 17) + " SI at " +
               place(subject, reference.trial.setting, inputs, 0) + ", the manifest's " + reference.at + " says " +
               number(expected * unit, 17) + (reference.source.empty() ? "" : " (" + reference.source + ')') +
               "; the difference is";
      });
    }
  }
  return worst.finding("exactly the reference numbers");
}

/// Whether what a reference names comes out otherwise with other parameters or inputs.
bool differs(const Subject& subject, const Reference& reference, const plugin::ModelInstance& instance,
             const Values& inputs) {
  const Values before = compute(subject, reference.trial.instance, reference.inputs, reference.call);
  const Values after = compute(subject, instance, inputs, reference.call);
  return std::any_of(reference.expected.begin(), reference.expected.end(), [&](const auto& entry) {
    const double was = before.at(entry.first)[0], is = after.at(entry.first)[0];
    return !(std::abs(is - was) <= 10 * reference.tolerance * std::max(std::abs(was), std::abs(is)));
  });
}

bool is_cutoff(const Subject& subject, const Trial& trial, std::size_t k) {
  if (subject.manifest().kind != plugin::ModelKind::interaction) return false;
  const plugin::Parameter& parameter = subject.manifest().parameters[k];
  if (parameter.dimension != units::dimension::length) return false;
  const double here = trial.instance.interaction().cutoff(trial.instance.self());
  return std::abs(trial.setting.units.to_si(here, parameter.dimension) / trial.parameters[k] - 1) < 1e-12;
}

bool parameter_is_pinned(const Subject& subject, const Reference& reference, std::size_t k) {
  if (is_cutoff(subject, reference.trial, k)) return true;
  const double value = reference.trial.parameters[k];
  for (const double other : {1.01 * value, 0.99 * value}) {
    auto parameters = reference.trial.parameters;
    parameters[k] = other;
    try {
      return differs(subject, reference, subject.make(parameters, reference.trial.setting), reference.inputs);
    } catch (const plugin::ModelRefused&) {  // to this side there is a limit
    }
  }
  return false;
}

/// Whether a derivative, which the check of derivatives has looked at, is 0 whatever goes in: there is no other number.
bool is_always_zero(const Subject& subject, const std::string& output) {
  if (output.find("_by_") == std::string::npos) return false;
  Random random = subject.random();
  const auto all = trials(subject, random, subject.typical_setting());
  return std::all_of(all.begin(), all.end(), [&](const Trial& trial) {
    const auto values = compute(subject, trial.instance, subject.random_inputs(trial.instance, 64, random)).at(output);
    return std::all_of(values.begin(), values.end(), [](double value) { return value == 0; });
  });
}

/// What the model is must follow from its manifest: a factor, a sign or a unit that is wrong in all formulas alike is
/// seen against numbers from elsewhere only.
Finding pinned(const Subject& subject) {
  const plugin::Manifest& manifest = subject.manifest();
  const auto references = references_of(subject);
  if (references.empty()) return Finding::failed(no_references(subject));
  const auto any = [&](const auto& test) { return std::any_of(references.begin(), references.end(), test); };
  std::vector<std::string> loose;
  for (std::size_t k = 0; k < manifest.parameters.size(); ++k) {
    const plugin::Parameter& parameter = manifest.parameters[k];
    const bool measured = parameter.role && is_measured(manifest, *parameter.role);
    for (std::size_t word = 0; word < parameter.choices.size(); ++word) {
      const auto has = [&](const Reference& r) { return r.trial.parameters[k] == static_cast<double>(word); };
      if (!any(has)) loose.push_back(parameter.name + " = " + parameter.choices[word]);
    }
    if (measured || !parameter.choices.empty()) continue;
    if (!any([&](const Reference& r) { return parameter_is_pinned(subject, r, k); })) loose.push_back(parameter.name);
  }
  if (!loose.empty()) {  // what has an effect in the other dimension alone is for its numbers
    const auto idle = idle_parameters_here(subject);
    std::erase_if(loose, [&](const auto& name) { return std::find(idle.begin(), idle.end(), name) != idle.end(); });
  }
  const auto see = [&](const std::string& array, const std::string& name) {
    const bool matters = any([&](const Reference& r) {
      Values inputs = r.inputs;
      inputs[array][0] = inputs[array][0] == 0 ? 1e-3 : 1.01 * inputs[array][0];
      return differs(subject, r, r.trial.instance, inputs);
    });
    if (!matters) loose.push_back(name);
  };
  const auto demand = [&](const std::string& array, const std::string& name) {
    const bool given = any([&](const Reference& r) {
      const auto found = r.expected.find(array);
      return found != r.expected.end() && found->second[0] != 0;
    });
    if (!given && !is_always_zero(subject, array)) loose.push_back(name);
  };
  for (const std::string& name : manifest.needs) {
    for (const std::string& array : arrays_of(subject, name)) see(array, name);
  }
  for (const std::string& name : manifest.gives) {
    for (const std::string& array : arrays_of(subject, name)) demand(array, name);
  }
  for (std::size_t k = 0; k < manifest.state.size(); ++k) {
    see(state_array(k), manifest.state[k].name);
    demand(state_array(k), "the next " + manifest.state[k].name + " (with a \"time_step\")");
  }
  if (manifest.kind == plugin::ModelKind::collision) {
    for (const bool inertia : {false, true}) {
      if (!any([&](const Reference& r) { return r.trial.setting.inertia == inertia; })) {
        loose.emplace_back(inertia ? "\"inertia\": true" : "\"inertia\": false");
      }
    }
  }
  loose.erase(std::unique(loose.begin(), loose.end()), loose.end());
  if (loose.empty()) return Finding::passed("reference numbers depend on all that goes in and give all that comes out");
  return Finding::failed("no reference number (\"checks\") says anything of " + listed(loose));
}

}  // namespace

std::vector<Check> publish_checks() {
  return {
      {"reference",
       Level::physics,
       "gives the reference results of its manifest",
       {"units", "gradient", "derivative", "derivatives", "cutoff", "rigid-motion", "moduli", "dissipation",
        "closed-loop", "look-after-step", "half-steps", "settles", "momentum", "velocity", "equilibrium",
        "stress-relaxation", "symmetry", "reductions"},
       compare_references},
      {"pinned",
       Level::publish,
       "has reference results for every parameter, choice, input and output",
       {"reference"},
       pinned},
  };
}

}  // namespace rouleau::conform
