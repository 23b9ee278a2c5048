// The host judges documents by its own reader of JSON Schema (json/schema.hpp). Here valijson, an independent one,
// judges the same documents by the same schemas.
#include "json/json.hpp"  // before valijson, which includes the library by itself

#define VALIJSON_USE_EXCEPTIONS 1  // without, it ends the program
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "json/schema.hpp"
#include "plugin/lock.hpp"
#include "plugin/manifest_reader.hpp"
#include "scene/named_files.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene.hpp"
#include "stability/limits_document.hpp"
#include "study/study_document.hpp"

namespace fs = std::filesystem;
using namespace rouleau;
using Json = nlohmann::json;
using json::Document;

namespace {

const fs::path source = ROULEAU_SOURCE;

class Judges {
 public:
  Judges(std::string of, const Json& given) : name(std::move(of)), schema(given) {
    valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(schema), rules_);
  }

  [[nodiscard]] bool valijson_accepts(const Json& value) {
    try {
      return validator_.validate(rules_, valijson::adapters::NlohmannJsonAdapter(value), nullptr);
    } catch (const Json::out_of_range&) {  // it reads whole numbers as std::int64_t
      return false;
    }
  }

  /// Judges a document by both, and fails unless they agree.
  void judge(const Document& document) {
    std::string words = "accepts it";
    try {
      validate(document, schema);
      ++accepted;
    } catch (const Error& error) {
      words = error.what();
      ++refused;
    }
    const bool accepts = words == "accepts it";
    if (valijson_accepts(document.root()) == accepts) return;
    FAIL_CHECK("by the schema of a " << name << ' ' << document.file() << "\nvalijson "
                                     << (accepts ? "refuses it" : "accepts it") << ", the host: " << words);
  }

  std::string name;
  const Json& schema;
  int accepted = 0, refused = 0;

 private:
  valijson::Schema rules_;
  valijson::Validator validator_;  // keeps the patterns that it has compiled
};

/// Those of the documents that users write; schemas of results follow.
std::vector<std::unique_ptr<Judges>> all_judges() {
  std::vector<std::unique_ptr<Judges>> judges;
  const auto add = [&](const char* name, const Json& schema) {
    judges.push_back(std::make_unique<Judges>(name, schema));
  };
  add("scene", scene::scene_schema());
  add("manifest", plugin::manifest_schema());
  add("lock", plugin::lock_schema());
  add("study", study::study_schema());
  add("limits file", stability::limits_schema());
  add("study's result", study::study_result_schema());
  add("limits' result", stability::limits_result_schema());
  add("cell", scene::cell_schema());
  return judges;
}

/// A document of each kind that users write, in the order of all_judges().
std::vector<Document> one_of_each() {
  std::vector<Document> documents;
  for (const char* file : {"scenes/four-cells-shear.json", "plugins/interaction/depletion/depletion.json"})
    documents.push_back(Document::read(source / file));
  const std::string hash(64, 'a');
  documents.push_back(Document::parse(plugin::lock_text({{"trt", "collision", "1.0.0", hash, hash}}), "a.lock.json"));
  for (const char* file : {"studies/biconcave.json", "limits/adhesion.json"})
    documents.push_back(Document::read(source / file));
  return documents;
}

/// A pattern is matched with a recursion for every character, which valijson tries with texts of any length.
bool has_long_text(const Json& value) {
  constexpr std::size_t longest = 1000;  // bytes; the host refuses longer ones where a pattern is to be matched
  if (value.is_string()) return value.get_ref<const std::string&>().size() > longest;
  return value.is_structured() && std::any_of(value.begin(), value.end(), has_long_text);
}

/// Of a file of JSON. valijson counts the characters of a text to its first NUL: another character stands for that
/// here.
std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  return std::regex_replace(content, std::regex(R"(\\u0000)"), R"(\u0001)");
}

/// Files below a folder; of the folders of the source, those that are JSON by name.
std::vector<fs::path> files_in(const fs::path& folder, bool by_name) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && (!by_name || entry.path().extension() == ".json")) files.push_back(entry.path());
  }
  return files;
}

void walk(const Json& rule, const std::string& pointer,
          const std::function<void(const Json&, const std::string&)>& visit) {
  visit(rule, pointer);
  for (const auto& [key, part] : rule.items()) {
    if (part.is_structured()) walk(part, json::child_pointer(pointer, key), visit);
  }
}

/// For editors and readers alone.
const std::set<std::string> annotations{"$schema", "title", "description", "markdownDescription", "default", "unit"};

/// What host/json/schema.cpp judges, by what the keyword's value holds.
const std::set<std::string> plain{"$ref",
                                  "type",
                                  "const",
                                  "enum",
                                  "minimum",
                                  "maximum",
                                  "exclusiveMinimum",
                                  "exclusiveMaximum",
                                  "minLength",
                                  "maxLength",
                                  "pattern",
                                  "minItems",
                                  "maxItems",
                                  "uniqueItems",
                                  "required",
                                  "minProperties",
                                  "maxProperties"};
