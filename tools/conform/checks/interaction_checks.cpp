// Level "physics" for interactions: force and its derivative against differences, the cutoff, contact.
#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "differences.hpp"
#include "membrane_work.hpp"
#include "trials.hpp"

namespace rouleau::conform {

namespace {

Finding compare(const Subject& subject, const DerivativeClaim& claim) {
  Random random = subject.random();
  Worst worst;
  Decided decided;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    compare_derivative(worst, decided, subject, trial, subject.random_inputs(trial.instance, 256, random), claim);
    if (claim.function != "energy" || !subject.manifest().state.empty()) continue;
    const double cutoff = trial.instance.interaction().cutoff(trial.instance.self());
    for (const auto& [low, high] : {std::pair{0.02, 0.2}, {0.2, 1.0}, {0.99, 1.0}}) {
      compare_work(worst, subject, trial, subject.random_inputs(trial.instance, 1, random), claim, low * cutoff,
                   high * cutoff);
    }
  }
  if (decided.yes < decided.no && worst.passes()) {
    return Finding::warned(claim.function + " is too rough for differences to tell at " + std::to_string(decided.no) +
                           " of " + std::to_string(decided.yes + decided.no) + " distances");
  }
  return worst.finding("as the differences are");
}

Finding gradient(const Subject& subject) {
  if (!subject.manifest().claims.value("conservative", false)) {
    return Finding::skipped("does not claim to be conservative");
  }
  if (!subject.manifest().gives_output("energy")) {
    return Finding::failed("claims to be conservative, but gives no energy that its force could be derived from");
  }
  return compare(subject, {"force", "energy", "distance", -1});
}

Finding derivative(const Subject& subject) {
  if (!subject.manifest().gives_output("force_by_distance")) return Finding::skipped("gives no force_by_distance");
  return compare(subject, {"force_by_distance", "force", "distance", 1});
}

/// Inputs of which the distance is what is given.
Values at_distances(const Subject& subject, const Trial& trial, const std::vector<double>& distances, Random& random) {
  Values inputs = subject.random_inputs(trial.instance, distances.size(), random);
  if (inputs.contains("distance")) inputs["distance"] = distances;
  return inputs;
}

/// The largest size of an output over the outer half of the range: not at contact, where many diverge. At the cutoff
/// terms as large are subtracted from each other.
double size_of(const Subject& subject, const Trial& trial, const std::string& name, double cutoff, Random& random) {
  std::vector<double> distances;
  distances.reserve(101);
  for (int i = 0; i < 101; ++i) distances.push_back(cutoff * (0.5 + 0.005 * i));
  const auto values = compute(subject, trial.instance, at_distances(subject, trial, distances, random)).at(name);
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

Finding cutoff(const Subject& subject) {
  Random random = subject.random();
  const bool smooth = subject.manifest().claims.value("smooth_at_cutoff", false);
  Worst worst;
  std::string jumps;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    const auto ask = [&] { return trial.instance.interaction().cutoff(trial.instance.self()); };
    const double range = ask();
    if (!(range > 0) || !std::isfinite(range)) {
      return Finding::failed("the cutoff is " + in_si(subject, trial.setting, "distance", range) + trial.words);
    }
    const Values outputs = compute(subject, trial.instance, at_distances(subject, trial, {range}, random));
    if (ask() != range) return Finding::failed("the cutoff is another one after a call" + trial.words);
    for (const std::string name : {"energy", "force"}) {
      if (!outputs.contains(name)) continue;
      const double end = outputs.at(name)[0], size = size_of(subject, trial, name, range, random);
      const std::string words = name + ' ' + in_si(subject, trial.setting, name, end) + " at the cutoff of " +
                                in_si(subject, trial.setting, "distance", range) + trial.words;
      // Terms of the size that it has around are subtracted, in vectors perhaps with other roundings than alone.
      if (smooth) worst.add(std::abs(end), 64 * epsilon * size, [&] { return words + "; in lattice units"; });
      if (!smooth && trial.words.empty()) jumps += (jumps.empty() ? "" : ", ") + words;
    }
  }
  if (smooth) return worst.finding("energy and force are 0 at the cutoff");
  return Finding::passed("breaks off, as it may, with " + jumps);
}

Finding near_zero(const Subject& subject) {
  Random random = subject.random();
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    const double range = trial.instance.interaction().cutoff(trial.instance.self());
    std::vector<double> distances;
    for (int i = 0; i <= 60; ++i) distances.push_back(range * std::pow(10.0, -0.1 * i));
    const Values inputs = at_distances(subject, trial, distances, random);
    for (const auto& [name, values] : compute(subject, trial.instance, inputs)) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isfinite(values[i])) continue;
        return Finding::failed(name + " is " + number(values[i]) + " at " + place(subject, trial.setting, inputs, i) +
                               trial.words);
      }
    }
  }
  return Finding::passed("finite from the cutoff down to a millionth of it");
}

Finding energy_optional(const Subject& subject) {
  if (!subject.manifest().gives_output("energy")) return Finding::skipped("gives no energy");
  Random random = subject.random();
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    const Values inputs = subject.random_inputs(trial.instance, 101, random);
    Call without;
    without.outputs.emplace();
    for (const std::string& name : subject.output_arrays()) {
      if (name != "energy") without.outputs->insert(name);
    }
    const std::string difference =
        first_difference(compute(subject, trial.instance, inputs, without), compute(subject, trial.instance, inputs));
    if (!difference.empty()) return Finding::failed("without and with the energy, " + difference + trial.words);
  }
  return Finding::passed("the same bits without and with the energy");
}

}  // namespace

std::vector<Check> interaction_checks() {
  constexpr auto kind = plugin::ModelKind::interaction;
  return {
      {"gradient", Level::physics, "gives a force that is -d energy/d distance", {"compute"}, gradient, kind},
      {"derivative",
       Level::physics,
       "gives a force_by_distance that is d force/d distance",
       {"compute", "gradient"},
       derivative,
       kind},
      {"cutoff",
       Level::physics,
       "has a positive, constant cutoff, and ends there as it claims",
       {"compute", "gradient"},
       cutoff,
       kind},
      {"near-zero", Level::physics, "is finite down to a millionth of the cutoff", {"compute"}, near_zero, kind},
      {"energy-optional",
       Level::physics,
       "gives the same force with and without the energy",
       {"compute"},
       energy_optional,
       kind},
      {"state-restored",
       Level::physics,
       "continues from a copy of its state, bit for bit",
       {"compute"},
       check_state_restored,
       kind},
  };
}

}  // namespace rouleau::conform
