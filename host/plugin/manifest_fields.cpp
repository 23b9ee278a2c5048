#include "manifest_fields.hpp"

#include <algorithm>
#include <set>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "json/shown.hpp"
#include "parameters.hpp"
#include "quantities.hpp"

namespace rouleau::plugin {

namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const json::Document& document, const std::string& pointer, const std::string& problem) {
  throw Error(Cause::plugin_refused, document.place(pointer), problem);
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Parameter read_choice(const json::Document& document, const std::string& at, const Json& entry) {
  Parameter parameter;
  parameter.choices = entry["choices"].get<std::vector<std::string>>();
  for (const char* key : {"unit", "minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum", "usual"})
    if (entry.contains(key))
      refuse(document, at + '/' + key, std::string("a parameter with \"choices\" has no \"") + key + '"');
  if (!entry.contains("default")) return parameter;
  const Json& word = entry["default"];
  const auto chosen = word.is_string()
                          ? std::find(parameter.choices.begin(), parameter.choices.end(), word.get<std::string>())
                          : parameter.choices.end();
  if (chosen == parameter.choices.end()) {
    refuse(document, at + "/default",
           "the default is " + json::shown(word) + "; it must be one of: " + listed(parameter.choices));
  }
  parameter.default_value = static_cast<double>(chosen - parameter.choices.begin());
  return parameter;
}

/// The limits must leave room for at least one value.
void check_limits(const json::Document& document, const std::string& at, const Parameter& parameter) {
  const auto check = [&](const std::optional<double>& low, const std::optional<double>& high, bool open,
                         const char* low_name, const char* high_name) {
    if (low && high && (*low > *high || (open && *low == *high)))
      refuse(document, at + '/' + high_name,
             std::string("no value can satisfy both \"") + low_name + "\" and \"" + high_name + '"');
  };
  check(parameter.minimum, parameter.maximum, false, "minimum", "maximum");
  check(parameter.minimum, parameter.exclusive_maximum, true, "minimum", "exclusiveMaximum");
  check(parameter.exclusive_minimum, parameter.maximum, true, "exclusiveMinimum", "maximum");
  check(parameter.exclusive_minimum, parameter.exclusive_maximum, true, "exclusiveMinimum", "exclusiveMaximum");
}

void check_usual(const json::Document& document, const std::string& at, const Parameter& parameter) {
  if (!parameter.usual) return;
  const auto [low, high] = *parameter.usual;
  if (low > high) refuse(document, at + "/usual", "the usual range must begin with its smaller value");
  // The ends of the range may touch an exclusive limit: the range then holds values as close to it as one likes.
  const auto outside = [&](double value) {
    return (parameter.minimum && value < *parameter.minimum) || (parameter.maximum && value > *parameter.maximum) ||
           (parameter.exclusive_minimum && value < *parameter.exclusive_minimum) ||
           (parameter.exclusive_maximum && value > *parameter.exclusive_maximum);
  };
  if (outside(low) || outside(high))
    refuse(document, at + "/usual", "the usual range must lie within the limits of the parameter");
}

Parameter read_number(const json::Document& document, const std::string& at, const Json& entry,
                      const units::Units& units) {
  Parameter parameter;
  if (!entry.contains("unit")) {
    refuse(document, at,
           "\"unit\" is missing (\"1\" for a plain number), or \"choices\" for a parameter that is a word");
  }
  parameter.unit = entry["unit"];
  double scale = 1;
  try {
    parameter.dimension = units.dimension(parameter.unit);
    scale = units.scale(parameter.unit);
  } catch (const units::UnitError& error) {
    refuse(document, at + "/unit", error.what());
  }
  const auto number = [&](const char* key, std::optional<double>& value) {
    if (entry.contains(key)) value = entry[key].get<double>() * scale;
  };
  number("minimum", parameter.minimum);
  number("exclusiveMinimum", parameter.exclusive_minimum);
  number("maximum", parameter.maximum);
  number("exclusiveMaximum", parameter.exclusive_maximum);
  if (entry.contains("usual"))
    parameter.usual = {entry["usual"][0].get<double>() * scale, entry["usual"][1].get<double>() * scale};
  check_limits(document, at, parameter);
  check_usual(document, at, parameter);
  if (entry.contains("default")) {
    if (!entry["default"].is_number()) {
      refuse(document, at + "/default",
             "the default is " + json::shown(entry["default"]) + "; it must be a plain number, in " +
                 (parameter.unit == "1" ? "no unit" : parameter.unit));
    }
    number("default", parameter.default_value);
    const std::string wanted = violated_limit(*parameter.default_value, parameter, units);
    if (!wanted.empty())
      refuse(document, at + "/default", "the default is " + json::shown(entry["default"]) + "; it must be " + wanted);
  }
  return parameter;
}

/// What plugin.h has for surfaces of triangles, and no host does.
const std::vector<std::string> of_later_hosts = {"invariant_1_rate", "invariant_2_rate"};

void check_names(const json::Document& document, const std::string& at, const char* list,
                 const std::vector<std::string>& names, const std::vector<std::string>& known,
                 const Manifest& manifest) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (holds(known, names[i])) continue;
    if (manifest.dimension() == 3 && holds(of_later_hosts, names[i])) {
      refuse(document, at + '/' + list + '/' + std::to_string(i),
             in_quotes(names[i]) +
                 " is in the interface, but membranes in three dimensions do not have it yet; leave it out");
    }
    refuse(document, at + '/' + list + '/' + std::to_string(i),
           std::string("\"") + list + "\" of a " + to_string(manifest.kind) + " model" +
               (manifest.dimension() == 3 ? " in three dimensions" : "") + " cannot hold " + in_quotes(names[i]) +
               did_you_mean(names[i], known) + "\n  known: " + listed(known));
  }
}

