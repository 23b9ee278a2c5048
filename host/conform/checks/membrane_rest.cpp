#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "differences.hpp"
#include "membrane_work.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {}  // namespace

void keep_state(Values& inputs, const Values& outputs) {
  for (auto& [name, values] : inputs) {
    if (name.starts_with("state.")) values = outputs.at(name);
  }
}

std::vector<MembraneCoordinate> coordinates_of(const plugin::Manifest& manifest) {
  const std::vector<MembraneCoordinate> all = {{"stretch", "tension", "", 1},
                                               {"curvature", "moment", "rest_curvature", 1},
                                               {"area", "pressure", "rest_area", -1},
                                               {"perimeter", "perimeter_tension", "rest_perimeter", 1}};
  std::vector<MembraneCoordinate> given;
  for (const auto& coordinate : all) {
    if (manifest.gives_output(coordinate.force)) given.push_back(coordinate);
  }
  return given;
}

Values at_rest(const Subject& subject, const Trial& trial, std::size_t count, Random& random) {
  Values inputs = subject.random_inputs(trial.instance, count, random);
  const auto set = [&](const std::string& name, double value) {
    if (inputs.contains(name)) inputs[name].assign(count, value);
  };
  set("stretch", 1);
  set("stretch_rate", 0);
  for (const std::string name : {"curvature", "area", "perimeter"}) {
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

}  // namespace rouleau::conform
