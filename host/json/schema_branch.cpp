#include "schema_branch.hpp"

#include <algorithm>

#include "schema_words.hpp"

namespace rouleau::json {

using Json = nlohmann::json;

namespace {

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
  for (const auto& [key, member] : value.items()) {
    if (has(rule, "properties", key)) score += has(rule, "required", key) ? 4 : 2;
  }
  return score;
}

void add_once(std::vector<std::string>& list, const std::string& word) {
  if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
}

}  // namespace

Choice::Choice(const Json& schema, const Json& branches, const Json& value) {
  int best = 0;
  std::vector<int> scores;
  for (const auto& branch : branches) {
    const auto& rule = resolve(schema, branch);
    const auto words_of_branch = rule.contains("enum")    ? rule["enum"]
                                 : rule.contains("const") ? Json::array({rule["const"]})
                                                          : Json::array();
    for (const auto& word : words_of_branch) {
      if (word.is_string()) words.push_back(word.get<std::string>());
    }
    wanted += (wanted.empty() ? "" : ", or ") + wanted_kind(schema, rule);
    const bool of_type = words_of_branch.empty()
                             ? fits_type(value, rule)
                             : std::any_of(words_of_branch.begin(), words_of_branch.end(),
                                           [&](const Json& word) { return word.type() == value.type(); });
    if (!of_type) continue;
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
      for (const auto& key : possible[i]->value("required", std::vector<std::string>{})) {
        if (other != possible[i] && !has(*other, "properties", key)) add_once(deciding_keys, key);
      }
    }
  }
}

}  // namespace rouleau::json
