// Validation of a document against a shipped JSON Schema, with errors a user can act on.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "document.hpp"

namespace rouleau::host {

/// Validates; throws Error(code) for the first fault in the order of the text, naming place, value found, what is
/// allowed and, for an unknown key or word, the nearest valid one.
void validate(const Document& document, const nlohmann::json& schema, ExitCode code = ExitCode::bad_input);

/// The candidate that `word` was most likely meant to be, or empty when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// The shipped schemas, compiled into the program and installed beside it.
const nlohmann::json& scene_schema();
const nlohmann::json& manifest_schema();
const nlohmann::json& lock_schema();

}  // namespace rouleau::host