/// Inputs and outputs of a membrane law are arrays over one sort of element, so they must agree on it.
void check_element(const json::Document& document, const Manifest& manifest, const std::string& at) {
  const bool surface = manifest.dimension() == 3;
  std::optional<MembraneElement> element;
  for (const char* name : {"tension", "stress_1", "stress_2", "shear_viscosity", "area_viscosity", "moment",
                           "area_tension", "pressure", "perimeter_tension", "surface_tension"})
    if (manifest.gives_output(name)) element = element_of(name);
  if (!element) {
    refuse(document, at + "/gives",
           surface
               ? "a membrane law in three dimensions must give \"stress_1\" and \"stress_2\", \"shear_viscosity\" or "
                 "\"area_viscosity\", \"moment\", \"area_tension\", or \"pressure\" and \"surface_tension\""
               : "a membrane law must give \"tension\", \"moment\", or \"pressure\" and \"perimeter_tension\"");
  }
  const auto check = [&](const char* list, const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto own = element_of(names[i]);
      if (!own || own == element) continue;
      refuse(document, at + '/' + list + '/' + std::to_string(i),
             "\"" + names[i] + "\" belongs to a " + to_string(*own) + ", but this law is one of a " +
                 to_string(*element) + "; split it into two models");
    }
  };
  check("gives", manifest.gives);
  check("needs", manifest.needs);
}

