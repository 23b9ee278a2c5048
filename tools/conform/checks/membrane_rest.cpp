#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "differences.hpp"
#include "membrane_work.hpp"
#include "worst.hpp"

namespace rouleau::conform {

void keep_state(Values& inputs, const Values& outputs) {
  for (auto& [name, values] : inputs) {
    if (name.starts_with("state.")) values = outputs.at(name);
  }
}

std::vector<MembraneCoordinate> coordinates_of(const plugin::Manifest& manifest) {
  const std::vector<MembraneCoordinate> all = {{"stretch", "tension", "", 1},
                                               {"curvature", "moment", "rest_curvature", 1},
                                               {"area", "pressure", "rest_area", -1},
                                               {"perimeter", "perimeter_tension", "rest_perimeter", 1},
                                               {"invariant_1", "stress_1", "", 1},
                                               {"invariant_2", "stress_2", "", 1},
                                               {"area_ratio", "area_tension", "", 1},
                                               {"volume", "pressure", "rest_volume", -1},
                                               {"surface_area", "surface_tension", "rest_surface_area", 1}};
  std::vector<MembraneCoordinate> given;
  for (const auto& coordinate : all) {
    const bool of_other_dimension =
        coordinate.force == "pressure" && (coordinate.variable == "volume") != (manifest.dimension() == 3);
    if (manifest.gives_output(coordinate.force) && !of_other_dimension) given.push_back(coordinate);
  }
  return given;
}

Values at_rest(const Subject& subject, const Trial& trial, std::size_t count, Random& random) {
  Values inputs = subject.random_inputs(trial.instance, count, random);
  const auto set = [&](const std::string& name, double value) {
    if (inputs.contains(name)) inputs[name].assign(count, value);
  };
  set("stretch", 1);
  set("area_ratio", 1);
  for (const char* name : {"stretch_rate", "invariant_1", "invariant_2"}) set(name, 0);
  for (const std::string name : {"curvature", "area", "perimeter", "volume", "surface_area"}) {
    if (inputs.contains(name) && inputs.contains("rest_" + name)) inputs[name] = inputs.at("rest_" + name);
  }
  for (std::size_t k = 0; k < subject.manifest().state.size(); ++k) {
    set("state." + std::to_string(k), trial.instance.initial_state()[k]);
  }
  return inputs;
}

Finding check_rigid_motion(const Subject& subject) {
  Random random = subject.random();
  const bool has_state = !subject.manifest().state.empty(), gives_energy = subject.manifest().gives_output("energy");
  Worst worst;
  Decided decided;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    Values inputs = subject.random_inputs(trial.instance, 101, random);
    Values moving = inputs;
    if (inputs.contains("stretch_rate")) inputs["stretch_rate"].assign(101, 0);
    Call look, step;
    look.time_step = 0;
    step.time_step = std::pow(10.0, uniform(random, 0, 5));
    const Values now = compute(subject, trial.instance, inputs, look);
    const Values later = compute(subject, trial.instance, inputs, step);
    if (has_state && gives_energy) {
      for (std::size_t i = 0; i < 101; ++i) {
        const double gain = later.at("energy")[i] - now.at("energy")[i];
        worst.add(std::max(0.0, gain), 64 * epsilon * std::abs(now.at("energy")[i]), [&] {
          return "the energy grows, in lattice units, while nothing moves, at " +
                 place(subject, trial.setting, inputs, i) + trial.words;
        });
      }
    }
    if (has_state) continue;
    if (const auto difference = first_difference(now, later); !difference.empty()) {
      return Finding::failed("what does not move depends on the time step (0 and " + number(step.time_step) +
                             "): " + difference + trial.words);
    }
    if (!inputs.contains("stretch_rate") || !gives_energy) continue;
    const auto& still_energy = now.at("energy");
    const auto moving_energy = compute(subject, trial.instance, moving).at("energy");
    for (std::size_t i = 0; i < 101; ++i) {
      worst.add(std::abs(moving_energy[i] - still_energy[i]), 16 * epsilon * std::abs(still_energy[i]), [&] {
        return "the energy depends on the rate, in lattice units by, at " + place(subject, trial.setting, moving, i) +
               trial.words;
      });
    }
    // What is left without motion is the gradient of the energy.
    compare_derivative(worst, decided, subject, trial, inputs, {"tension", "energy", "stretch", 1});
  }
  return worst.finding("what does not move gives the same whatever the time step");
}