const std::set<std::string> with_one_rule{"items", "additionalProperties"};
const std::set<std::string> with_rules{"oneOf", "properties", "patternProperties", "definitions"};

/// Throws std::invalid_argument, naming the place, for a keyword that the host passes over in silence, and a "$ref" to
/// another file.
void require_known(const Json& schema, const Json& rule, const std::string& pointer) {
  if (rule.is_boolean()) return;
  const auto refuse = [](const std::string& at, const std::string& problem) {
    throw std::invalid_argument("the schema's " + (at.empty() ? "root" : at) + ' ' + problem);
  };
  if (!rule.is_object()) refuse(pointer, "is no rule");
  for (const auto& [keyword, value] : rule.items()) {
    const auto place = json::child_pointer(pointer, keyword);
    if (with_one_rule.contains(keyword)) {
      require_known(schema, value, place);
    } else if (with_rules.contains(keyword)) {
      for (const auto& [name, part] : value.items()) require_known(schema, part, json::child_pointer(place, name));
    } else if (!plain.contains(keyword) && !annotations.contains(keyword)) {
      refuse(pointer, "has the keyword " + in_quotes(keyword) + ", which the host does not judge");
    }
    if (keyword == "$ref" && !(value.is_string() && value.get<std::string>().starts_with("#/") &&
                               schema.contains(Json::json_pointer(value.get<std::string>().substr(1))))) {
      refuse(place, "names no rule of this schema");
    }
  }
}

/// A text of tests/scenes/bad/cases.json, whose form check_bad_scenes.py describes.
std::string text_of(const Json& parts) {
  if (parts.is_string()) return parts.get<std::string>();
  std::string text;
  for (const Json& part : parts) {
    if (part.is_string()) text += part.get<std::string>();
    for (int i = 0; part.is_array() && i < part[1].get<int>(); ++i)
      text += std::regex_replace(part[0].get<std::string>(), std::regex("#"), std::to_string(i));
  }
  return text;
}

