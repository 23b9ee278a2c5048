// What a JSON Schema cannot say about a manifest: units, limits, and names that must fit each other.
#pragma once

#include <string>
#include <vector>

#include "json/document.hpp"
#include "manifest.hpp"

namespace rouleau::plugin {

// All of these expect a document that fits the schema, and throw Error(plugin_refused) with the place of the fault.

/// The parameters, with numbers in SI. Units must parse; names be unique; limits, usual range and default fit together.
std::vector<Parameter> read_parameters(const json::Document& document, const units::Units& units);

/// The state variables, with initial values in SI. Units must parse and have a size on the lattice; names be unique.
std::vector<StateVariable> read_state(const json::Document& document, const units::Units& units);

/// A role fits the manifest's kind and the parameter's unit, and is that of one parameter only.
void check_roles(const json::Document& document, const Manifest& manifest);

/// "dimensions" and "in_3d" fit each other and the kind.
void check_dimensions(const json::Document& document, const Manifest& manifest);

/// "needs" and "gives" hold names of the manifest's kind and dimension only, and what every model of this kind must
/// have; a membrane law keeps to one element; "checks" name parameters, inputs of "needs" and outputs of "gives". `at`:
/// the object of the manifest that holds the three.
void check_quantities(const json::Document& document, const Manifest& manifest, const std::string& at);

/// An object of the manifest ("inactive_when", "stands_for") names parameters and gives values that these can have.
void check_parameter_values(const json::Document& document, const Manifest& manifest, const char* key,
                            const nlohmann::json& values, const units::Units& units);

}  // namespace rouleau::plugin
