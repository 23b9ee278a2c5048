// Level "physics" for models with state: steps lead to the same state however they are cut, and to a limit.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "membrane_work.hpp"
#include "trials.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

constexpr std::size_t state_elements = 64;

bool is_state(const std::string& name) { return name.starts_with("state."); }
/// Derivatives belong to the step, as it is solved implicitly; energies and forces to the state after it.
bool is_derivative(const std::string& name) { return name.find("_by_") != std::string::npos; }

/// Nothing moves any more.
void stop(Values& inputs) {
  for (auto& [name, values] : inputs) {
    if (is_motion(name)) values.assign(values.size(), 0);
  }
}

/// The outputs after `steps` equal steps from the inputs' state that take `time` altogether. The inputs are those at
/// the end; what moves moved evenly.
Values advanced(const Subject& subject, const Trial& trial, const Values& end, double time, int steps) {
  Values inputs = end, outputs;
  Call call;
  call.time_step = time / steps;
  for (int step = 1; step <= steps; ++step) {
    const double left = time - call.time_step * step;
    for (const auto& [place, rate] : {std::pair{"stretch", "stretch_rate"}, std::pair{"distance", "normal_velocity"}}) {
      if (!inputs.contains(place) || !inputs.contains(rate)) continue;
      for (std::size_t i = 0; i < state_elements; ++i) inputs[place][i] = end.at(place)[i] - left * end.at(rate)[i];
    }
    outputs = compute(subject, trial.instance, inputs, call);
    keep_state(inputs, outputs);
  }
  return outputs;
}

/// What a step gives is what someone sees who looks at the new state.
Finding look_after_step(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    const Values inputs = subject.random_inputs(trial.instance, state_elements, random);
    for (const double time_step : {1.0, std::pow(10.0, uniform(random, 0, 5))}) {
      Call step, look;
      step.time_step = time_step;
      look.time_step = 0;
      const Values after = compute(subject, trial.instance, inputs, step);
      Values there = inputs;
      keep_state(there, after);
      const Values seen = compute(subject, trial.instance, there, look);
      // How much the rounding of the state and of what is measured matters depends on the formula.
      const Values most =
          sensitivity(subject, trial, there, random, 8, false,
                      [&](const auto& instance, const Values& near) { return compute(subject, instance, near, look); });
      for (const auto& [name, values] : seen) {
        if (is_state(name) || is_derivative(name)) continue;
        for (std::size_t i = 0; i < state_elements; ++i) {
          const double stepped = after.at(name)[i];
          if (std::isnan(stepped) && std::isnan(values[i])) continue;
          const double limit =
              32 * most.at(name)[i] + 256 * epsilon * std::abs(values[i]) + std::numeric_limits<double>::min();
          worst.add(std::abs(stepped - values[i]), limit, [&, &name = name, &values = values] {
            return name + " of a step is " + number(stepped, 17) + " and, computed from the state after it, " +
                   number(values[i], 17) + ", in lattice units, at " + place(subject, trial.setting, inputs, i) +
                   trial.words + "; they differ by";
          });
        }
      }
    }
  }
  return worst.finding("a step gives the forces of the state that it leaves");
}

/// How one step and two of half its length change the state of an element.
struct Halving {
  double change = 0, difference = 0;  ///< in whichever way it changes more; between both ways
  double size = 0, start = 0;         ///< of the state, and before the steps
};

std::vector<Halving> halvings(const Subject& subject, const Trial& trial, const Values& inputs, double time) {
  const Values one = advanced(subject, trial, inputs, time, 1), two = advanced(subject, trial, inputs, time, 2);
  std::vector<Halving> all;
  for (const auto& [name, values] : one) {
    if (!is_state(name)) continue;
    for (std::size_t i = 0; i < state_elements; ++i) {
      const double before = inputs.at(name)[i];
      const double other = two.at(name)[i];
      all.push_back({std::max(std::abs(values[i] - before), std::abs(other - before)), std::abs(other - values[i]),
                     std::max({std::abs(values[i]), std::abs(before), std::abs(other)}), std::abs(before)});
    }
  }
  return all;
}

/// A step that follows an equation differs from two half ones by the square of its length or less, so that what they
/// differ by vanishes against the change itself, or falls by sixteen where steps are four times shorter.
Finding half_steps(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    for (const bool moving : {false, true}) {
      Values inputs = subject.random_inputs(trial.instance, state_elements, random);
      if (!moving) stop(inputs);
      for (std::size_t k = 0; k < subject.manifest().state.size() && random() % 2 == 0; ++k) {
        inputs["state." + std::to_string(k)].assign(state_elements, trial.instance.initial_state()[k]);
      }
      // From the longest step to the shortest that still changes something: what a long one may do is not asked, and
      // around the time of something quick, which may be the 2^-200th of a step, steps differ; not so the ones below.
      constexpr int enough = 9;
      struct Told {
        double size = 0, before = 0, change = 0, difference = 0, limit = 0;
        int bad = 0;  ///< how many steps have been, each four times as long as the next
      };
      const auto& states = subject.manifest().state;
      std::vector<Told> told(states.size() * state_elements);
      bool changes = true;
      for (int exponent = 30; exponent > 0 || (changes && exponent >= -400); exponent -= 2) {
        const auto all = halvings(subject, trial, inputs, std::ldexp(1.0, exponent));
        changes = false;
        for (std::size_t k = 0; k < all.size(); ++k) {
          Told& here = told[k];
          const double longer = std::exchange(here.before, all[k].difference);
          if (!std::isfinite(all[k].size)) continue;
          if (exponent <= 0 || all[k].difference < 0.1 * all[k].change) here.size = std::max(here.size, all[k].size);
          const double noise = 256 * epsilon * std::max(here.size, all[k].start);
          if (all[k].change <= 1e5 * noise) continue;
          changes = true;
          here.change = all[k].change;
          here.difference = all[k].difference;
          double largest = 0;  // it may be what is left of sums with the element's others
          for (std::size_t j = k % state_elements; j < all.size(); j += state_elements) {
            const bool alike = states[j / state_elements].dimension == states[k / state_elements].dimension;
            if (alike) largest = std::max({largest, told[j].size, all[j].start});
          }
          here.limit = std::max(1e-2 * here.change + 256 * epsilon * largest, longer / 8);
          here.bad = here.difference > here.limit ? here.bad + 1 : 0;
        }
      }
      for (std::size_t k = 0; k < told.size(); ++k) {
        worst.add(told[k].bad < enough ? 0 : told[k].difference, told[k].limit, [&] {
          return "short steps change state." + std::to_string(k / state_elements) + ", such as by " +
                 number(told[k].change, 6) + " in its own units, at " +
                 place(subject, trial.setting, inputs, k % state_elements) + trial.words +
                 "; two of half its length differ from it by";
        });
      }
    }
  }
  return worst.finding("steps of any length lead to the same");
}

