#include "subject.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <functional>

#include "plugin/quantities.hpp"

namespace rouleau::conform {

namespace {

/// A value inside an interval: in the middle, of positive numbers in the middle of their logarithms.
double between(double low, double high, double share) {
  if (low > 0) return low * std::pow(high / low, share);
  return low + (high - low) * share;
}

/// A value that the limits allow, for parameters without default and usual range.
double allowed(const plugin::Parameter& parameter) {
  const auto low = parameter.minimum ? parameter.minimum : parameter.exclusive_minimum;
  const auto high = parameter.maximum ? parameter.maximum : parameter.exclusive_maximum;
  if (low && high) return between(*low, *high, 0.5);
  if (low) return *low > 0 ? 2 * *low : *low < 0 ? *low / 2 : 1;
  if (high) return *high > 0 ? *high / 2 : *high < 0 ? 2 * *high : -1;
  return 1;
}

double usual_or_allowed(const plugin::Parameter& parameter) {
  if (!parameter.choices.empty()) return 0;
  if (parameter.usual) return between((*parameter.usual)[0], (*parameter.usual)[1], 0.5);
  return allowed(parameter);
}

}  // namespace

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::vector<std::string> arrays_of(const Subject& subject, const std::string& quantity) {
  const plugin::ModelKind kind = subject.manifest().kind;
  const int dimension = subject.dimension();
  const auto components = [&](int count) {
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) names.push_back(quantity + '.' + std::to_string(k));
    return names;
  };
  if (kind == plugin::ModelKind::collision && quantity == "populations") return components(dimension == 2 ? 9 : 19);
  if (kind == plugin::ModelKind::collision && (quantity == "force" || quantity == "velocity"))
    return components(dimension);
  return {quantity};
}

std::vector<double> Subject::typical_parameters() const {
  std::vector<double> values;
  for (const plugin::Parameter& parameter : manifest_.parameters) {
    const bool idle = manifest_.inactive_when.is_object() && manifest_.inactive_when.contains(parameter.name);
    values.push_back(parameter.default_value && !idle ? *parameter.default_value : usual_or_allowed(parameter));
  }
  return values;
}

std::vector<std::vector<double>> Subject::parameters_of_each_choice() const {
  const auto typical = typical_parameters();
  std::vector<std::vector<double>> all = {typical};
  for (std::size_t i = 0; i < typical.size(); ++i) {
    for (std::size_t word = 0; word < manifest_.parameters[i].choices.size(); ++word) {
      auto values = typical;
      values[i] = static_cast<double>(word);
      if (values != typical) all.push_back(std::move(values));
    }
  }
  return all;
}

std::vector<double> Subject::random_parameters(Random& random) const {
  std::vector<double> values = typical_parameters();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const plugin::Parameter& parameter = manifest_.parameters[i];
    const auto which = random() % 8;
    if (which < 3) continue;
    if (!parameter.choices.empty()) {
      values[i] = static_cast<double>(random() % parameter.choices.size());
    } else if (which == 3 && parameter.usual && (*parameter.usual)[0] == parameter.minimum) {
      values[i] = *parameter.minimum;
    } else if (parameter.usual) {
      // Not its very ends, which may touch a limit that is not allowed itself.
      values[i] = between((*parameter.usual)[0], (*parameter.usual)[1], uniform(random, 0.01, 0.99));
    } else if (const double near = values[i] * uniform(random, 0.8, 1.25);
               (!parameter.minimum || near >= *parameter.minimum) &&
               (!parameter.exclusive_minimum || near > *parameter.exclusive_minimum) &&
               (!parameter.maximum || near <= *parameter.maximum) &&
               (!parameter.exclusive_maximum || near < *parameter.exclusive_maximum)) {
      values[i] = near;
    }
  }
  return values;
}

plugin::ModelSetting Subject::typical_setting() const {
  const double length = 0.1955e-6, density = 1000, viscosity = 1.2e-6, relaxation = 3000;  // m, kg/m3, m2/s, 1
  const double simulated_density = density * relaxation;
  const double time = length * length / (6 * viscosity / relaxation);
  return {{length, time, simulated_density * length * length * length}, 1, false, dimension()};
}

std::vector<plugin::ModelSetting> Subject::settings() const {
  std::vector<plugin::ModelSetting> all = {typical_setting()};
  if (manifest_.kind != plugin::ModelKind::collision) return all;
  all.push_back(all[0]);
  all[1].inertia = true;
  all[1].relaxation_rate = 1.3;
  return all;
}

std::vector<plugin::ModelInstance> Subject::make_each_choice() const {
  std::vector<plugin::ModelInstance> instances;
  for (const plugin::ModelSetting& setting : settings()) {
    for (const auto& values : parameters_of_each_choice()) {
      try {
        instances.push_back(make(values, setting));
      } catch (const plugin::ModelRefused&) {  // a word that goes only with other values of other parameters
        if (instances.empty()) throw;          // typical ones go together
      }
    }
  }
  return instances;
}

std::vector<bool> Subject::precisions() const {
  if (manifest_.kind == plugin::ModelKind::collision) return {false, true};
  return {false};
}

std::vector<std::string> Subject::input_arrays() const {
  std::vector<std::string> names;
  for (const auto& need : manifest_.needs) {
    for (auto& name : arrays_of(*this, need)) names.push_back(std::move(name));
  }
  for (std::size_t k = 0; k < manifest_.state.size(); ++k) names.push_back("state." + std::to_string(k));
  return names;
}

std::vector<std::string> Subject::output_arrays() const {
  std::vector<std::string> names;
  for (const auto& given : manifest_.gives) {
    for (auto& name : arrays_of(*this, given)) names.push_back(std::move(name));
  }
  for (std::size_t k = 0; k < manifest_.state.size(); ++k) names.push_back("state." + std::to_string(k));
  return names;
}

std::vector<std::string> Subject::drawn() const {
  if (!manifest_.needs.empty()) return manifest_.needs;
  return {plugin::inputs_of(manifest_.kind, dimension()).front()};
}

}  // namespace rouleau::conform
