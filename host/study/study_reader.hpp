// Reads single values of a study with their types checked: what a schema of many kinds cannot say in good words.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "json/schema.hpp"
#include "json/shown.hpp"
#include "scene/scene_reader.hpp"

namespace rouleau::study {

/// Values at JSON pointers of a study. Every member throws Error(bad_input) at the place of a value of another type.
class StudyReader {
 public:
  explicit StudyReader(const scene::SceneFields& fields) : fields_(fields) {}

  [[nodiscard]] const scene::SceneFields& scene_fields() const { return fields_; }
  [[nodiscard]] bool has(const std::string& pointer) const { return fields_.has(pointer); }
  [[nodiscard]] bool is_text(const std::string& pointer) const { return fields_.at(pointer).is_string(); }

  [[nodiscard]] std::string text(const std::string& pointer) const {
    if (!is_text(pointer)) fields_.refuse(pointer, json::subject(pointer) + " must be a text");
    return fields_.line(pointer);
  }
  [[nodiscard]] double number(const std::string& pointer) const {
    const auto& value = fields_.at(pointer);
    if (!value.is_number()) fields_.refuse(pointer, json::shown(value) + " is not a number");
    return value.get<double>();
  }
  [[nodiscard]] double positive(const std::string& pointer) const {
    const double value = number(pointer);
    if (!(value > 0)) fields_.refuse(pointer, json::shown(fields_.at(pointer)) + " must be greater than 0");
    return value;
  }
  [[nodiscard]] int count(const std::string& pointer, int least) const {
    const auto& value = fields_.at(pointer);
    constexpr double most = 1e9;
    if (!value.is_number_integer() || value.get<double>() < least || value.get<double>() > most)
      fields_.refuse(pointer, json::shown(value) + " must be a whole number from " + std::to_string(least) + " on");
    return value.get<int>();
  }
  [[nodiscard]] bool yes(const std::string& pointer) const {
    const auto& value = fields_.at(pointer);
    if (!value.is_boolean()) fields_.refuse(pointer, json::shown(value) + " must be true or false");
    return value.get<bool>();
  }
  /// One of the words, as its index.
  std::size_t choice(const std::string& pointer, const std::vector<std::string>& words) const {
    const std::string word = text(pointer);
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i] == word) return i;
    fields_.refuse(pointer, in_quotes(word) + " is none of " + listed(words) + did_you_mean(word, words));
  }
  /// {"name": "text", ...}
  [[nodiscard]] std::map<std::string, std::string> labels(const std::string& pointer) const {
    if (!fields_.at(pointer).is_object()) fields_.refuse(pointer, "labels are given as {\"axis\": \"label\"}");
    std::map<std::string, std::string> result;
    for (const auto& [name, value] : fields_.at(pointer).items())
      result[name] = text(json::child_pointer(pointer, name));
    return result;
  }
  /// The object at `pointer` has no other keys than these.
  void only(const std::string& pointer, const std::vector<std::string>& keys, const std::string& whose) const {
    if (!fields_.at(pointer).is_object()) fields_.refuse(pointer, whose + " must be an object {...}");
    for (const auto& [name, value] : fields_.at(pointer).items()) {
      if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
      fields_.refuse_key(
          json::child_pointer(pointer, name),
          in_quotes(name) + " is no key of " + whose + did_you_mean(name, keys) + "\nit may have " + listed(keys));
    }
  }
  /// The object at `pointer` has this key.
  void needs(const std::string& pointer, const std::string& key, const std::string& whose) const {
    if (!has(json::child_pointer(pointer, key))) fields_.refuse(pointer, whose + " needs " + in_quotes(key));
  }

 private:
  const scene::SceneFields& fields_;
};

}  // namespace rouleau::study