/// Forces of elements that are held still, after 64, 128 and 256 steps of some length.
struct Course {
  std::array<Values, 3> forces;
  std::vector<bool> steady;  ///< by element: the steps are short enough for it
  std::vector<bool> felt;    ///< by element: a single one changes its state by a thousandth
};

Course held(const Subject& subject, const Trial& trial, const Values& start, double time_step) {
  Course course;
  course.steady.assign(state_elements, true);
  course.felt.assign(state_elements, false);
  const auto all = halvings(subject, trial, start, time_step);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool tells = all[k].difference <= 0.25 * all[k].change + 1e-12 * all[k].size;
    if (!tells) course.steady[k % state_elements] = false;
    if (all[k].change > 1e-3 * all[k].size) course.felt[k % state_elements] = true;
  }
  Values inputs = start;
  Call call;
  call.time_step = time_step;
  std::size_t mark = 0;
  for (int step = 1; step <= 256; ++step) {
    Values outputs = compute(subject, trial.instance, inputs, call);
    keep_state(inputs, outputs);
    if (step != 64 << mark) continue;
    std::erase_if(outputs, [](const auto& entry) { return is_state(entry.first) || is_derivative(entry.first); });
    course.forces[mark++] = std::move(outputs);
  }
  return course;
}

/// Held still, an element's forces come to a limit, the same one whatever the steps; or at least they slow down.
Finding settles(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : trials(subject, random, subject.typical_setting(), 2)) {
    Values start = subject.random_inputs(trial.instance, state_elements, random);
    stop(start);
    for (std::size_t k = 0; k < subject.manifest().state.size(); ++k) {
      start["state." + std::to_string(k)].assign(state_elements, trial.instance.initial_state()[k]);
    }
    Call look;
    look.time_step = 0;
    const Values first = compute(subject, trial.instance, start, look);
    std::map<std::string, std::vector<std::optional<double>>> limits;
    for (const int exponent : {0, 5, 10, 15, 20, 25, 30, 40}) {
      const Course course = held(subject, trial, start, std::ldexp(1.0, exponent));
      for (const auto& [name, values] : course.forces[2]) {
        auto& limit = limits[name];
        limit.resize(state_elements);
        for (std::size_t i = 0; i < state_elements; ++i) {
          if (!course.steady[i]) continue;
          const double early = course.forces[0].at(name)[i], late = course.forces[1].at(name)[i];
          const double size = std::max({std::abs(first.at(name)[i]), std::abs(early), std::abs(late)});
          const double c1 = std::abs(late - early), c2 = std::abs(values[i] - late);
          const auto words = [&](const std::string& what) {
            return [&, what] {
              return what + ", in lattice units, at " + place(subject, trial.setting, start, i) + trial.words;
            };
          };
          // Twice the time, twice the change: that is no relaxation. What slows down, if only as a logarithm, may.
          if (exponent >= 30 || !std::isfinite(c2)) {
            worst.add(c2, 1.5 * c1 + 1e-10 * size,
                      words(name + " goes on changing while nothing moves: by " + number(c1, 6) +
                            " over some time and then, over twice that time, by"));
          }
          if (!(c1 + c2 <= 1e-9 * size) || !course.felt[i]) continue;
          if (limit[i]) {
            worst.add(std::abs(values[i] - *limit[i]), 1e-6 * size,
                      words(name + " comes to " + number(*limit[i], 17) + " in short steps and to " +
                            number(values[i], 17) + " in longer ones; they differ by"));
          } else {
            limit[i] = values[i];
          }
        }
      }
    }
  }
  return worst.finding("forces come to rest where nothing moves");
}

Finding with_state(const Subject& subject, Finding (*check)(const Subject&)) {
  return subject.manifest().state.empty() ? Finding::skipped("has no state") : check(subject);
}

}  // namespace

std::vector<Check> state_checks() {
  constexpr auto level = Level::physics;
  return {
      {"look-after-step",
       level,
       "gives the forces of the state at the end of a step",
       {"compute", "state-restored"},
       [](const Subject& subject) { return with_state(subject, look_after_step); }},
      {"half-steps",
       level,
       "reaches the same state in one short step and in two half steps",
       {"state-restored"},
       [](const Subject& subject) { return with_state(subject, half_steps); }},
      {"settles",
       level,
       "settles to one limit when held still, whatever the step",
       {"half-steps"},
       [](const Subject& subject) { return with_state(subject, settles); }},
  };
}

}  // namespace rouleau::conform
