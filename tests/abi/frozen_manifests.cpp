// The manifests of the first release in the host of today: each stays valid and says what it said.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "json/document.hpp"
#include "json/schema.hpp"
#include "plugin/manifest.hpp"
#include "plugin/manifest_reader.hpp"

using namespace rouleau::json;
using namespace rouleau::plugin;
using namespace rouleau::units;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

/// Every "properties" of a part of a schema, as pointers of the documents it describes; arrays' items count as /*.
void collect_keys(const Json& part, const std::string& at, std::vector<std::string>& keys) {
  const Json& schema = part.contains("$ref")
                           ? manifest_schema().at(Json::json_pointer(part["$ref"].get<std::string>().substr(1)))
                           : part;
  if (schema.contains("properties")) {
    for (const auto& [name, member] : schema["properties"].items()) {
      keys.push_back(at + '/' + name);
      collect_keys(member, at + '/' + name, keys);
    }
  }
  if (schema.contains("items")) collect_keys(schema["items"], at + "/*", keys);
}

bool holds(const Json& document, const std::string& key) {
  if (key.empty()) return true;
  const auto end = std::min(key.find('/', 1), key.size());
  const std::string name = key.substr(1, end - 1), rest = key.substr(end);
  if (name != "*") return document.is_object() && document.contains(name) && holds(document[name], rest);
  return document.is_array() &&
         std::any_of(document.begin(), document.end(), [&](const Json& entry) { return holds(entry, rest); });
}

}  // namespace

TEST_CASE("every manifest of the first release stays valid") {
  int manifests = 0;
  for (const auto& entry : fs::directory_iterator(FROZEN_SOURCES)) {
    if (entry.path().extension() != ".json") continue;
    INFO(entry.path());
    CHECK_NOTHROW(read_manifest(entry.path(), Units()));
    ++manifests;
  }
  CHECK(manifests == 7);
}

TEST_CASE("the manifest with every key means what it meant") {
  const Manifest m = read_manifest(fs::path(FROZEN_SOURCES) / "every-key.json", Units());
  CHECK(m.kind == ModelKind::interaction);
  CHECK(m.id == "org.example.every-key.v2");
  CHECK(m.version == "2.10.0-beta.1+build.7");
  CHECK(m.library == fs::path(FROZEN_SOURCES) / "libevery_key-1.so.2");
  CHECK(m.title == "Every key that a manifest of interface 1.0 may hold");
  CHECK(m.reference == "A. Author, Journal 1:2-3 (2000), eq. 4");
  CHECK(m.author == "A. Author");
  CHECK(m.license == "MIT OR Apache-2.0");
  REQUIRE(m.parameters.size() == 5);
  const Parameter& depth = m.parameters[0];
  CHECK(depth.name == "depth");
  CHECK(depth.unit == "uJ/m2");
  CHECK(*depth.default_value == Approx(2e-6));
  CHECK(*depth.minimum == 0);
  CHECK(*depth.maximum == Approx(1e-4));
  CHECK((*depth.usual)[0] == Approx(1e-9));
  CHECK((*depth.usual)[1] == Approx(1e-5));
  CHECK(depth.doc == "How deep.");
  const Parameter& distance = m.parameters[1];
  CHECK(*distance.default_value == Approx(490e-9));
  CHECK(*distance.exclusive_minimum == 0);
  CHECK(*distance.exclusive_maximum == Approx(1e-5));
  CHECK(!m.parameters[2].default_value);
  CHECK(*m.parameters[3].default_value == 12);
  CHECK(m.parameters[4].choices == std::vector<std::string>{"physical", "regularised"});
  CHECK(*m.parameters[4].default_value == 1);
  CHECK(m.needs == std::vector<std::string>{"distance", "normal_velocity", "tangential_velocity"});
  CHECK(m.gives == std::vector<std::string>{"energy", "force", "force_by_distance"});
  REQUIRE(m.state.size() == 2);
  CHECK(m.state[0].name == "bonds");
  CHECK(m.state[0].initial == Approx(3e12));
  CHECK(m.state[1].initial == 0);
  CHECK(m.inactive_when == Json{{"depth", 0}});
  CHECK(m.stands_for == Json{{"place", "physical"}});
  CHECK(m.claims == Json{{"conservative", true}, {"smooth_at_cutoff", false}, {"reproducible", true}, {"budget", 25}});
  CHECK(m.checks.size() == 2);
}

TEST_CASE("the manifest with every key has every key of the first release's schema") {
  const std::vector<std::string> appended_later = {
      "/parameters/*/role", "/checks/*/inertia", "/checks/*/time_step", "/dimensions", "/in_3d", "/lattices"};
  const Json document = Document::read(fs::path(FROZEN_SOURCES) / "every-key.json").root();
  std::vector<std::string> keys, missing;
  collect_keys(manifest_schema(), "", keys);
  for (const auto& key : keys) {
    const bool later = std::any_of(appended_later.begin(), appended_later.end(),
                                   [&](const auto& added) { return key == added || key.starts_with(added + '/'); });
    if (!later && !holds(document, key)) missing.push_back(key);
  }
  CHECK(missing == std::vector<std::string>{});
}
