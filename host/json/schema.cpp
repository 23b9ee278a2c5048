#include "schema.hpp"

// valijson ends the program instead of throwing unless told otherwise.
#define VALIJSON_USE_EXCEPTIONS 1
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "base/text.hpp"
#include "embedded_schemas.hpp"
#include "json_pointer.hpp"
#include "schema_diagnosis.hpp"

namespace rouleau::json {
namespace {

using Adapter = valijson::adapters::NlohmannJsonAdapter;

/// The pointer that valijson means by {"<root>", "[stages]", "[0]"}.
std::string pointer_of(const std::vector<std::string>& context) {
  std::string pointer;
  for (std::size_t i = 1; i < context.size(); ++i) {
    const auto& token = context[i];
    const bool bracketed = token.size() > 2 && token.front() == '[' && token.back() == ']';
    pointer = child_pointer(pointer, bracketed ? token.substr(1, token.size() - 2) : token);
  }
  return pointer;
}

}  // namespace

void validate(const Document& document, const nlohmann::json& schema, Cause cause) {
  // First our own words, which also keep texts away from valijson that its patterns could not stand; then its
  // judgement.
  if (const auto fault = explain_first_fault(document, schema)) {
    throw Error(cause, fault->at_key ? document.key_place(fault->pointer) : document.place(fault->pointer),
                indented(fault->problem));
  }
  valijson::Schema rules;
  valijson::SchemaParser().populateSchema(Adapter(schema), rules);
  const Adapter target(document.root());
  thread_local valijson::Validator validator;  // keeps the patterns that it has compiled
  if (validator.validate(rules, target, nullptr)) return;

  // A keyword that the explanation does not know: valijson's own words are better than none.
  valijson::ValidationResults results;
  validator.validate(rules, target, &results);
  valijson::ValidationResults::Error deepest;
  for (const auto& error : results) {
    if (deepest.description.empty() || error.context.size() > deepest.context.size()) deepest = error;
  }
  throw Error(cause, document.place(pointer_of(deepest.context)),
              "this does not fit the schema: " + deepest.description);
}

const nlohmann::json& scene_schema() {
  static const auto schema = nlohmann::json::parse(scene_schema_text);
  return schema;
}

const nlohmann::json& manifest_schema() {
  static const auto schema = nlohmann::json::parse(manifest_schema_text);
  return schema;
}

const nlohmann::json& lock_schema() {
  static const auto schema = nlohmann::json::parse(lock_schema_text);
  return schema;
}

}  // namespace rouleau::json
