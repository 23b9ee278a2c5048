// Level "physics" for membrane laws: forces against energies, derivatives, the state of rest, degenerate elements.
#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "differences.hpp"
#include "membrane_work.hpp"
#include "plugin/quantities.hpp"
#include "worst.hpp"

namespace rouleau::conform {

namespace {

/// Where a variable of this element may lie while its others stay.
std::pair<double, double> range_of(const std::string& variable, const Values& element) {
  if (variable == "stretch") return {0.25, 4};
  if (variable == "curvature") return {-0.5, 0.5};
  const double value = element.at(variable)[0];
  // Both stretches are real: I1 + 2 >= 2 sqrt(I2 + 1).
  if (variable == "invariant_1") {
    const double least = element.contains("invariant_2") ? 2 * std::sqrt(element.at("invariant_2")[0] + 1) - 2 : -1;
    return {least, least + 6};
  }
  if (variable == "invariant_2") {
    const double most = element.contains("invariant_1") ? std::pow(element.at("invariant_1")[0] / 2 + 1, 2) : 4;
    return {0.05 * most - 1, most - 1};
  }
  return {0.25 * value, 2 * value};
}

Finding compare(const Subject& subject, const std::vector<DerivativeClaim>& claims) {
  Random random = subject.random();
  Worst worst;
  Decided decided;
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    const Values inputs = subject.random_inputs(trial.instance, 256, random);
    for (const DerivativeClaim& claim : claims) {
      if (inputs.contains(claim.variable)) {
        compare_derivative(worst, decided, subject, trial, inputs, claim);
        if (claim.function != "energy" || !subject.manifest().state.empty()) continue;
        const Values element = subject.random_inputs(trial.instance, 1, random);
        const auto [low, high] = range_of(claim.variable, element);
        const double middle = low + uniform(random, 0.1, 0.9) * (high - low);
        for (const auto& [from, to] : {std::pair{low, middle}, {middle, high}}) {
          compare_work(worst, subject, trial, element, claim, from, to);
        }
        continue;
      }
      // It cannot depend on what it is not given.
      const auto given = compute(subject, trial.instance, inputs).at(claim.derivative);
      for (const double value : given) {
        worst.add(std::abs(value), 0, [&] {
          return claim.derivative + " is not 0, though " + claim.variable + " is not among its \"needs\"";
        });
      }
    }
  }
  if (decided.yes < decided.no && worst.passes()) {
    return Finding::warned("too rough for differences to tell at " + std::to_string(decided.no) + " of " +
                           std::to_string(decided.yes + decided.no) + " places");
  }
  return worst.finding("as the differences are");
}

Finding force_gradient(const Subject& subject) {
  const plugin::Manifest& manifest = subject.manifest();
  if (!manifest.claims.value("conservative", false)) return Finding::skipped("does not claim to be conservative");
  if (!manifest.gives_output("energy")) {
    return Finding::failed("claims to be conservative, but gives no energy that its forces could be derived from");
  }
  std::vector<DerivativeClaim> claims;
  for (const auto& c : coordinates_of(manifest)) claims.push_back({c.force, "energy", c.variable, c.sign});
  return compare(subject, claims);
}

Finding derivatives(const Subject& subject) {
  const std::vector<DerivativeClaim> all = {
      {"tension_by_stretch", "tension", "stretch", 1},           {"tension_by_rate", "tension", "stretch_rate", 1},
      {"moment_by_curvature", "moment", "curvature", 1},         {"stress_1_by_1", "stress_1", "invariant_1", 1},
      {"stress_1_by_2", "stress_1", "invariant_2", 1},           {"stress_2_by_2", "stress_2", "invariant_2", 1},
      {"area_tension_by_ratio", "area_tension", "area_ratio", 1}};
  std::vector<DerivativeClaim> given;
  for (const DerivativeClaim& claim : all) {
    if (subject.manifest().gives_output(claim.derivative)) given.push_back(claim);
  }
  if (given.empty()) return Finding::skipped("gives no derivatives");
  return compare(subject, given);
}

/// The tension of a triangle at rest, along any direction: 2 (stress_1 + stress_2).
Finding rest_of_triangles(const Subject& subject) {
  Random random = subject.random();
  for (const Trial& trial : trials(subject, random, subject.typical_setting(), 0)) {
    const Values forces = compute(subject, trial.instance, at_rest(subject, trial, 1, random));
    const auto stress = [&](const char* name) { return forces.contains(name) ? forces.at(name)[0] : 0; };
    const double one = stress("stress_1"), two = stress("stress_2");
    if (std::abs(one + two) <= 64 * epsilon * (std::abs(one) + std::abs(two))) continue;
    return Finding::warned("is under stress at rest: a tension of " +
                           in_si(subject, trial.setting, "energy", 2 * (one + two)) + trial.words);
  }
  return Finding::passed("no force at rest");
}

/// The largest force at rest beside that of elements a tenth away from it.
Finding rest_state(const Subject& subject) {
  if (subject.manifest().gives_output("stress_1") || subject.manifest().gives_output("stress_2")) {
    return rest_of_triangles(subject);
  }
  Random random = subject.random();
  std::string prestressed;
  for (const Trial& trial : trials(subject, random, subject.typical_setting(), 0)) {
    const Values rest = at_rest(subject, trial, 21, random);
    const Values forces = compute(subject, trial.instance, rest);
    for (const auto& c : coordinates_of(subject.manifest())) {
      if (c.force.starts_with("stress_")) continue;  // of a triangle their sum is the force
      Values away = rest;
      if (away.contains(c.variable)) {
        for (double& value : away[c.variable]) value += c.variable == "curvature" ? 0.1 : 0.1 * value;
      }
      const auto beside = compute(subject, trial.instance, away).at(c.force);
      for (std::size_t i = 0; i < 21; ++i) {
        const double force = forces.at(c.force)[i];
        // Forces at rest are differences of terms whose sizes are those of forces nearby.
        if (std::abs(force) <= 64 * epsilon * std::abs(beside[i])) continue;
        const std::string words = c.force + ' ' + in_si(subject, trial.setting, c.force, force) + " at " +
                                  place(subject, trial.setting, rest, i) + trial.words;
        if (trial.words.empty()) return Finding::warned("is under stress at rest: " + words);
        if (prestressed.empty()) prestressed = words;
      }
    }
  }
  return Finding::passed(prestressed.empty() ? "no force at rest"
                                             : "no force at rest with typical parameters; " + prestressed);
}

/// "; 3 x shear_modulus": a modulus over each parameter of its dimension.
std::string as_ratio(const Subject& subject, const Trial& trial, double si, const units::Dimension& dimension) {
  std::string words;
  for (std::size_t k = 0; k < trial.parameters.size(); ++k) {
    const plugin::Parameter& parameter = subject.manifest().parameters[k];
    if (!parameter.choices.empty() || parameter.dimension != dimension || trial.parameters[k] == 0) continue;
    if (dimension == units::Dimension{}) continue;
    words += " = " + number(si / trial.parameters[k], 7) + " x " + parameter.name;
  }
  return words;
}

struct Modulus {
  const char* force;
  const char* variable;
  const char* words;
  const char* declared;  ///< output that must be the same
  bool times_rest;       ///< per relative change of the variable
  double sign;
};

/// Slopes a ten-thousandth to both sides of rest, where a law may have a kink; their mean is that at rest to 1e-8.
Finding moduli(const Subject& subject) {
  const std::vector<Modulus> all = {
      {"tension", "stretch", "dT/dstretch", "tension_by_stretch", false, 1},
      {"tension", "stretch_rate", "dT/drate", "tension_by_rate", false, 1},
      {"moment", "curvature", "dmoment/dcurvature", "moment_by_curvature", false, 1},
      {"pressure", "area", "-A0 dp/dA", "", true, -1},
      {"perimeter_tension", "perimeter", "P0 dtension/dperimeter", "", true, 1},
      {"area_tension", "area_ratio", "dtension/dratio", "area_tension_by_ratio", false, 1},
      {"pressure", "volume", "-V0 dp/dV", "", true, -1},
      {"surface_tension", "surface_area", "A0 dtension/dA", "", true, 1}};
  const plugin::Manifest& manifest = subject.manifest();
  Random random = subject.random();
  Worst worst;
  Decided decided;
  std::string report;
  const auto all_trials = trials(subject, random, subject.typical_setting());
  for (const Trial& trial : all_trials) {
    const Values rest = at_rest(subject, trial, 8, random);
    for (const Modulus& modulus : all) {
      if (!manifest.gives_output(modulus.force) || !rest.contains(modulus.variable)) continue;
      double mean = 0;
      for (const double side : {-1e-4, 1e-4}) {
        Values near = rest;
        for (double& value : near[modulus.variable]) {
          const bool small = std::abs(value) < 0.05;  // a flat rest state, or a rate
          value += side * (small ? 0.05 : std::abs(value));
        }
        if (manifest.gives_output(modulus.declared)) {
          compare_derivative(worst, decided, subject, trial, near,
                             {modulus.declared, modulus.force, modulus.variable, 1});
        }
        const auto found = slopes(subject, trial, near, modulus.force, modulus.variable);
        for (std::size_t i = 0; i < found.size(); ++i) {
          const double slope = modulus.sign * found[i].value;
          if (i == 0) mean += slope * (modulus.times_rest ? rest.at(modulus.variable)[0] : 1) / 2;
          if (modulus.variable == std::string("stretch_rate")) continue;  // what the check of dissipation asks
          worst.add(std::max(0.0, -slope), found[i].error, [&] {
            return std::string("near rest the stiffness ") + modulus.words + " is negative, by, in lattice units," +
                   trial.words;
          });
        }
      }
      units::Dimension dimension = plugin::dimension_of(manifest, modulus.force);
      if (!modulus.times_rest) {
        for (std::size_t k = 0; k < 6; ++k) {
          dimension.exponent[k] -= plugin::dimension_of(manifest, modulus.variable).exponent[k];
        }
      }
      const double si = trial.setting.units.to_si(mean, dimension);
      // Of the draws at random the numbers would tell nobody anything.
      const bool is_choice = std::any_of(manifest.parameters.begin(), manifest.parameters.end(), [&](const auto& p) {
        return !p.choices.empty() && trial.words.starts_with(" with " + p.name + ' ');
      });
      if (&trial == &all_trials.front() || (is_choice && trial.words.find(',') == std::string::npos)) {
        report += (report.empty() ? "" : "; ") + std::string(modulus.words) + ' ' + number(si, 7) + " SI" +
                  as_ratio(subject, trial, si, dimension) + trial.words;
      }
    }
  }
  Finding finding = worst.finding("stiff");
  if (finding.verdict == Verdict::pass) finding = Finding::passed(report);
  return finding;
}

/// Elements crushed, torn and folded.
/// A law may outgrow the numbers where an element is torn or crushed, and the run then says that it diverged; but it
/// may not give what is no number, and not outgrow them where cells in a strong flow come to.
Finding degenerate(const Subject& subject) {
  Random random = subject.random();
  for (const Trial& trial : trials(subject, random, subject.typical_setting())) {
    std::vector<Values> extremes;
    constexpr std::size_t count = 91;  // 1e-6 to 1e3 in tenths of a decade
    const auto factor_of = [](std::size_t i) { return std::pow(10.0, -6 + 0.1 * static_cast<double>(i)); };
    const Values ordinary = subject.random_inputs(trial.instance, count, random);
    for (const auto& [name, values] : ordinary) {
      Values inputs = ordinary;
      auto& array = inputs[name];
      for (std::size_t i = 0; i < count; ++i) {
        const double factor = factor_of(i);
        if (name == "stretch" || name == "area_ratio") array[i] = factor;
        if (name == "stretch_rate" || name == "curvature") array[i] = std::copysign(factor, values[i]);
        if (name == "area" || name == "perimeter" || name == "volume" || name == "surface_area")
          array[i] = factor * values[i];
        if (name.starts_with("invariant")) {  // one stretch is the factor, the other one 1
          for (const char* invariant : {"invariant_1", "invariant_2"}) {
            if (inputs.contains(invariant)) inputs[invariant][i] = (factor - 1) * (factor + 1);
          }
        }
      }
      if (name == "area" || name == "curvature" || name == "stretch_rate") array[0] = 0;
      extremes.push_back(std::move(inputs));
    }
    for (const Values& inputs : extremes) {
      for (const auto& [name, values] : compute(subject, trial.instance, inputs)) {
        for (std::size_t i = 0; i < count; ++i) {
          const double factor = factor_of(i);
          const bool met_in_flow = factor > 0.25 && factor < 4;
          if (std::isfinite(values[i]) || (std::isinf(values[i]) && !met_in_flow)) continue;
          return Finding::failed(name + " is " + number(values[i]) + " at " + place(subject, trial.setting, inputs, i) +
                                 trial.words);
        }
      }
    }
  }
  return Finding::passed("a number for elements that are crushed, torn and folded, finite up to fourfold");
}

}  // namespace

