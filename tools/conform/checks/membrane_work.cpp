#include "membrane_work.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "differences.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

constexpr std::size_t element_count = 16;
constexpr int marks = 16, periods = 3;  ///< work is noted `marks` times in each period

/// Smooth closed paths of each coordinate around its value at rest, where they begin: by at most a half of it.
class Path {
 public:
  Path(const std::vector<MembraneCoordinate>& coordinates, Random& random)
      : waves_(coordinates.size() * element_count * 3) {
    for (Wave& wave : waves_) {
      wave = {uniform(random, -1.0 / 12, 1.0 / 12), uniform(random, 0, 2 * std::numbers::pi)};
    }
  }
  struct Place {
    double change = 0, rate = 0;  ///< relative to the scale of the coordinate; per period
  };
  /// Where coordinate c of an element is; `time` in periods.
  [[nodiscard]] Place at(std::size_t c, std::size_t element, double time) const {
    Place place;
    for (std::size_t k = 0; k < 3; ++k) {
      const Wave& wave = waves_[(c * element_count + element) * 3 + k];
      const double frequency = 2 * std::numbers::pi * static_cast<double>(k + 1), angle = frequency * time + wave.phase;
      place.change += wave.amplitude * (std::sin(angle) - std::sin(wave.phase));
      place.rate += wave.amplitude * frequency * std::cos(angle);
    }
    return place;
  }

 private:
  struct Wave {
    double amplitude = 0, phase = 0;
  };
  std::vector<Wave> waves_;
};

struct Work {
  std::vector<double> done;  ///< on the element since the start, at each mark: mean force times step
  double last_period = 0;    ///< on it in the last period: force times rate at each instant, exact on smooth cycles
  double rough = 0;          ///< the sum of the sizes of all fourth differences of the force times steps
  double way = 0;            ///< the sum of the sizes of all steps, times the largest force
};

/// The work on each element along its path, by the trapezoidal rule.
std::vector<Work> work_along(const Subject& subject, const Trial& trial, const Path& path, const Values& rest,
                             double period, int steps) {
  const auto coordinates = coordinates_of(subject.manifest());
  std::vector<Work> work(element_count);
  Values inputs = rest;
  Call call;
  call.time_step = 0;
  Values before = compute(subject, trial.instance, inputs, call);
  call.time_step = period / steps;
  // A straight line curves as much as a cell does; invariants are 0 at rest.
  const auto scale = [&](std::size_t c, std::size_t i) {
    const std::string& variable = coordinates[c].variable;
    return variable == "curvature" || variable.starts_with("invariant") ? 0.2 : rest.at(coordinates[c].variable)[i];
  };
  std::vector<std::array<double, 5>> history(element_count * coordinates.size());
  std::vector<double> done(element_count), force(element_count * coordinates.size()), way(force.size());
  for (int step = 1; step <= steps * periods; ++step) {
    const Values last = inputs;
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
      const std::string& variable = coordinates[c].variable;
      for (std::size_t i = 0; i < element_count; ++i) {
        inputs[variable][i] =
            rest.at(variable)[i] + scale(c, i) * path.at(c, i, static_cast<double>(step) / steps).change;
      }
    }
    if (inputs.contains("stretch_rate")) {
      for (std::size_t i = 0; i < element_count; ++i) {
        inputs["stretch_rate"][i] = (inputs.at("stretch")[i] - last.at("stretch")[i]) / call.time_step;
      }
    }
    const Values after = compute(subject, trial.instance, inputs, call);
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
      const std::string &variable = coordinates[c].variable, &name = coordinates[c].force;
      for (std::size_t i = 0; i < element_count; ++i) {
        const double moved = inputs.at(variable)[i] - last.at(variable)[i];
        const double f0 = before.at(name)[i], f1 = after.at(name)[i];
        done[i] += coordinates[c].sign * 0.5 * (f0 + f1) * moved;
        if (step > steps * (periods - 1)) {
          const double rate = scale(c, i) * path.at(c, i, static_cast<double>(step) / steps).rate;
          work[i].last_period += coordinates[c].sign * f1 * rate / steps;
        }
        auto& row = history[c * element_count + i];
        row = {row[1], row[2], row[3], row[4], f1};
        if (step >= 5) {
          work[i].rough += std::abs(row[0] - 4 * row[1] + 6 * row[2] - 4 * row[3] + row[4]) * std::abs(moved);
        }
        way[c * element_count + i] += std::abs(moved);
        force[c * element_count + i] = std::max(force[c * element_count + i], std::abs(f1));
      }
    }
    before = after;
    keep_state(inputs, after);
    if (step % (steps / marks) == 0) {
      for (std::size_t i = 0; i < element_count; ++i) work[i].done.push_back(done[i]);
    }
  }
  for (std::size_t k = 0; k < way.size(); ++k) work[k % element_count].way += way[k] * force[k];
  return work;
}

/// A unit for work in messages: that of the energy of this element.
std::string energy_in_si(const Subject& subject, const Trial& trial, double lattice) {
  return in_si(subject, trial.setting, "energy", lattice);
}

bool remembers_or_sees_rates(const Subject& subject) {
  return !subject.manifest().state.empty() || subject.manifest().needs_input("stretch_rate");
}

bool can_move(const Subject& subject) {
  const auto coordinates = coordinates_of(subject.manifest());
  return std::all_of(coordinates.begin(), coordinates.end(), [&](const MembraneCoordinate& c) {
    return subject.manifest().needs_input(c.variable) && (c.rest.empty() || subject.manifest().needs_input(c.rest));
  });
}

