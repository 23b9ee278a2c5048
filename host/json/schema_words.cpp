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

bool has(const Json& rule, const char* part, const std::string& key) {
  if (!rule.contains(part)) return false;
  const auto& list = rule[part];
  return list.is_array() ? std::find(list.begin(), list.end(), key) != list.end() : list.contains(key);
}

/// Keys in common, those that the branch requires counting more; a key that is nearly one of the branch's counts a
/// little.
int likeness(const Json& rule, const Json& value) {
  if (!value.is_object() || !rule.contains("properties")) return 0;
  int score = 0;
  for (const auto& [key, member] : value.items())
    if (has(rule, "properties", key)) score += has(rule, "required", key) ? 4 : 2;
  return score;
}

/// The value has another word where the branch has a fixed one: {"kind": "gap"} is not meant by a branch of "speed".
bool has_other_word(const Json& rule, const Json& value) {
  if (!value.is_object() || !rule.contains("properties")) return false;
  const auto& members = rule["properties"].items();
  return std::any_of(members.begin(), members.end(), [&](const auto& member) {
    return member.value().contains("const") && value.contains(member.key()) &&
           value[member.key()] != member.value()["const"];
  });
}

void add_once(std::vector<std::string>& list, const std::string& word) {
  if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
}

}  // namespace

const Json& resolve(const Json& schema, const Json& rule) {
  const Json* at = &rule;
  for (int steps = 0; steps < 16 && at->is_object() && at->contains("$ref"); ++steps)
    at = &schema.at(Json::json_pointer((*at)["$ref"].get<std::string>().substr(1)));
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

Choice::Choice(const Json& schema, const Json& branches, const Json& value) {
  int best = 0;
  std::vector<int> scores;
  for (const auto& branch : branches) {
    const auto& rule = resolve(schema, branch);
    const auto words_of_branch = rule.contains("enum")    ? rule["enum"]
                                 : rule.contains("const") ? Json::array({rule["const"]})
                                                          : Json::array();
    for (const auto& word : words_of_branch)
      if (word.is_string()) words.push_back(word.get<std::string>());
    wanted += (wanted.empty() ? "" : ", or ") + wanted_kind(schema, rule);
    const bool of_type = words_of_branch.empty()
                             ? fits_type(value, rule)
                             : std::any_of(words_of_branch.begin(), words_of_branch.end(),
                                           [&](const Json& word) { return word.type() == value.type(); });
    if (!of_type) continue;
    if (has_other_word(rule, value)) {
      for (const auto& key : keys_of(rule["properties"])) add_once(other_keys, key);
      continue;
    }
    possible.push_back(&rule);
    only_words = only_words && !words_of_branch.empty();
    scores.push_back(likeness(rule, value));
    best = std::max(best, scores.back());
  }
  for (std::size_t i = 0; i < possible.size(); ++i) {
    if (scores[i] == best) meant.push_back(possible[i]);
    if (!possible[i]->contains("properties")) continue;
    for (const auto& key : keys_of((*possible[i])["properties"])) {
      add_once(all_keys, key);
      if (scores[i] != best) add_once(other_keys, key);
    }
    for (const auto* other : possible) {
      for (const auto& key : possible[i]->value("required", std::vector<std::string>{}))
        if (other != possible[i] && !has(*other, "properties", key)) add_once(deciding_keys, key);
    }
  }
}

}  // namespace rouleau::json