void check_reference_numbers(const json::Document& document, const Manifest& manifest, const std::string& place) {
  std::vector<std::string> parameters;
  for (const Parameter& parameter : manifest.parameters) parameters.push_back(parameter.name);
  const auto check = [&](const std::string& at, const Json& entry, const char* key,
                         const std::vector<std::string>& known, const char* what) {
    const Json members = entry.value(key, Json::object());
    for (const auto& [name, value] : members.items()) {
      if (name.starts_with("x-") || holds(known, name)) continue;
      throw Error(Cause::plugin_refused, document.key_place(json::child_pointer(at + '/' + key, name)),
                  in_quotes(name) + " is not among this model's " + what + did_you_mean(name, known) + "\n  " + what +
                      ": " + listed(known));
    }
  };
  std::vector<std::string> inputs = manifest.needs, outputs = manifest.gives;
  for (const StateVariable& variable : manifest.state) {
    inputs.push_back(variable.name);
    outputs.push_back(variable.name);
  }
  for (std::size_t i = 0; i < manifest.checks.size(); ++i) {
    const std::string at = place + "/checks/" + std::to_string(i);
    check(at, manifest.checks[i], "parameters", parameters, "parameters");
    check(at, manifest.checks[i], "inputs", inputs, manifest.state.empty() ? "\"needs\"" : "\"needs\" and \"state\"");
    check(at, manifest.checks[i], "outputs", outputs, manifest.state.empty() ? "\"gives\"" : "\"gives\" and \"state\"");
  }
}

}  // namespace

std::vector<Parameter> read_parameters(const json::Document& document, const units::Units& units) {
  std::vector<Parameter> parameters;
  std::set<std::string> seen;
  const Json list = document.root().value("parameters", Json::array());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string at = "/parameters/" + std::to_string(i);
    Parameter parameter =
        list[i].contains("choices") ? read_choice(document, at, list[i]) : read_number(document, at, list[i], units);
    parameter.name = list[i]["name"];
    parameter.role = role_named(list[i].value("role", std::string()));
    parameter.doc = list[i].value("doc", std::string());
    if (!seen.insert(parameter.name).second)
      refuse(document, at + "/name", "two parameters are called \"" + parameter.name + '"');
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

std::vector<StateVariable> read_state(const json::Document& document, const units::Units& units) {
  std::vector<StateVariable> variables;
  std::set<std::string> seen;
  const Json list = document.root().value("state", Json::array());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string at = "/state/" + std::to_string(i);
    StateVariable variable;
    variable.name = list[i]["name"];
    variable.unit = list[i]["unit"];
    if (!seen.insert(variable.name).second)
      refuse(document, at + "/name", "two state variables are called \"" + variable.name + '"');
    try {
      variable.dimension = units.dimension(variable.unit);
      variable.initial = list[i].value("initial", 0.0) * units.scale(variable.unit);
    } catch (const units::UnitError& error) {
      refuse(document, at + "/unit", error.what());
    }
    const auto& exponent = variable.dimension.exponent;
    if (exponent[3] != 0 || exponent[4] != 0 || exponent[5] != 0) {
      refuse(document, at + "/unit",
             "a state variable is kept in lattice units, which " + in_quotes(variable.unit) +
                 " has none of: kelvin, mole and ampere cannot stand in it");
    }
    variables.push_back(std::move(variable));
  }
  return variables;
}

void check_roles(const json::Document& document, const Manifest& manifest) {
  std::set<Role> seen;
  for (std::size_t i = 0; i < manifest.parameters.size(); ++i) {
    const Parameter& parameter = manifest.parameters[i];
    if (!parameter.role) continue;
    const RoleFacts& role = facts_of(*parameter.role);
    const std::string at = "/parameters/" + std::to_string(i) + "/role", name = in_quotes(role.name);
    if (role.kind != manifest.kind) {
      refuse(document, at,
             name + " is a role in a " + to_string(role.kind) + " model, and this is a " + to_string(manifest.kind) +
                 " model; leave \"role\" out");
    }
    if (!parameter.choices.empty() || parameter.dimension != role.dimension) {
      refuse(document, at,
             in_quotes(parameter.name) + (parameter.choices.empty() ? " in " + parameter.unit : ", a choice,") +
                 " cannot be the model's " + role.name + ", which is in " + role.unit +
                 "; give it such a unit, or leave \"role\" out");
    }
    if (!seen.insert(*parameter.role).second)
      refuse(document, at, "two parameters have the role " + name + "; leave it to the one that the model has it by");
  }
}