/// Calls `see` with the work on each element, coarse and fine, over paths that take short and long times.
template <class See>
void for_each_path(const Subject& subject, const See& see) {
  Random random = subject.random();
  for (const Trial& trial : trials(subject, random, subject.typical_setting(), 2)) {
    for (int i = 0; i < 2; ++i) {
      const double period = std::pow(10.0, uniform(random, 2, 7));
      const Path path(coordinates_of(subject.manifest()), random);
      const Values rest = at_rest(subject, trial, element_count, random);
      const auto coarse = work_along(subject, trial, path, rest, period, 64);
      const auto fine = work_along(subject, trial, path, rest, period, 512);
      for (std::size_t k = 0; k < element_count; ++k) see(trial, rest, k, coarse[k], fine[k]);
    }
  }
}

/// Over any path that begins at rest an element gives back no more than was put in, and what it held at the start.
Finding dissipation_of_state(const Subject& subject) {
  Worst worst;
  for_each_path(subject,
                [&](const Trial& trial, const Values& rest, std::size_t k, const Work& coarse, const Work& fine) {
                  double start = 0;
                  if (subject.manifest().gives_output("energy")) {
                    Call look;
                    look.time_step = 0;
                    start = compute(subject, trial.instance, rest, look).at("energy")[k];
                  }
                  for (std::size_t mark = 0; mark < fine.done.size(); ++mark) {
                    // The rule's error is less than what eightfold refinement changes; forces round by some epsilon of
                    // the largest.
                    const double limit = std::abs(fine.done[mark] - coarse.done[mark]) + 64 * epsilon * fine.way;
                    const double given_back = std::max(0.0, -fine.done[mark] - start);
                    worst.add(given_back, limit, [&] {
                      return "an element that moved from rest for " + number(static_cast<double>(mark + 1) / marks, 3) +
                             " periods has given back " + energy_in_si(subject, trial, given_back) +
                             " more than was put in" + trial.words + "; in lattice units";
                    });
                  }
                });
  return worst.finding("no element gives back more than was put in");
}

Finding dissipation_of_rates(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    Values moving = subject.random_inputs(trial.instance, 201, random);
    for (double& rate : moving["stretch_rate"]) {
      rate = std::copysign(std::pow(10.0, uniform(random, -8, -1)), uniform(random, -1, 1));
    }
    Values still = moving;
    still["stretch_rate"].assign(201, 0);
    const Values with = compute(subject, trial.instance, moving), without = compute(subject, trial.instance, still);
    for (std::size_t i = 0; i < 201; ++i) {
      const double rate = moving["stretch_rate"][i], tension = with.at("tension")[i],
                   at_rest = without.at("tension")[i];
      const auto words = [&](const std::string& what) {
        return [&, what] { return what + " at " + place(subject, trial.setting, moving, i) + trial.words; };
      };
      // The two tensions are rounded on their own.
      worst.add(std::max(0.0, -(tension - at_rest) * rate),
                16 * epsilon * (std::abs(tension) + std::abs(at_rest)) * std::abs(rate),
                words("power given off by the part of the tension that depends on the rate, in lattice units,"));
      if (with.contains("tension_by_rate")) {
        worst.add(std::max(0.0, -with.at("tension_by_rate")[i]), 0, words("a negative tension_by_rate of the size"));
      }
    }
  }
  return worst.finding("what depends on the rate takes energy");
}

/// Of triangles, whose stress by the rate of strain the host makes.
Finding dissipation_of_viscosities(const Subject& subject) {
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    Values inputs = subject.random_inputs(trial.instance, 201, random);
    const Values outputs = compute(subject, trial.instance, inputs);
    for (const std::string name : {"shear_viscosity", "area_viscosity"}) {
      if (!outputs.contains(name)) continue;
      for (std::size_t i = 0; i < outputs.at(name).size(); ++i) {
        worst.add(std::max(0.0, -outputs.at(name)[i]), 0, [&] {
          return "a negative " + name + " at " + place(subject, trial.setting, inputs, i) + trial.words +
                 " of the size";
        });
      }
    }
  }
  return worst.finding("what depends on the rate takes energy");
}

}  // namespace

Finding check_dissipation(const Subject& subject) {
  if (subject.manifest().gives_output("shear_viscosity") || subject.manifest().gives_output("area_viscosity")) {
    return dissipation_of_viscosities(subject);
  }
  if (!remembers_or_sees_rates(subject)) return Finding::skipped("depends on no rate and has no state");
  if (!can_move(subject)) return Finding::skipped("does not see all coordinates that it gives forces for");
  return subject.manifest().state.empty() ? dissipation_of_rates(subject) : dissipation_of_state(subject);
}

/// The last of three periods, when state has forgotten the start.
Finding check_closed_loop(const Subject& subject) {
  if (!can_move(subject)) return Finding::skipped("does not see all coordinates that it gives forces for");
  const bool conservative = subject.manifest().claims.value("conservative", false);
  Worst worst;
  for_each_path(
      subject, [&](const Trial& trial, const Values&, std::size_t /*element*/, const Work& coarse, const Work& fine) {
        const auto by_steps = [&](const Work& work) { return work.done.back() - work.done[marks * (periods - 1) - 1]; };
        const double work = fine.last_period, wrong = conservative ? std::abs(work) : std::max(0.0, -work);
        // Where a law has kinks the sum has an error, which two rules and two steps show, or fourth differences where
        // a force jumps; these are tiny where it is smooth.
        const double limit =
            4 * std::abs(work - by_steps(fine)) + std::abs(by_steps(coarse)) / 8 + fine.rough + 64 * epsilon * fine.way;
        worst.add(wrong, limit, [&] {
          return "a closed cycle takes the work " + energy_in_si(subject, trial, work) +
                 (conservative ? ", expected none" : ", expected none or more") + trial.words + "; in lattice units";
        });
      });
  return worst.finding("no cycle takes work that it must not");
}

}  // namespace rouleau::conform