/// A scene that must be refused; nothing for one that is no JSON, or whose --set cannot be put in.
std::optional<Document> refused_scene(const std::string& name, const Json& wrong, std::string text) {
  if (wrong.contains("scene")) text = text_of(wrong["scene"]);
  const Json changes = wrong.value("change", Json::object());
  for (const auto& [old, now] : changes.items()) text.replace(text.find(old), old.size(), text_of(now));
  try {
    Document document = Document::parse(std::move(text), name);
    if (wrong.contains("set")) document.set(wrong["set"].get<std::string>());
    return document;
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

TEST_CASE("every shipped schema uses only keywords that the host judges") {
  int schemas = 0;
  for (const auto& judges : all_judges()) {
    INFO(judges->name);
    CHECK_NOTHROW(require_known(judges->schema, judges->schema, ""));
    ++schemas;
  }
  // The definitions of matrix.schema.json are part of the schemas of studies and limits files.
  int files = 0;
  for (const char* folder : {"host", "sdk/schema"}) {
    for (const auto& file : files_in(source / folder, true)) files += file.string().ends_with(".schema.json");
  }
  CHECK(files == schemas + 1);
}

TEST_CASE("a keyword that the host does not judge is found wherever it stands in a schema") {
  const auto look_at = [](const char* text) {
    const Json schema = Json::parse(text);
    require_known(schema, schema, "");
  };
  for (const char* schema : {R"({"properties": {"a": {"multipleOf": 2}}})", R"({"definitions": {"b": {"if": {}}}})",
                             R"({"anyOf": [{}]})", R"({"items": [{}]})", R"({"additionalProperties": {"maxItem": 2}})",
                             R"({"oneOf": [{"not": {}}]})", R"({"patternProperties": {"^x-": {"format": "date"}}})",
                             R"({"$ref": "other.json#/definitions/b"})", R"({"$ref": "#/definitions/b"})"}) {
    INFO(schema);
    CHECK_THROWS_AS(look_at(schema), std::invalid_argument);
  }
  CHECK_THROWS_WITH(look_at(R"({"properties": {"a": {"multipleOf": 2}}})"),
                    "the schema's /properties/a has the keyword \"multipleOf\", which the host does not judge");
  // Names of keys and definitions, and values, are no keywords.
  CHECK_NOTHROW(look_at(
      R"({"properties": {"multipleOf": {"enum": [{"if": 1}]}}, "definitions": {"not": true}, "default": {"if": 1}})"));
}

TEST_CASE("the shipped schemas are draft 7") {
  for (const auto& judges : all_judges()) {
    INFO(judges->name);
    CHECK(judges->schema["$schema"] == "http://json-schema.org/draft-07/schema#");
    CHECK(judges->schema.contains("title"));
  }
}

TEST_CASE("the schemas of a scene, a manifest and a lock close every object and document every key") {
  for (const auto* schema : {&scene::scene_schema(), &plugin::manifest_schema(), &plugin::lock_schema()}) {
    walk(*schema, "", [&](const Json& rule, const std::string& pointer) {
      INFO(pointer);
      if (!rule.is_object() || !rule.contains("properties") || !rule["properties"].is_object()) return;
      if (rule.contains("type") && rule["type"] == "object") CHECK(rule.contains("additionalProperties"));
      for (const auto& [key, part] : rule["properties"].items()) {
        INFO(key);
        const auto& target =
            part.contains("$ref") ? schema->at(Json::json_pointer(part["$ref"].get<std::string>().substr(1))) : part;
        CHECK((part.contains("description") || target.contains("description")));
      }
    });
  }
}

TEST_CASE("the host and valijson accept and refuse the same documents by every schema") {
  auto all = all_judges();
  int judged = 0, too_long = 0;
  const auto judge = [&](const fs::path& file) {
    std::optional<Document> document;
    try {
      document = Document::parse(content_of(file), file.lexically_relative(source).string());
    } catch (const Error&) {
      return;  // no JSON: the corpora hold such files
    }
    if (has_long_text(document->root())) {
      ++too_long;
      return;
    }
    for (const auto& judges : all) judges->judge(*document);
    ++judged;
  };
  for (const char* folder : {"scenes", "cells", "studies", "limits", "plugins", "sdk", "tests"}) {
    for (const auto& file : files_in(source / folder, true)) judge(file);
  }
  for (const auto& file : files_in(source / "tests/fuzz/corpus", false)) judge(file);
  CHECK(judged > 400);
  CHECK(too_long < judged / 50);
  for (std::size_t i = 0; i < 5; ++i) {
    INFO(all[i]->name << ": " << all[i]->accepted << " accepted, " << all[i]->refused << " refused");
    CHECK((all[i]->accepted > 0 && all[i]->refused > 0));
  }
}

TEST_CASE("the host and valijson accept and refuse the same of the scenes that the program must refuse") {
  const fs::path folder = source / "tests/scenes/bad";
  const std::string good = content_of(folder / "base.json");
  // Bytes that are no UTF-8 are written as halves of a pair.
  const Json cases =
      Json::parse(std::regex_replace(content_of(folder / "cases.json"), std::regex(R"(\\udc..)"), R"(\ufffd)"));
  Judges judges("scene", scene::scene_schema());
  int skipped = 0;
  for (const auto& [name, wrong] : cases.items()) {
    const auto document = refused_scene(name, wrong, good);
    if (document && !has_long_text(document->root()))
      judges.judge(*document);
    else
      ++skipped;
  }
  INFO(judges.accepted << " accepted, " << judges.refused << " refused, " << skipped << " skipped");
  CHECK(judges.accepted > 30);  // what is wrong with these, no schema can say
  CHECK(judges.refused > 30);
  CHECK(static_cast<std::size_t>(skipped) < cases.size() / 4);
}

TEST_CASE("the host and valijson agree on documents with any one value replaced, taken out or added") {
  const auto documents = one_of_each();
  auto all = all_judges();
  const std::vector<Json> strange{nullptr,
                                  true,
                                  -1,
                                  0,
                                  3,
                                  1.5,
                                  2.0,
                                  1e30,
                                  "",
                                  "x",
                                  "1 um",
                                  "trt",
                                  std::string(200, 'a'),
                                  Json::array(),
                                  {1, 1},
                                  {"1 um", "1 um", "1 um"},
                                  Json::object(),
                                  {{"x", 1}},
                                  {{"model", "trt"}},
                                  {{"wall", Json::object()}}};
  for (std::size_t kind = 0; kind < documents.size(); ++kind) {
    Judges& judges = *all[kind];
    const auto judge = [&](const Json& changed, const std::string& what) {
      judges.judge(Document::parse(changed.dump(), documents[kind].file() + ", " + what));
    };
    const Json& root = documents[kind].root();
    judge(root, "unchanged");
    REQUIRE(judges.accepted == 1);
    walk(root, "", [&](const Json& part, const std::string& pointer) {
      for (const auto& [key, member] : part.items()) {
        const std::string at = json::child_pointer(pointer, key);
        for (const Json& value : strange) {
          Json changed = root;
          changed[Json::json_pointer(at)] = value;
          judge(changed, at + " = " + value.dump());
        }
        Json changed = root;
        Json& holder = changed[Json::json_pointer(pointer)];
        if (holder.is_array()) {
          holder.push_back(member);
          judge(changed, at + " twice");
        } else {
          holder["x-" + key] = member;
          judge(changed, at + " under another name");
          holder.erase("x-" + key);
          holder.erase(key);
          judge(changed, at + " taken out");
        }
      }
    });
    INFO(judges.name << ": " << judges.accepted << " accepted, " << judges.refused << " refused");
    CHECK((judges.accepted > 10 && judges.refused > 100));
  }
}
