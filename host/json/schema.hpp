// Validation of a document against a shipped JSON Schema, with errors a user can act on.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "document.hpp"

namespace rouleau::json {

/// Validates; throws Error(cause) for the first fault in the order of the text, naming place, value found, what is
/// allowed and, for an unknown key or word, the nearest valid one.
void validate(const Document& document, const nlohmann::json& schema, Cause cause = Cause::bad_input);

/// The shipped schemas, compiled into the program and installed beside it.
const nlohmann::json& scene_schema();
const nlohmann::json& manifest_schema();
const nlohmann::json& lock_schema();

}  // namespace rouleau::json
