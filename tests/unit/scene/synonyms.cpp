// The table of synonyms beside the schema of scenes.
#include "base/synonyms.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "base/error.hpp"
#include "json/schema.hpp"
#include "json/schema_words.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene.hpp"

using namespace rouleau;
using Json = nlohmann::json;

namespace {

void add_words(const Json& rule, std::set<std::string>& words) {
  if (rule.is_object() && rule.contains("enum")) {
    for (const Json& word : rule["enum"]) words.insert(word.is_string() ? word.get<std::string>() : word.dump());
  }
  if (!rule.is_structured()) return;
  for (const Json& part : rule) add_words(part, words);
}

}  // namespace

TEST_CASE("every synonym leads to a key or a word of the scene, and stands once for it in lower case") {
  std::set<std::string> ours;
  for (const auto& [key, places] : json::places_of_keys(scene::scene_schema())) ours.insert(key);
  add_words(scene::scene_schema(), ours);
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (const Synonym& synonym : synonyms()) {
    INFO(synonym.word << " -> " << synonym.ours);
    CHECK(ours.contains(std::string(synonym.ours)));
    CHECK(synonym.word != synonym.ours);
    CHECK(synonym.word.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos);
    CHECK(seen.emplace(synonym.word, synonym.ours).second);
  }
  CHECK(seen.size() > 70);
}

TEST_CASE("every synonym in the place of its key is answered with the key, and with nothing else") {
  // Of each object of the schema: the key alone is exchanged.
  int tried = 0;
  for (const Synonym& synonym : synonyms()) {
    for (const auto& [name, rule] : scene::scene_schema()["definitions"].items()) {
      if (!rule.contains("properties") || !rule["properties"].contains(std::string(synonym.ours))) continue;
      if (rule["properties"].contains(std::string(synonym.word))) continue;  // a key of its own there
      INFO(synonym.word << " in " << name);
      const Json schema = {{"type", "object"},
                           {"additionalProperties", false},
                           {"required", {std::string(synonym.ours)}},
                           {"properties", rule["properties"]},
                           {"definitions", scene::scene_schema()["definitions"]}};
      Faults faults;
      json::judge(json::Document::parse(Json{{std::string(synonym.word), 1}}.dump(), "a.json"), schema, faults);
      REQUIRE(faults.size() == 1);
      CHECK(faults[0].problem().starts_with("unknown key \"" + std::string(synonym.word) + "\"; did you mean \""));
      ++tried;
    }
  }
  CHECK(tried > 30);
}