Finding check_state_restored(const Subject& subject) {
  if (subject.manifest().state.empty()) return Finding::skipped("has no state");
  Random random = subject.random();
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    const Values start = subject.random_inputs(trial.instance, 101, random);
    Call look;
    look.time_step = 0;
    Values looked = compute(subject, trial.instance, start, look);
    std::erase_if(looked, [](const auto& entry) { return !entry.first.starts_with("state."); });
    if (const auto difference = first_difference(start, looked); !difference.empty()) {
      return Finding::failed("a time step of 0 changes " + difference + trial.words);
    }
    std::vector<Values> course;
    course.reserve(20);
    for (int step = 0; step < 20; ++step) course.push_back(subject.random_inputs(trial.instance, 101, random));
    const auto run = [&](const Trial& on) {
      Values state = start, outputs;
      for (Values inputs : course) {
        keep_state(inputs, state);
        outputs = state = compute(subject, on.instance, inputs);
      }
      return outputs;
    };
    const Values first = run(trial), again = run(trial);
    if (const auto difference = first_difference(first, again); !difference.empty()) {
      return Finding::failed("20 steps from a copy of the state give other bits: " + difference + trial.words);
    }
    const Trial other{subject.make(trial.parameters, trial.setting), trial.parameters, trial.setting, trial.words};
    if (const auto difference = first_difference(first, run(other)); !difference.empty()) {
      return Finding::failed("20 steps from a copy of the state in another instance give other bits: " + difference +
                             trial.words);
    }
  }
  return Finding::passed("20 steps from a copy of the state give the same bits; a time step of 0 leaves them");
}

namespace {

/// Whether the trial has chosen that the membrane keeps its width across the plane.
bool is_clamped(const Subject& subject, const Trial& trial) {
  for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
    const auto& words = subject.manifest().parameters[k].choices;
    if (!words.empty() && words[static_cast<std::size_t>(trial.parameters[k])] == "clamped") return true;
  }
  return false;
}

/// A sheet that is stretched along one direction and keeps its width is the same in both dimensions: T(l) = 2 l (w1 +
/// w2) at I1 = I2 = l^2 - 1.
void compare_clamped(Worst& worst, const Subject& outline, const Subject& surface) {
  Random random = outline.random();
  constexpr std::size_t count = 64;
  for (const Trial& trial : trials(outline, random, outline.typical_setting())) {
    if (!is_clamped(outline, trial)) continue;
    Values segments = outline.random_inputs(trial.instance, count, random), triangles;
    if (!segments.contains("stretch")) return;
    for (double& l : segments["stretch"]) {
      const double invariant = (l - 1) * (l + 1);
      for (const char* name : {"invariant_1", "invariant_2"}) triangles[name].push_back(invariant);
      if (l < 0.7) l = std::sqrt(1 + invariant);  // that of the rounded number: near -1 its last digit is many of l^2
    }
    plugin::ModelSetting setting = trial.setting;
    setting.dimension = 3;
    const Trial same{surface.make(trial.parameters, setting), trial.parameters, setting, trial.words};
    Values stretched = segments;
    for (double& l : stretched["stretch"]) l *= 1.01;
    const Values one = compute(outline, trial.instance, segments), away = compute(outline, trial.instance, stretched);
    const Values two = compute(surface, same.instance, triangles);
    for (std::size_t i = 0; i < count; ++i) {
      const double l = segments.at("stretch")[i], w1 = two.at("stress_1")[i], w2 = two.at("stress_2")[i];
      const double tension = one.at("tension")[i];
      // Sums of two terms, and what rounding l^2 makes of a stiff law's tension.
      const double stiffness = 100 * std::abs(away.at("tension")[i] - tension);
      const double limit = 64 * epsilon * 2 * l * (std::abs(w1) + std::abs(w2)) + 16 * epsilon * stiffness;
      worst.add(std::abs(2 * l * (w1 + w2) - tension), limit, [&] {
        return "clamped at the stretch " + number(l, 6) + " a triangle's tension 2 l (stress_1 + stress_2) is " +
               in_si(outline, trial.setting, "tension", 2 * l * (w1 + w2)) + ", a segment's " +
               in_si(outline, trial.setting, "tension", tension) + trial.words + "; in lattice units they differ by";
      });
    }
  }
}

}  // namespace

Finding check_clamped(const Subject& outline) {
  const std::optional<Subject> surface = outline.in_other_dimension();
  if (outline.dimension() == 3 || !surface)
    return Finding::skipped("is compared where the law works in both dimensions");
  const plugin::Manifest& law = surface->manifest();
  if (!law.gives_output("stress_1") || !law.gives_output("stress_2")) return Finding::skipped("gives no stresses");
  Worst worst;
  compare_clamped(worst, outline, *surface);
  if (worst.count() == 0) return Finding::skipped("has no choice \"clamped\"");
  return worst.finding("the same in both dimensions");
}

}  // namespace rouleau::conform
