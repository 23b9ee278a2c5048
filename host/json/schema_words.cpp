#include "schema_words.hpp"

#include <algorithm>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "shown.hpp"

namespace rouleau::json {

using Json = nlohmann::json;

namespace {

std::vector<std::string> types_of(const Json& rule) {
  if (!rule.is_object() || !rule.contains("type")) return {};
  if (rule["type"].is_string()) return {rule["type"].get<std::string>()};
  return rule["type"].get<std::vector<std::string>>();
}

bool is_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  if (type == "boolean") return value.is_boolean();
  return type == "null" && value.is_null();
}

std::string type_words(const Json& rule, const std::string& type) {
  if (type == "object") {
    const auto keys = rule.contains("properties") ? keys_of(rule["properties"]) : std::vector<std::string>{};
    return keys.empty() ? "an object"
                        : (keys.size() == 1 ? "an object with the key " : "an object with the keys ") + listed(keys);
  }
  if (type == "array") {
    const auto least = rule.value("minItems", std::size_t{0});
    if (least > 0 && rule.value("maxItems", std::size_t{0}) == least) return "a list of " + std::to_string(least);
    return "a list";
  }
  if (type == "string") return "text in double quotes";
  if (type == "integer") return "a whole number";
  if (type == "number") return "a number";
  if (type == "boolean") return "true or false";
  return type;
}

void add_places(std::map<std::string, std::vector<std::string>>& places, const Json& schema, const Json& unresolved,
                const std::string& pointer, int depth) {
  constexpr int deepest = 16;  // a rule may hold itself
  const Json& rule = resolve(schema, unresolved);
  if (!rule.is_object() || depth > deepest) return;
  if (rule.contains("properties")) {
    for (const auto& [key, member] : rule["properties"].items()) {
      auto& known = places[key];
      const std::string place = pointer + "/" + key;
      if (std::find(known.begin(), known.end(), place) == known.end()) known.push_back(place);
      add_places(places, schema, member, place, depth + 1);
    }
  }
  if (rule.contains("items")) add_places(places, schema, rule["items"], pointer + "/N", depth + 1);
  if (rule.contains("additionalProperties"))
    add_places(places, schema, rule["additionalProperties"], pointer + "/NAME", depth + 1);
  if (!rule.contains("oneOf")) return;
  for (const auto& branch : rule["oneOf"]) add_places(places, schema, branch, pointer, depth + 1);
}

}  // namespace

const Json& resolve(const Json& schema, const Json& rule) {
  const Json* at = &rule;
  for (int steps = 0; steps < 16 && at->is_object() && at->contains("$ref"); ++steps) {
    at = &schema.at(Json::json_pointer((*at)["$ref"].get<std::string>().substr(1)));
  }
  return *at;
}

bool fits_type(const Json& value, const Json& rule) {
  const auto types = types_of(rule);
  return types.empty() ||
         std::any_of(types.begin(), types.end(), [&](const auto& type) { return is_type(value, type); });
}

std::string kind_and_value(const Json& value) {
  if (value.is_string()) return "the text " + shown(value);
  if (value.is_number()) return "the number " + shown(value);
  if (value.is_object()) return value.empty() ? "an empty object" : "an object";
  if (value.is_array()) return value.empty() ? "an empty list" : "a list";
  return shown(value);
}

std::string wanted_kind(const Json& schema, const Json& unresolved) {
  const auto& rule = resolve(schema, unresolved);
  if (!rule.is_object()) return "nothing";
  if (rule.contains("const")) return shown(rule["const"]);
  std::vector<std::string> words;
  if (rule.contains("enum")) {
    for (const auto& word : rule["enum"]) words.push_back(shown(word));
  } else {
    const auto types = types_of(rule);
    if (types == std::vector<std::string>{"string", "number"})
      return "a quantity such as \"1.5 um\", or a plain number in SI units";
    for (const auto& type : types) words.push_back(type_words(rule, type));
  }
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " or ") + word;
  return text.empty() ? "something else" : text;
}

std::string range_words(const Json& rule) {
  std::string text;
  const auto add = [&](const char* key, const char* words) {
    if (rule.contains(key))
      text += (text.empty() ? "" : " and ") + std::string(words) + number(rule[key].get<double>(), 12);
  };
  add("minimum", "at least ");
  add("exclusiveMinimum", "above ");
  add("maximum", "at most ");
  add("exclusiveMaximum", "below ");
  return text;
}

std::string not_among(const Json& value, const std::string& name, const Json& allowed) {
  std::vector<std::string> words;
  std::vector<std::string> all;
  for (const auto& word : allowed) {
    if (word.is_string()) words.push_back(word.get<std::string>());
    all.push_back(shown(word));
  }
  const auto near = value.is_string() && all.size() > 1 ? did_you_mean(value.get_ref<const std::string&>(), words) : "";
  return "found " + kind_and_value(value) + near + "\n" + name + " can be: " + listed(all);
}

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

std::map<std::string, std::vector<std::string>> places_of_keys(const Json& schema) {
  std::map<std::string, std::vector<std::string>> places;
  add_places(places, schema, schema, "", 0);
  return places;
}

std::size_t character_count(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace rouleau::json
