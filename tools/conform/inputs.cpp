// Inputs that models are tried with: those of a flowing suspension, rare ones, and any at all.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>

#include "call.hpp"
#include "subject.hpp"

namespace rouleau::conform {

namespace {

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

/// The ranges of what simulations meet, in lattice units: Mach numbers below 0.1, stretches by a half to two, cells of
/// about twenty spacings.
std::map<std::string, std::pair<double, double>> usual_ranges(double cutoff) {
  return {{"populations", {-0.01, 0.01}},
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
}

/// Inputs that belong together, as membranes and contacts have them: invariants of one deformation, values near to
/// rest.
void tie(Values& inputs, std::size_t count, Random& random) {
  if (inputs.contains("invariant_1") || inputs.contains("invariant_2")) {  // of two stretches, which both are real
    for (std::size_t i = 0; i < count; ++i) {
      // Both below a quarter, a triangle has a hundredth of its area: no cell comes there, and exponentials overflow.
      const auto draw = [&] {
        return random() % 8 == 0 ? std::max(0.25, rare("stretch", 2, random)) : uniform(random, 0.5, 2);
      };
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
}

/// A node's numbers are small or large together.
void scale_nodes(Values& inputs, std::size_t count, Random& random) {
  for (std::size_t i = 0; i < count; ++i) {
    if (random() % 8 != 0) continue;
    const double factor = std::pow(10.0, uniform(random, -10, 1.4));
    for (auto& [name, values] : inputs) {
      if (name != "relaxation_rate") values[i] *= factor;
    }
  }
}

}  // namespace

Values Subject::random_inputs(const plugin::ModelInstance& instance, std::size_t count, Random& random,
                              int steps) const {
  const double cutoff =
      manifest_.kind == plugin::ModelKind::interaction ? instance.interaction().cutoff(instance.self()) : 0;
  const auto ranges = usual_ranges(cutoff);
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
    tie(inputs, count, random);
    if (manifest_.kind == plugin::ModelKind::collision) scale_nodes(inputs, count, random);
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
