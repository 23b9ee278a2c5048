// Level "physics" for models of every kind: what the manifest says a parameter is, the model has by that number.
#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "differences.hpp"
#include "effects.hpp"
#include "membrane_work.hpp"
#include "trials.hpp"

namespace rouleau::conform {

namespace {

/// A role says what a number is, not its last digits: penalties and smoothed ends may change these.
constexpr double tolerance = 1e-3;

Call look() {
  Call call;
  call.time_step = 0;
  return call;
}

/// How a law answers to small changes of an element at rest, at once.
struct Response {
  const char* force;
  const char* variable;
  const char* derivative;  ///< output that says it, if the law gives it
};

/// In SI, of a law that has such an answer.
double stiffness(const Subject& subject, const Trial& trial, const Response& response, plugin::Role role) {
  Random random = subject.random();
  const Values rest = at_rest(subject, trial, 1, random);
  const double lattice = subject.manifest().gives_output(response.derivative)
                             ? compute(subject, trial.instance, rest, look()).at(response.derivative)[0]
                             : slopes(subject, trial, rest, response.force, response.variable)[0].value;
  return trial.setting.units.to_si(lattice, plugin::facts_of(role).dimension);
}

constexpr Response to_stretch{"tension", "stretch", "tension_by_stretch"};
constexpr Response to_rate{"tension", "stretch_rate", "tension_by_rate"};
constexpr Response to_curvature{"moment", "curvature", "moment_by_curvature"};

bool gives_stress(const plugin::Manifest& manifest) {
  return manifest.gives_output("stress_1") || manifest.gives_output("stress_2");
}

/// Of a triangle at rest, in SI. With the stretches 1 + e and 1/(1 + e), I1 = 4 e^2 and I2 = 0: the energy is half the
/// modulus times (2 e)^2.
double resistance_to_shear(const Subject& subject, const Trial& trial) {
  Random random = subject.random();
  const Values now = compute(subject, trial.instance, at_rest(subject, trial, 1, random), look());
  const double stress = now.contains("stress_1") ? now.at("stress_1")[0] : 0;
  return trial.setting.units.to_si(2 * stress, plugin::facts_of(plugin::Role::shear_modulus).dimension);
}

/// The surface viscosity of a triangle at rest, or of a segment, in SI.
double resistance_to_rate(const Subject& subject, const Trial& trial, plugin::Role role) {
  if (!subject.manifest().gives_output("shear_viscosity")) return stiffness(subject, trial, to_rate, role);
  Random random = subject.random();
  const Values now = compute(subject, trial.instance, at_rest(subject, trial, 1, random), look());
  return trial.setting.units.to_si(now.at("shear_viscosity")[0], plugin::facts_of(role).dimension);
}

/// An output at distances, lattice units.
std::vector<double> along(const Subject& subject, const Trial& trial, const char* output,
                          const std::vector<double>& distances) {
  Random random = subject.random();
  Values inputs = subject.random_inputs(trial.instance, distances.size(), random);
  if (inputs.contains("distance")) inputs["distance"] = distances;
  return compute(subject, trial.instance, inputs, look()).at(output);
}

/// Depth of the potential in SI, from its lowest energy; NaN where that lies at the cutoff, which ends the well early.
double depth(const Subject& subject, const Trial& trial, double cutoff) {
  constexpr int samples = 1001, last = samples - 1;
  double low = 1e-4 * cutoff, high = cutoff, least = 0;
  for (int round = 0; round < 4; ++round) {
    std::vector<double> distances(samples);
    for (int i = 0; i < samples; ++i) distances[i] = low * std::pow(high / low, static_cast<double>(i) / last);
    const auto energy = along(subject, trial, "energy", distances);
    const auto bottom = static_cast<int>(std::min_element(energy.begin(), energy.end()) - energy.begin());
    if (round == 0 && bottom == last) return std::nan("");
    least = energy[bottom];
    low = distances[std::max(bottom - 1, 0)];
    high = distances[std::min(bottom + 1, last)];
  }
  return trial.setting.units.to_si(-least, plugin::facts_of(plugin::Role::depth).dimension);
}

/// What the model has where the parameter, of this value in SI, says it: the value itself if the manifest is right. NaN
/// where nothing can be said of this trial.
double found(const Subject& subject, const Trial& trial, std::size_t parameter, plugin::Role role) {
  const double said = trial.parameters[parameter];
  const units::LatticeUnits& units = trial.setting.units;
  const auto cutoff = [&] { return trial.instance.interaction().cutoff(trial.instance.self()); };
  const auto doubled = [&] {
    auto parameters = trial.parameters;
    parameters[parameter] *= 2;
    return Trial{subject.make(parameters, trial.setting), parameters, trial.setting, trial.words};
  };
  switch (role) {
    case plugin::Role::stretching_modulus:
      return stiffness(subject, trial, to_stretch, role);
    case plugin::Role::membrane_viscosity:
      // What else resists the rate stays.
      return resistance_to_rate(subject, doubled(), role) - resistance_to_rate(subject, trial, role);
    case plugin::Role::bending_modulus:
      return stiffness(subject, trial, to_curvature, role);
    case plugin::Role::cutoff:
      return units.to_si(cutoff(), units::dimension::length);
    case plugin::Role::depth:
      return subject.manifest().gives_output("energy") ? depth(subject, trial, cutoff()) : std::nan("");
    case plugin::Role::zero_force_distance: {
      const double place = units.to_lattice(said, units::dimension::length);
      const auto force = along(subject, trial, "force", {(1 - tolerance) * place, (1 + tolerance) * place});
      return force[0] >= 0 && force[1] <= 0 ? said : 0;
    }
    case plugin::Role::shear_modulus: {
      if (said == 0) return std::nan("");
      if (gives_stress(subject.manifest())) {  // what else resists shear stays
        return resistance_to_shear(subject, doubled()) - resistance_to_shear(subject, trial);
      }
      // In a plane nothing shears a membrane, but what resists shear resists stretch, the more the more of it there is.
      const double more = stiffness(subject, doubled(), to_stretch, role);
      return more > (1 + tolerance) * stiffness(subject, trial, to_stretch, role) ? said : 0;
    }
    case plugin::Role::area_modulus:
      return std::nan("");  // how much of it a stretch along the plane meets is the law's affair
  }
  return std::nan("");
}

/// The answer that a role is about and the law does not have in this dimension; empty when it has.
std::string without(const plugin::Manifest& manifest, plugin::Role role) {
  if (role == plugin::Role::shear_modulus && gives_stress(manifest)) return {};
  const auto lacks = [&](const Response& response) {
    const bool has = manifest.gives_output(response.force) && manifest.needs_input(response.variable);
    return has ? std::string() : std::string(response.force) + " that depends on " + response.variable;
  };
  switch (role) {
    case plugin::Role::shear_modulus:
    case plugin::Role::stretching_modulus:
      return lacks(to_stretch);
    case plugin::Role::membrane_viscosity:
      return manifest.gives_output("shear_viscosity") ? std::string() : lacks(to_rate);
    case plugin::Role::bending_modulus:
      return lacks(to_curvature);
    default:
      return {};
  }
}

Finding roles(const Subject& subject) {
  const auto& parameters = subject.manifest().parameters;
  const std::optional<Subject> other = subject.in_other_dimension();
  Random random = subject.random();
  const auto all = trials(subject, random, subject.typical_setting());
  Worst worst;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (!parameters[k].role) continue;
    const plugin::RoleFacts& role = plugin::facts_of(*parameters[k].role);
    const std::string words = parameters[k].name + " has the role " + role.name;
    if (const auto lacking = without(subject.manifest(), role.role); !lacking.empty()) {
      if (other && without(other->manifest(), role.role).empty()) continue;
      return Finding::failed(words + ", but the law gives no " + lacking);
    }
    for (const Trial& trial : all) {
      double measured = std::nan("");
      try {
        measured = found(subject, trial, k, role.role);
      } catch (const plugin::ModelRefused&) {  // twice as much is more than it takes
      }
      if (std::isnan(measured)) continue;
      const double said = trial.parameters[k];
      worst.add(std::abs(measured - said), tolerance * std::abs(said), [&] {
        const bool is_place = role.role == plugin::Role::zero_force_distance;
        const bool is_shear = role.role == plugin::Role::shear_modulus && !gives_stress(subject.manifest());
        const std::string value = number(said, 7) + ' ' + role.unit;
        return words + ", " + value + ", but " +
               (is_place   ? "the force does not turn from repulsion to attraction there"
                : is_shear ? "twice as much does not make the law stiffer at rest"
                           : "the model's is " + number(measured, 7) + ' ' + role.unit) +
               trial.words + "; off, in SI units, by";
      });
    }
  }
  if (worst.count() == 0) return Finding::skipped("its manifest gives no parameter a role that can be measured");
  return worst.passes() ? Finding::passed("parameters are what their roles say") : worst.finding({});
}

}  // namespace

bool is_measured(const plugin::Manifest& manifest, plugin::Role role) {
  // How stiff they make a stretch is the law's affair.
  return role != plugin::Role::area_modulus && role != plugin::Role::shear_modulus && without(manifest, role).empty();
}

std::vector<Check> role_checks() {
  return {{"roles",
           Level::physics,
           "has parameters that mean what their roles say",
           {"compute", "gradient", "derivative", "derivatives", "cutoff", "units"},
           roles}};
}

}  // namespace rouleau::conform
