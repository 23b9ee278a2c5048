#include "effects.hpp"

#include <algorithm>

#include "conform/call.hpp"

namespace rouleau::conform {

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

namespace {

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

Effects effects_of(const Subject& subject) {
  const auto& parameters = subject.manifest().parameters;
  Effects effects{std::vector<bool>(parameters.size()), {}};
  for (const auto& parameter : parameters) effects.of_word.emplace_back(parameter.choices.size());
  auto& [matters, words_matter] = effects;
  Random random = subject.random();
  for (const plugin::ModelSetting& setting : subject.settings()) {
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
  return effects;
}

}  // namespace

std::vector<std::string> idle_parameters_here(const Subject& subject) {
  const auto& parameters = subject.manifest().parameters;
  const auto [matters, words_matter] = effects_of(subject);
  std::vector<std::string> idle;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (!matters[k] && parameters[k].choices.empty()) idle.push_back(parameters[k].name);
    for (std::size_t word = 0; word < words_matter[k].size(); ++word) {
      if (!words_matter[k][word]) idle.push_back(parameters[k].name + " = " + parameters[k].choices[word]);
    }
  }
  return idle;
}

std::vector<std::string> idle_parameters(const Subject& subject) {
  std::vector<std::string> idle = idle_parameters_here(subject);
  const std::optional<Subject> other = subject.in_other_dimension();
  if (idle.empty() || subject.manifest().kind != plugin::ModelKind::membrane || !other) return idle;
  if (other->manifest().needs == subject.manifest().needs) return idle;
  const std::vector<std::string> there = idle_parameters_here(*other);
  std::erase_if(idle, [&](const auto& name) { return std::find(there.begin(), there.end(), name) == there.end(); });
  return idle;
}

}  // namespace rouleau::conform
