// Judges a document by a JSON Schema (draft 7), with errors a user can act on.
#pragma once

#include <nlohmann/json.hpp>

#include "document.hpp"

namespace rouleau::json {

/// Throws Error(code) for the first fault in the order of the text, naming place, value found, what is allowed and, for
/// an unknown key or word, the nearest valid one. A missing key counts as standing at the end of its object, so that a
/// misspelt one is met before. Only keywords that the shipped schemas use are judged, to which tests/schemas holds them.
void validate(const Document& document, const nlohmann::json& schema, Cause cause = Cause::bad_input);

}  // namespace rouleau::json
