// Level "robustness" and "physics" for models of every kind: what is no number stays visible, what is declared matters,
// what is not declared does not, and roundings have no preferred direction.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hpp"
#include "collision_nodes.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "effects.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

bool is_tracked(const std::string& output) {
  return !output.starts_with("state.") && output.find("_by_") == std::string::npos;
}

/// Energies and forces that depend on an input are no numbers where the input is none: a run that has gone wrong ends
/// there with a reason, instead of going on with an invented number. Plugins of the first release need not know it.
Finding nan_out(const Subject& subject) {
  Random random = subject.random();
  for (const Trial& trial : setting_trials(subject, random, 2)) {
    for (const bool single : subject.precisions()) {
      Call call;
      call.single = single;
      const std::size_t count = some_count(random);
      const Values inputs = subject.random_inputs(trial.instance, count, random);
      const Values other = subject.random_inputs(trial.instance, count, random);
      const Values before = compute(subject, trial.instance, inputs, call);
      for (const std::string& name : subject.input_arrays()) {
        Values changed = inputs, sick = inputs;
        changed[name] = other.at(name);
        sick[name].assign(count, std::nan(""));
        const Values after = compute(subject, trial.instance, changed, call);
        for (const auto& [output, values] : compute(subject, trial.instance, sick, call)) {
          if (!is_tracked(output)) continue;
          for (std::size_t i = 0; i < count; ++i) {
            const double usual = before.at(output)[i], moved = after.at(output)[i];
            if (std::isnan(values[i]) || usual == moved || !std::isfinite(usual) || !std::isfinite(moved)) continue;
            return Finding::warned(output + '[' + std::to_string(i) + "] is " + number(values[i], 17) + " where " +
                                   name + " is not a number, though it depends on it" + trial.words);
          }
        }
      }
    }
  }
  return Finding::passed("what depends on an input that is no number is no number");
}

Finding parameters_matter(const Subject& subject) {
  if (subject.manifest().parameters.empty()) return Finding::skipped("has no parameters");
  const auto idle = idle_parameters(subject);
  if (idle.empty()) return Finding::passed("each parameter and each choice changes something");
  return Finding::warned("nothing was seen to depend on " + listed(idle));
}

/// The fluid's relaxation rate and inertia are in the setup for collision operators. What a membrane or a potential is
/// does not depend on them: its manifest has no word for it.
Finding fluid_independent(const Subject& subject) {
  if (subject.manifest().kind == plugin::ModelKind::collision) return Finding::skipped("is a collision operator");
  Random random = subject.random();
  const plugin::ModelSetting here = subject.typical_setting();
  for (const Trial& trial : trials(subject, random, here)) {
    for (int i = 0; i < 4; ++i) {
      plugin::ModelSetting there = here;
      there.inertia = i % 2 == 1;
      if (i >= 2) there.relaxation_rate = uniform(random, 0.1, 1.99);
      if (alike(subject, trial.instance, subject.make(trial.parameters, there), random)) continue;
      return Finding::failed("gives something else when the fluid has " +
                             std::string(there.inertia ? "inertia" : "no inertia") + " and the relaxation rate " +
                             number(there.relaxation_rate) + trial.words);
    }
  }
  return Finding::passed("the same bits whatever the fluid's relaxation rate and inertia are");
}

/// Mean and spread of what a collision adds to mass and momentum beyond what it should, over many nodes in single
/// precision. Rounding to nearest has no direction: with n nodes the mean is off by the spread over the square root of
/// n. What the constants' own rounding (1/9, 1/36) does to each node alike comes on top: that of the weights, times the
/// relaxation rate, is an eighth of an epsilon of the density on D3Q19, whose 1/3 rounds most, and a sixteenth on D2Q9.
/// Twice that is allowed, while cutting digits off costs half of one for each operation.
Finding bias(const Subject& subject) {
  if (!subject.manifest().claims.value("conservative", true))
    return Finding::skipped("says that it is not conservative");
  constexpr std::size_t count = 50'000;
  double of_weights = 0;
  for (const double weight : VelocitySet::of(subject.dimension()).weight) {
    of_weights += std::abs(static_cast<float>(weight) - weight);
  }
  Random random = subject.random();
  Worst worst;
  for (const Trial& trial : collision_trials(subject, random, 0)) {
    // Populations of one sign, where cutting digits off has one, too.
    Values inputs = subject.random_inputs(trial.instance, count, random);
    const double sign = random() % 2 == 0 ? 1 : -1;
    for (auto& [name, values] : inputs) {
      for (double& value : values) {
        if (name.starts_with("populations.")) value = sign * uniform(random, 0.001, 0.02);
        if (name.starts_with("force.")) value = sign * uniform(random, 1e-4, 1e-3);
        value = static_cast<float>(value);
      }
    }
    Call call;
    call.single = true;
    const Values outputs = compute(subject, trial.instance, inputs, call);
    const CollisionNodes all_before(inputs, trial), all_after(outputs, trial);
    const auto axes = static_cast<std::size_t>(subject.dimension());
    std::array<double, 4> sum{}, squares{};  // of density, then of momentum
    double size = 0, rate = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const CollisionNode before = all_before[i], after = all_after[i];
      for (std::size_t k = 0; k <= axes; ++k) {
        const double off = k == 0 ? after.density() - before.density()
                                  : after.momentum(k - 1) - before.momentum(k - 1) - before.force[k - 1];
        sum[k] += off;
        squares[k] += off * off;
      }
      size += before.size() / count;
      rate += before.relaxation_rate / count;
    }
    for (std::size_t k = 0; k <= axes; ++k) {
      const double mean = sum[k] / count, spread = std::sqrt(squares[k] / count);
      worst.add(std::abs(mean), 6 * spread / std::sqrt(double{count}) + 2 * of_weights * std::max(1.0, rate) * size,
                [&] {
                  return "the " + (k == 0 ? "density" : std::string(1, "xyz"[k - 1]) + "-momentum") + " of " +
                         std::to_string(count) + " nodes in single precision changes in one direction" + trial.words +
                         "; on the mean by";
                });
    }
  }
  return worst.finding("roundings of single precision have no direction");
}

}  // namespace

std::vector<Check> number_checks() {
  return {
      {"nan-out", Level::robustness, "answers a NaN with a NaN", {"contained"}, nan_out},
      {"parameters-matter",
       Level::robustness,
       "depends on each of its parameters and choices",
       {"hidden-state"},
       parameters_matter},
      {"fluid-independent",
       Level::physics,
       "depends on the fluid only as its manifest says",
       {"hidden-state", "units"},
       fluid_independent},
      {"bias",
       Level::physics,
       "rounds without shifting mass or momentum on average",
       {"mass", "momentum", "precision"},
       bias,
       plugin::ModelKind::collision},
  };
}

}  // namespace rouleau::conform
