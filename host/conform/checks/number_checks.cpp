// Level "robustness" and "physics" for models of every kind: what is no number stays visible, what is declared matters,
// what is not declared does not, and roundings have no preferred direction.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"
#include "collision_nodes.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "trials.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

bool is_tracked(const std::string& output) {
  return !output.starts_with("state.") && output.find("_by_") == std::string::npos;
}

/// Energies and forces that depend on an input are no numbers where the input is none: a run that has gone wrong ends
/// there with a reason, instead of going on with an invented number. Plugins of the first release need not know it.
Finding nan_out(const Subject& subject) {
  Random random = subject.random();
  for (const Trial& trial : trials(subject, random, subject.typical_setting(), 2)) {
    for (const bool single : subject.precisions()) {
      Call call;
      call.single = single;
      const std::size_t count = some_count(random);
      const Values inputs = subject.random_inputs(trial.instance, count, random);
      const Values other = subject.random_inputs(trial.instance, count, random);
      const Values before = compute(subject, trial.instance, inputs, call);
      for (const std::string& name : subject.input_arrays()) {
        Values changed = inputs, sick = inputs;
        changed[name] = other.at(name);
        sick[name].assign(count, std::nan(""));
        const Values after = compute(subject, trial.instance, changed, call);
        for (const auto& [output, values] : compute(subject, trial.instance, sick, call)) {
          if (!is_tracked(output)) continue;
          for (std::size_t i = 0; i < count; ++i) {
            const double usual = before.at(output)[i], moved = after.at(output)[i];
            if (std::isnan(values[i]) || usual == moved || !std::isfinite(usual) || !std::isfinite(moved)) continue;
            return Finding::warned(output + '[' + std::to_string(i) + "] is " + number(values[i], 17) + " where " +
                                   name + " is not a number, though it depends on it" + trial.words);
          }
        }
      }
    }
  }
  return Finding::passed("what depends on an input that is no number is no number");
}

/// Whether two instances give the same at inputs that are the same, for any of several time steps.
bool alike(const Subject& subject, const plugin::ModelInstance& one, const plugin::ModelInstance& other,
           Random& random) {
  if (subject.manifest().kind == plugin::ModelKind::interaction &&
      one.interaction().cutoff(one.self()) != other.interaction().cutoff(other.self())) {
    return false;
  }
  const Values inputs = subject.random_inputs(one, some_count(random), random);
  for (const double time_step : {0.0, 1.0, 1e3, 1e6}) {
    for (const bool single : subject.precisions()) {
      Call call;
      call.single = single;
      call.time_step = time_step;
      if (!first_difference(compute(subject, one, inputs, call), compute(subject, other, inputs, call)).empty()) {
        return false;
      }
    }
    if (subject.manifest().state.empty()) break;
  }
  return true;
}

/// Other values of a parameter: each other word, or what is usual, or what is near.
std::vector<double> others(const Subject& subject, std::size_t parameter, double value, Random& random) {
  const plugin::Parameter& p = subject.manifest().parameters[parameter];
  std::vector<double> values;
  for (std::size_t word = 0; word < p.choices.size(); ++word) values.push_back(static_cast<double>(word));
  for (int i = 0; i < 40 && p.choices.empty(); ++i) values.push_back(subject.random_parameters(random)[parameter]);
  if (p.choices.empty()) values.insert(values.end(), {1.1 * value, 0.9 * value});
  std::erase(values, value);
  if (values.size() > 6) values.erase(values.begin(), values.end() - 6);
  return values;
}

/// Random parameters, and each at the ends of what is usual: 0 often switches a part of a model, on which then others
/// have their effect.
std::vector<Trial> trials_at_ends(const Subject& subject, Random& random, const plugin::ModelSetting& setting) {
  std::vector<Trial> all = trials(subject, random, setting, 12);
  for (std::size_t k = 0; k < subject.manifest().parameters.size(); ++k) {
    const plugin::Parameter& parameter = subject.manifest().parameters[k];
    std::vector<double> ends;
    if (parameter.minimum) ends.push_back(*parameter.minimum);
    if (parameter.usual) ends.insert(ends.end(), parameter.usual->begin(), parameter.usual->end());
    for (const double end : ends) {
      auto values = subject.typical_parameters();
      values[k] = end;
      try {
        all.push_back({subject.make(values, setting), values, setting, {}});
      } catch (const plugin::ModelRefused&) {  // the end of a range need not be allowed
      }
    }
  }
  return all;
}

/// Which parameters and which of their words have changed a result.
struct Effects {
  std::vector<bool> of_parameter;
  std::vector<std::vector<bool>> of_word;
};

void look_for_effects(const Subject& subject, Effects& effects) {
  const auto& parameters = subject.manifest().parameters;
  auto& [matters, words_matter] = effects;
  Random random = subject.random();
  for (const bool inertia : {true, false}) {
    plugin::ModelSetting setting = subject.typical_setting();
    setting.inertia = inertia;
    setting.relaxation_rate = 1.3;
    for (const Trial& trial : trials_at_ends(subject, random, setting)) {
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        if (matters[k] && parameters[k].choices.empty()) continue;
        for (const double value : others(subject, k, trial.parameters[k], random)) {
          const auto word = static_cast<std::size_t>(parameters[k].choices.empty() ? 0 : value);
          if (!parameters[k].choices.empty() && words_matter[k][word]) continue;
          auto changed = trial.parameters;
          changed[k] = value;
          try {
            if (alike(subject, trial.instance, subject.make(changed, setting), random)) continue;
          } catch (const plugin::ModelRefused&) {  // it does look at the value
            continue;
          }
          matters[k] = true;
          if (!parameters[k].choices.empty()) words_matter[k][word] = true;
        }
      }
    }
  }
}

