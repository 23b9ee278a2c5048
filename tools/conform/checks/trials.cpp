#include "trials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/text.hpp"
#include "plugin/quantities.hpp"

namespace rouleau::conform {

namespace {

/// How parameters differ from the typical ones.
std::string differences(const Subject& subject, const std::vector<double>& values) {
  const auto typical = subject.typical_parameters();
  const units::Units units;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const plugin::Parameter& parameter = subject.manifest().parameters[i];
    if (values[i] == typical[i]) continue;
    if (!parameter.choices.empty()) {
      words.push_back(parameter.name + ' ' + parameter.choices[static_cast<std::size_t>(values[i])]);
    } else {
      const std::string unit = parameter.unit == "1" ? "" : ' ' + parameter.unit;
      words.push_back(parameter.name + ' ' + number(values[i] / units.scale(parameter.unit), 10) + unit);
    }
  }
  return words.empty() ? "" : " with " + listed(words);
}

void try_to_make(std::vector<Trial>& trials, const Subject& subject, const std::vector<double>& values,
                 const plugin::ModelSetting& setting) {
  try {
    trials.push_back({subject.make(values, setting), values, setting, differences(subject, values)});
  } catch (const plugin::ModelRefused&) {  // parameters that do not go together
    if (trials.empty()) throw;             // typical ones do
  }
}

}  // namespace

std::vector<Trial> trials(const Subject& subject, Random& random, const plugin::ModelSetting& setting, int draws) {
  std::vector<Trial> all;
  for (const auto& values : subject.parameters_of_each_choice()) try_to_make(all, subject, values, setting);
  if (subject.manifest().parameters.empty()) return all;
  const std::size_t wanted = all.size() + static_cast<std::size_t>(draws);
  for (int i = 0; i < 20 * draws && all.size() < wanted; ++i) {
    try_to_make(all, subject, subject.random_parameters(random), setting);
  }
  return all;
}

std::vector<Trial> setting_trials(const Subject& subject, Random& random, int draws) {
  std::vector<Trial> all;
  for (const plugin::ModelSetting& setting : subject.settings()) {
    for (Trial& trial : trials(subject, random, setting, draws)) {
      if (setting.inertia) trial.words = " (inertia on)" + trial.words;
      all.push_back(std::move(trial));
    }
  }
  return all;
}

std::vector<Trial> collision_trials(const Subject& subject, Random& random, int draws) {
  std::vector<Trial> all;
  const std::array<double, 3> rates = {uniform(random, 0.1, 1.95), 1, random() % 2 == 0 ? 1.999999 : 0.01};
  for (int i = 0; i < 6; ++i) {
    const bool inertia = i % 2 == 1;
    plugin::ModelSetting setting = subject.typical_setting();
    setting.inertia = inertia;
    setting.relaxation_rate = rates[i / 2];
    for (Trial& trial : trials(subject, random, setting, i < 2 ? draws : 0)) {
      trial.words = (inertia ? " (inertia on)" : " (inertia off)") + trial.words;
      all.push_back(std::move(trial));
    }
  }
  return all;
}

Values sensitivity(const Subject& subject, const Trial& trial, const Values& inputs, Random& random, double roundings,
                   bool only_units, const Results& results) {
  const Values before = results(trial.instance, inputs);
  const auto jitter = [&](double& value, const units::Dimension& dimension) {
    if (only_units && dimension == units::Dimension{}) return;
    value *= 1 + roundings * std::numeric_limits<double>::epsilon() * uniform(random, -1, 1);
  };
  Values most = before;
  for (auto& [name, values] : most) std::fill(values.begin(), values.end(), 0.0);
  for (int i = 0; i < 8; ++i) {
    auto parameters = trial.parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const plugin::Parameter& parameter = subject.manifest().parameters[k];
      if (parameter.choices.empty()) jitter(parameters[k], parameter.dimension);
    }
    Values near = inputs;
    for (auto& [name, values] : near) {
      const units::Dimension dimension = dimension_of_array(subject, name);
      for (double& value : values) jitter(value, dimension);
    }
    try {
      const Values moved = results(subject.make(parameters, trial.setting), near);
      for (auto& [name, values] : most) {
        for (std::size_t k = 0; k < values.size(); ++k) {
          values[k] = std::max(values[k], std::abs(moved.at(name)[k] - before.at(name)[k]));
        }
      }
    } catch (const plugin::ModelRefused&) {  // at the very limit of what it takes
    }
  }
  return most;
}

units::Dimension dimension_of_array(const Subject& subject, const std::string& array) {
  if (array.starts_with("state.")) return subject.manifest().state[std::stoul(array.substr(6))].dimension;
  return plugin::dimension_of(subject.manifest(), array);
}

std::string in_si(const Subject& subject, const plugin::ModelSetting& setting, const std::string& name, double lattice,
                  int digits) {
  const std::string unit = plugin::unit_of(subject.manifest(), name);
  return number(setting.units.to_si(lattice, plugin::dimension_of(subject.manifest(), name)), digits) +
         (unit.empty() ? "" : ' ' + unit);
}

std::string place(const Subject& subject, const plugin::ModelSetting& setting, const Values& inputs,
                  std::size_t element) {
  std::vector<std::string> words;
  for (const std::string& name : subject.manifest().needs) {
    for (const std::string& array : arrays_of(subject, name)) {
      words.push_back(array + ' ' + in_si(subject, setting, name, inputs.at(array)[element], 10));
    }
  }
  for (std::size_t k = 0; k < subject.manifest().state.size(); ++k) {
    const plugin::StateVariable& variable = subject.manifest().state[k];
    const double value = inputs.at("state." + std::to_string(k))[element];
    words.push_back(variable.name + ' ' + number(setting.units.to_si(value, variable.dimension), 10));
  }
  return listed(words);
}

}  // namespace rouleau::conform
