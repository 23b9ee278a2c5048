#include "subject.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <functional>

#include "call.hpp"
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

void set(Values& values, const std::string& name, std::size_t count, const std::function<double()>& draw) {
  auto& array = values[name];
  array.resize(count);
  for (double& value : array) value = draw();
}

/// A double of any kind: ordinary, tiny, huge, a special value, or any bits at all.
double any_double(Random& random) {
  constexpr std::array special = {0.0, -0.0, 1.0, -1.0, 1e-310, 5e-324, 1e-300, 1e300, 1.7976931348623157e308};
  switch (random() % 5) {
    case 0:
      return uniform(random, -2, 2);
    case 1:
      return std::pow(10.0, uniform(random, -12, 12)) * (random() % 4 == 0 ? -1 : 1);
    case 2:
      return special[random() % special.size()];
    case 3:
      return random() % 2 == 0 ? std::nan("") : (random() % 2 == 0 ? 1 : -1) * HUGE_VAL;
    default:
      return std::bit_cast<double>(random());
  }
}

/// What is met now and then: numbers far from the usual ones, and near to where something ends.
double rare(const std::string& need, double high, Random& random) {
  const double power = uniform(random, 0, 1);
  if (need == "stretch" || need == "area_ratio") {
    return random() % 2 == 0 ? 0.1 * std::pow(50.0, power)
                             : 1 + std::pow(10.0, -1 - 9 * power) * uniform(random, -1, 1);
  }
  if (need == "distance") return high * (1 - std::pow(10.0, -1 - 5 * power));
  if (need == "relaxation_rate") {
    constexpr std::array special = {1.0, 1e-3, 0.01, 1.99, 1.9999, 1.999999};
    return special[random() % special.size()];
  }
  const double sign = need.ends_with("speed") || random() % 2 == 0 ? 1 : -1;
  if (need.ends_with("area") || need.ends_with("perimeter") || need.ends_with("volume"))
    return high * std::pow(2.0, sign * power);
  if (need == "populations" || need == "force") return uniform(random, -high, high);
  return sign * high * std::pow(10.0, 1 - 9 * power);  // rates, velocities, curvatures
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

Values Subject::random_inputs(const plugin::ModelInstance& instance, std::size_t count, Random& random,
                              int steps) const {
  const double cutoff =
      manifest_.kind == plugin::ModelKind::interaction ? instance.interaction().cutoff(instance.self()) : 0;
  // The ranges of what simulations meet, in lattice units: Mach numbers below 0.1, stretches by a half to two, cells of
  // about twenty spacings.
  const std::map<std::string, std::pair<double, double>> ranges = {{"populations", {-0.01, 0.01}},
                                                                   {"force", {-1e-3, 1e-3}},
                                                                   {"relaxation_rate", {0.3, 1.9}},
                                                                   {"stretch", {0.5, 2}},
                                                                   {"stretch_rate", {-1e-3, 1e-3}},
                                                                   {"curvature", {-0.5, 0.5}},
                                                                   {"rest_curvature", {-0.5, 0.5}},
                                                                   {"area", {250, 350}},
                                                                   {"rest_area", {280, 320}},
                                                                   {"perimeter", {80, 120}},
                                                                   {"rest_perimeter", {90, 110}},
                                                                   {"invariant_1", {0, 0}},
                                                                   {"invariant_2", {0, 0}},
                                                                   {"area_ratio", {0.5, 2}},
                                                                   {"volume", {3000, 5000}},
                                                                   {"rest_volume", {3800, 4200}},
                                                                   {"surface_area", {1200, 1600}},
                                                                   {"rest_surface_area", {1300, 1500}},
                                                                   {"distance", {0.02 * cutoff, cutoff}},
                                                                   {"normal_velocity", {-1e-3, 1e-3}},
                                                                   {"tangential_velocity", {-1e-3, 1e-3}},
                                                                   {"sliding_speed", {0, 1e-3}}};
  Values inputs;
  const auto draw_all = [&] {
    for (const auto& need : drawn()) {
      const auto [low, high] = ranges.at(need);
      for (const auto& name : arrays_of(*this, need)) {
        set(inputs, name, count, [&, low = low, high = high] {
          return random() % 8 == 0 ? rare(need, high, random) : uniform(random, low, high);
        });
      }
    }
    if (inputs.contains("invariant_1") || inputs.contains("invariant_2")) {  // of two stretches, which both are real
      for (std::size_t i = 0; i < count; ++i) {
        const auto draw = [&] { return random() % 8 == 0 ? rare("stretch", 2, random) : uniform(random, 0.5, 2); };
        const double one = draw(), two = draw();
        if (inputs.contains("invariant_1")) inputs["invariant_1"][i] = (one - 1) * (one + 1) + (two - 1) * (two + 1);
        if (inputs.contains("invariant_2")) inputs["invariant_2"][i] = (one * two - 1) * (one * two + 1);
      }
    }
    if (inputs.contains("sliding_speed") && inputs.contains("tangential_velocity")) {
      for (std::size_t i = 0; i < count; ++i) inputs["sliding_speed"][i] = std::abs(inputs["tangential_velocity"][i]);
    }
    for (const std::string name : {"curvature", "area", "perimeter", "volume", "surface_area"}) {  // near to rest
      if (!inputs.contains(name) || !inputs.contains("rest_" + name)) continue;
      for (std::size_t i = 0; i < count; ++i) {
        if (random() % 8 != 0) continue;
        inputs[name][i] = inputs["rest_" + name][i] * (1 + std::pow(10.0, -10 * uniform(random, 0, 1)));
      }
    }
    if (manifest_.kind != plugin::ModelKind::collision) return;
    for (std::size_t i = 0; i < count; ++i) {  // a node's numbers are small or large together
      if (random() % 8 != 0) continue;
      const double factor = std::pow(10.0, uniform(random, -10, 1.4));
      for (auto& [name, values] : inputs) {
        if (name != "relaxation_rate") values[i] *= factor;
      }
    }
  };
  for (std::size_t k = 0; k < manifest_.state.size(); ++k) {
    inputs["state." + std::to_string(k)].assign(count, instance.initial_state()[k]);
  }
  for (int step = 0; step < steps && !manifest_.state.empty(); ++step) {
    draw_all();
    Call call;
    call.time_step = std::pow(10.0, uniform(random, 0, 5));
    for (auto& [name, values] : inputs) {  // nothing moves during such long steps
      if (is_motion(name)) values.assign(count, 0);
    }
    const Values after = compute(*this, instance, inputs, call);
    for (auto& [name, values] : inputs) {
      if (name.starts_with("state.")) values = after.at(name);
    }
  }
  draw_all();
  return inputs;
}

Values Subject::any_inputs(std::size_t count, Random& random) const {
  Values inputs;
  for (const std::string& name : input_arrays()) set(inputs, name, count, [&] { return any_double(random); });
  if (inputs.empty()) inputs[drawn().front()].assign(count, 0);
  return inputs;
}

}  // namespace rouleau::conform
