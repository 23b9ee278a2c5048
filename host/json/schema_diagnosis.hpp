// Words the first fault of a document that does not fit its schema, from schema and value.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "document.hpp"

namespace rouleau::json {

struct SchemaFault {
  std::string pointer;
  bool at_key;  ///< the key is at fault rather than its value
  std::string problem;
};

/// The first fault in the text's order; a missing key counts as standing at the end of its object, so that a misspelt
/// one is met before. Nothing when no keyword known here is violated.
std::optional<SchemaFault> explain_first_fault(const Document& document, const nlohmann::json& schema);

}  // namespace rouleau::json
