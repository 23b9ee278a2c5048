// What a JSON Schema asks for, in words, and which branch of a oneOf a user meant, judged by the keys of the value.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "json.hpp"

namespace rouleau::json {

/// The rule itself, or what its "$ref" points to within `schema`.
const nlohmann::json& resolve(const nlohmann::json& schema, const nlohmann::json& rule);

/// Is the value of the type(s) the rule names, if any?
bool fits_type(const nlohmann::json& value, const nlohmann::json& rule);

/// `the text "6 Pa"`, `the number 3`, `an object`, ...
std::string kind_and_value(const nlohmann::json& value);

/// "a whole number", "an object with a, b", `"periodic"`, ...
std::string wanted_kind(const nlohmann::json& schema, const nlohmann::json& rule);

/// "at least 8 and at most 100000", "above 0.5", ...
std::string range_words(const nlohmann::json& rule);

/// `"f16" is not possible for precision; did you mean "f64"?` and the list of what is.
std::string not_among(const nlohmann::json& value, const std::string& name, const nlohmann::json& allowed);

std::vector<std::string> keys_of(const nlohmann::json& object);

/// Where in a document of this schema the keys stand: key -> pointers such as /cell_types/NAME/segments and
/// /stages/N/strain, in the schema's order.
std::map<std::string, std::vector<std::string>> places_of_keys(const nlohmann::json& schema);

/// Characters (code points) of UTF-8 text.
std::size_t character_count(const std::string& text);

struct Choice {
  /// `branches` are the alternatives as the schema has them; they and `schema` must outlive this.
  Choice(const nlohmann::json& schema, const nlohmann::json& branches, const nlohmann::json& value);

  std::vector<const nlohmann::json*> possible;  ///< branches of the value's type
  std::vector<const nlohmann::json*> meant;     ///< those that share the most keys with the value; one when it is clear
  bool only_words = true;                       ///< every possible branch is a fixed word
  std::vector<std::string> words;               ///< fixed words among the branches
  std::vector<std::string> all_keys;            ///< keys of any possible branch
  std::vector<std::string> other_keys;          ///< keys of branches that are not meant
  std::vector<std::string> deciding_keys;       ///< required in one branch, unknown in another
  std::string wanted;                           ///< all branches in words
};

}  // namespace rouleau::json
