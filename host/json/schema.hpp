// Judges a document by a JSON Schema (draft 7), with errors a user can act on.
#pragma once

#include "base/error.hpp"
#include "document.hpp"
#include "json.hpp"

namespace rouleau::json {

/// Adds all faults, each naming place, value found, what is allowed and, for an unknown key or word, the one that was
/// most likely meant. Of a value that is wrong altogether no part is judged, and a key is not missing that another one
/// was most likely meant to be. Only keywords that the shipped schemas use are judged, to which tests/schemas holds
/// them.
void judge(const Document& document, const nlohmann::json& schema, Faults& faults, Cause cause = Cause::bad_input);

/// Throws those faults, in the order of the text.
void validate(const Document& document, const nlohmann::json& schema, Cause cause = Cause::bad_input);

}  // namespace rouleau::json