/// In one of the dimensions that a law knows, if it knows both.
Finding parameters_matter(const Subject& subject) {
  const auto& parameters = subject.manifest().parameters;
  if (parameters.empty()) return Finding::skipped("has no parameters");
  Effects effects{std::vector<bool>(parameters.size()), {}};
  for (const auto& parameter : parameters) effects.of_word.emplace_back(parameter.choices.size());
  look_for_effects(subject, effects);
  const bool law = subject.manifest().kind == plugin::ModelKind::membrane;
  if (law && subject.dimension() == 2 && subject.manifest().works_in(3)) look_for_effects(subject.in(3), effects);
  const auto& [matters, words_matter] = effects;
  std::vector<std::string> idle;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (!matters[k]) {
      idle.push_back(parameters[k].name);
      continue;
    }
    for (std::size_t word = 0; word < words_matter[k].size(); ++word) {
      if (!words_matter[k][word]) idle.push_back(parameters[k].name + " = " + parameters[k].choices[word]);
    }
  }
  if (idle.empty()) return Finding::passed("each parameter and each choice changes something");
  return Finding::warned("nothing was seen to depend on " + listed(idle));
}

/// The fluid's relaxation rate and inertia are in the setup for collision operators. What a membrane or a potential is
/// does not depend on them: its manifest has no word for it.
Finding fluid_independent(const Subject& subject) {
  if (subject.manifest().kind == plugin::ModelKind::collision) return Finding::skipped("is a collision operator");
  Random random = subject.random();
  const plugin::ModelSetting here = subject.typical_setting();
  for (const Trial& trial : trials(subject, random, here)) {
    for (int i = 0; i < 4; ++i) {
      plugin::ModelSetting there = here;
      there.inertia = i % 2 == 1;
      if (i >= 2) there.relaxation_rate = uniform(random, 0.1, 1.99);
      if (alike(subject, trial.instance, subject.make(trial.parameters, there), random)) continue;
      return Finding::failed("gives something else when the fluid has " +
                             std::string(there.inertia ? "inertia" : "no inertia") + " and the relaxation rate " +
                             number(there.relaxation_rate) + trial.words);
    }
  }
  return Finding::passed("the same bits whatever the fluid's relaxation rate and inertia are");
}

/// Mean and spread of what a collision adds to mass and momentum beyond what it should, over many nodes in single
/// precision. Rounding to nearest has no direction: with n nodes the mean is off by the spread over the square root of
/// n. What the constants' own rounding (1/9, 1/36) does to each node alike comes on top: less than an eighth of an
/// epsilon of the size, while cutting digits off costs half of one for each operation.
Finding bias(const Subject& subject) {
  if (!subject.manifest().claims.value("conservative", true))
    return Finding::skipped("says that it is not conservative");
  constexpr std::size_t count = 100'000;
  constexpr double single_epsilon = std::numeric_limits<float>::epsilon();
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : collision_trials(subject, random, 0)) {
    // Populations of one sign, where cutting digits off has one, too.
    Values inputs = subject.random_inputs(trial.instance, count, random);
    const double sign = random() % 2 == 0 ? 1 : -1;
    for (auto& [name, values] : inputs) {
      for (double& value : values) {
        if (name.starts_with("populations.")) value = sign * uniform(random, 0.001, 0.02);
        if (name.starts_with("force.")) value = sign * uniform(random, 1e-4, 1e-3);
        value = static_cast<float>(value);
      }
    }
    Call call;
    call.single = true;
    const Values outputs = compute(subject, trial.instance, inputs, call);
    std::array<double, 3> sum{}, squares{};
    const CollisionNodes all_before(inputs, trial), all_after(outputs, trial);
    double size = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const CollisionNode before = all_before[i], after = all_after[i];
      const std::array<double, 3> off = {after.density() - before.density(),
                                         after.momentum(0) - before.momentum(0) - before.force[0],
                                         after.momentum(1) - before.momentum(1) - before.force[1]};
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += off[k];
        squares[k] += off[k] * off[k];
      }
      size += before.size() / count;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double mean = sum[k] / count, spread = std::sqrt(squares[k] / count);
      worst.add(std::abs(mean), 6 * spread / std::sqrt(double{count}) + single_epsilon / 8 * size, [&] {
        return std::string(k == 0   ? "the density"
                           : k == 1 ? "the x-momentum"
                                    : "the y-momentum") +
               " of " + std::to_string(count) + " nodes in single precision changes in one direction" + trial.words +
               "; on the mean by";
      });
    }
  }
  return worst.finding("roundings of single precision have no direction");
}

}  // namespace

std::vector<Check> number_checks() {
  return {
      {"nan-out", Level::robustness, "answers a NaN with a NaN", {"contained"}, nan_out},
      {"parameters-matter",
       Level::robustness,
       "depends on each of its parameters and choices",
       {"hidden-state"},
       parameters_matter},
      {"fluid-independent",
       Level::physics,
       "depends on the fluid only as its manifest says",
       {"hidden-state", "units"},
       fluid_independent},
      {"bias",
       Level::physics,
       "rounds without shifting mass or momentum on average",
       {"mass", "momentum", "precision"},
       bias,
       plugin::ModelKind::collision},
  };
}

}  // namespace rouleau::conform