std::vector<Check> membrane_checks() {
  constexpr auto kind = plugin::ModelKind::membrane;
  constexpr auto level = Level::physics;
  return {
      {"gradient", level, "gives forces that are derivatives of its energy", {"compute"}, force_gradient, kind},
      {"derivatives", level, "gives the right derivatives of its forces", {"compute", "gradient"}, derivatives, kind},
      {"rest-state", level, "exerts no force at rest", {"compute", "gradient"}, rest_state, kind},
      {"rigid-motion",
       level,
       "gives the same forces and energy in rigid motion",
       {"compute", "gradient"},
       check_rigid_motion,
       kind},
      {"moduli",
       level,
       "resists small changes at rest as its derivatives say",
       {"compute", "gradient", "derivatives", "dissipation"},
       moduli,
       kind},
      {"dissipation", level, "takes energy out of motion and never adds any", {"compute"}, check_dissipation, kind},
      {"closed-loop",
       level,
       "gives no energy over closed cycles; takes none if conservative",
       {"compute", "gradient", "dissipation", "look-after-step"},
       check_closed_loop,
       kind},
      {"degenerate", level, "gives no NaN for crushed, torn or folded elements", {"compute"}, degenerate, kind},
      {"state-restored",
       level,
       "continues from a copy of its state, bit for bit",
       {"compute"},
       check_state_restored,
       kind},
      {"clamped",
       level,
       "is the same in both dimensions where it keeps its width",
       {"gradient", "units"},
       check_clamped,
       kind},
  };
}

}  // namespace rouleau::conform