void check_dimensions(const json::Document& document, const Manifest& manifest) {
  if (manifest.kind != ModelKind::collision && document.root().contains("lattices")) {
    refuse(document, "/lattices",
           std::string("a ") + to_string(manifest.kind) +
               " model does not know the lattice; leave \"lattices\" to collision operators");
  }
  if (manifest.kind == ModelKind::collision && document.root().contains("dimensions"))
    refuse(document, "/dimensions", "a collision operator names its lattices; leave \"dimensions\" to other models");
  if (manifest.kind == ModelKind::membrane && manifest.works_in(3) && !manifest.state.empty()) {
    refuse(document, "/state/0",
           "a membrane law in three dimensions cannot remember " + in_quotes(manifest.state[0].name) +
               " yet; leave \"state\" out, or give \"dimensions\": [2]");
  }
  const bool both = manifest.works_in(2) && manifest.works_in(3), membrane = manifest.kind == ModelKind::membrane;
  if (manifest.in_3d && !(membrane && both)) {
    refuse(document, "/in_3d",
           membrane
               ? "\"in_3d\" is for laws of both dimensions; " +
                     std::string(manifest.works_in(3) ? "with \"dimensions\": [3] \"needs\", \"gives\" and "
                                                        "\"checks\" themselves say it"
                                                      : "give \"dimensions\": [2, 3]")
               : std::string("only membrane laws have elements of another kind in three dimensions; leave it out"));
  }
  if (membrane && both && !manifest.in_3d) {
    refuse(document, "/dimensions",
           "a membrane law of both dimensions says in \"in_3d\" what it needs and gives there");
  }
  if (manifest.kind == ModelKind::interaction && manifest.works_in(3) && manifest.needs_input("tangential_velocity")) {
    refuse(document, "/dimensions",
           "in three dimensions there is no \"tangential_velocity\", which this model needs; take \"sliding_speed\"");
  }
}

void check_quantities(const json::Document& document, const Manifest& manifest, const std::string& at) {
  check_names(document, at, "needs", manifest.needs, inputs_of(manifest.kind, manifest.dimension()), manifest);
  check_names(document, at, "gives", manifest.gives, outputs_of(manifest.kind, manifest.dimension()), manifest);
  check_reference_numbers(document, manifest, at);
  const bool collides = manifest.kind == ModelKind::collision;
  if (collides && !manifest.needs_input("populations"))
    refuse(document, "/needs", "a collision model needs \"populations\"");
  if (collides && !manifest.gives_output("populations"))
    refuse(document, "/gives", "a collision model gives \"populations\"");
  if (manifest.kind == ModelKind::membrane) check_element(document, manifest, at);
  if (manifest.kind == ModelKind::interaction && !manifest.gives_output("force"))
    refuse(document, "/gives", "an interaction model must give \"force\"");
}

void check_parameter_values(const json::Document& document, const Manifest& manifest, const char* key,
                            const Json& values, const units::Units& units) {
  if (!values.is_object()) return;
  std::vector<std::string> names;
  for (const Parameter& parameter : manifest.parameters) names.push_back(parameter.name);
  for (const auto& [name, value] : values.items()) {
    const std::string at = json::child_pointer(std::string("/") + key, name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw Error(Cause::plugin_refused, document.key_place(at),
                  in_quotes(name) + " is no parameter of this model" + did_you_mean(name, names) +
                      "\n  its parameters: " + listed(names));
    }
    const Parameter& parameter = manifest.parameters[found - names.begin()];
    if (!parameter.choices.empty()) {
      if (!value.is_string() || !holds(parameter.choices, value.get<std::string>()))
        refuse(document, at, json::shown(value) + " is none of the choices: " + listed(parameter.choices));
      continue;
    }
    if (!value.is_number())
      refuse(document, at, json::shown(value) + " must be a plain number, in the unit of " + name);
    const std::string wanted = violated_limit(value.get<double>() * units.scale(parameter.unit), parameter, units);
    if (!wanted.empty()) refuse(document, at, name + " can never be " + json::shown(value) + ": it must be " + wanted);
  }
}

}  // namespace rouleau::plugin
