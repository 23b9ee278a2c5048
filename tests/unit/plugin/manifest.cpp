// The reading of manifests: what a manifest says, and how a wrong one is refused.
#include "plugin/manifest.hpp"

#include <set>

#include "json/document.hpp"
#include "json/schema.hpp"
#include "plugin/manifest_reader.hpp"
#include "plugin/quantities.hpp"
#include "plugin_folder.hpp"

using rouleau::Cause;
using rouleau::Error;
using namespace rouleau::plugin;
using namespace rouleau::test;
using namespace rouleau::units;
using namespace rouleau::test;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

/// One way to break the good manifest: a JSON Patch, where the fault is, and words that the message must hold.
struct Fault {
  const char* patch;
  const char* pointer;
  std::vector<std::string> words;
};

Error refusal(const Json& manifest) {
  const PluginFolder folder;
  const auto file = folder.write("broken.json", manifest);
  return thrown_by([&] { read_manifest(file, Units()); });
}

const std::vector<Fault> faults = {
    {R"([{"op": "remove", "path": "/id"}])", "", {"id"}},
    {R"([{"op": "replace", "path": "/manifest", "value": 2}])", "/manifest", {"1"}},
    {R"([{"op": "replace", "path": "/abi", "value": 7}])", "/abi", {"1"}},
    {R"([{"op": "replace", "path": "/kind", "value": "membran"}])", "/kind", {"membrane"}},
    {R"([{"op": "replace", "path": "/id", "value": "Good One"}])", "/id", {"Good One"}},
    {R"([{"op": "replace", "path": "/version", "value": "1.0"}])", "/version", {"1.0"}},
    {R"([{"op": "replace", "path": "/library", "value": "../libgood.so"}])", "/library", {"../libgood.so"}},
    {R"([{"op": "replace", "path": "/library", "value": ".."}])", "/library", {".."}},
    {R"([{"op": "add", "path": "/nedes", "value": []}])", "/nedes", {"nedes", "needs"}},
    {R"([{"op": "add", "path": "/parameters/0/minimun", "value": 1}])", "/parameters/0/minimun", {"minimum"}},
    {R"([{"op": "replace", "path": "/parameters/0/unit", "value": "furlongs^"}])", "/parameters/0/unit", {"furlongs^"}},
    {R"([{"op": "remove", "path": "/parameters/0/unit"}])", "/parameters/0", {"unit", "choices"}},
    {R"([{"op": "replace", "path": "/parameters/1/name", "value": "depth"}])", "/parameters/1/name", {"depth", "two"}},
    {R"([{"op": "add", "path": "/parameters/0/default", "value": 101}])",
     "/parameters/0/default",
     {"101", "at most 100 uJ/m2"}},
    {R"([{"op": "replace", "path": "/parameters/1/default", "value": 0}])",
     "/parameters/1/default",
     {"0", "above 0 1/um"}},
    {R"([{"op": "replace", "path": "/parameters/1/default", "value": "3 1/um"}])",
     "/parameters/1/default",
     {"plain number", "1/um"}},
    {R"([{"op": "replace", "path": "/parameters/0/maximum", "value": -1}])",
     "/parameters/0/maximum",
     {"minimum", "maximum"}},
    {R"([{"op": "replace", "path": "/parameters/0/usual", "value": [1, 1000]}])", "/parameters/0/usual", {"limits"}},
    {R"([{"op": "replace", "path": "/parameters/0/usual", "value": [2, 1]}])", "/parameters/0/usual", {"smaller"}},
    {R"([{"op": "replace", "path": "/parameters/3/default", "value": "smoth"}])",
     "/parameters/3/default",
     {"smoth", "sharp, smooth"}},
    {R"([{"op": "add", "path": "/parameters/3/minimum", "value": 0}])", "/parameters/3/minimum", {"choices"}},
    {R"([{"op": "add", "path": "/parameters/0/role", "value": "dept"}])", "/parameters/0/role", {"dept", "depth"}},
    {R"([{"op": "add", "path": "/parameters/1/role", "value": "depth"}])",
     "/parameters/1/role",
     {"decay", "1/um", "depth", "in J/m2", "leave \"role\" out"}},
    {R"([{"op": "add", "path": "/parameters/3/role", "value": "cutoff"}])",
     "/parameters/3/role",
     {"form", "a choice", "cutoff", "in m"}},
    {R"([{"op": "add", "path": "/parameters/0/role", "value": "shear_modulus"}])",
     "/parameters/0/role",
     {"shear_modulus", "membrane", "interaction", "leave \"role\" out"}},
    {R"([{"op": "add", "path": "/parameters/0/role", "value": "depth"},
         {"op": "replace", "path": "/parameters/1/unit", "value": "N/m"},
         {"op": "add", "path": "/parameters/1/role", "value": "depth"}])",
     "/parameters/1/role",
     {"two", "depth"}},
    {R"([{"op": "replace", "path": "/needs/0", "value": "distanse"}])",
     "/needs/0",
     {"distanse", "did you mean \"distance\"?", "normal_velocity"}},
    {R"([{"op": "replace", "path": "/gives", "value": ["tension"]}])", "/gives/0", {"tension", "interaction"}},
    {R"([{"op": "replace", "path": "/gives", "value": ["energy"]}])", "/gives", {"force"}},
    {R"([{"op": "replace", "path": "/inactive_when", "value": {"dept": 0}}])",
     "/inactive_when/dept",
     {"dept", "did you mean \"depth\"?", "depth, decay, temperature, form"}},
    {R"([{"op": "replace", "path": "/inactive_when/depth", "value": -1}])", "/inactive_when/depth", {"at least 0"}},
    {R"([{"op": "replace", "path": "/inactive_when/depth", "value": "none"}])", "/inactive_when/depth", {"number"}},
    {R"([{"op": "replace", "path": "/inactive_when", "value": {"form": "round"}}])",
     "/inactive_when/form",
     {"round", "sharp, smooth"}},
    {R"([{"op": "add", "path": "/stands_for", "value": {"forn": "sharp"}}])",
     "/stands_for/forn",
     {"forn", "did you mean \"form\"?"}},
    {R"([{"op": "add", "path": "/stands_for", "value": {"form": "round"}}])",
     "/stands_for/form",
     {"round", "sharp, smooth"}},
    {R"([{"op": "add", "path": "/state", "value": [{"name": "age", "unit": "sek"}]}])", "/state/0/unit", {"sek"}},
    {R"([{"op": "add", "path": "/state", "value": [{"name": "heat", "unit": "J/K"}]}])",
     "/state/0/unit",
     {"J/K", "kelvin"}},
    {R"([{"op": "add", "path": "/state", "value": [{"name": "age", "unit": "s", "initial": "1 s"}]}])",
     "/state/0/initial",
     {"1 s"}},
    {R"([{"op": "add", "path": "/state", "value": [{"name": "age", "unit": "s"}, {"name": "age", "unit": "s"}]}])",
     "/state/1/name",
     {"age", "two"}},
    {R"([{"op": "add", "path": "/checks", "value": [{"inputs": {"distance": 1}, "outputs": {"forces": 1}}]}])",
     "/checks/0/outputs/forces",
     {"forces", "did you mean \"force\"?"}},
    {R"([{"op": "add", "path": "/state", "value": [{"name": "bonds", "unit": "1"}]},
         {"op": "add", "path": "/checks", "value": [{"inputs": {"bond": 1}, "outputs": {"force": 1}}]}])",
     "/checks/0/inputs/bond",
     {"did you mean \"bonds\"?", "\"state\""}},
    {R"([{"op": "add", "path": "/claims", "value": {"conservativ": true}}])", "/claims/conservativ", {"conservative"}},
    {R"([{"op": "add", "path": "/lattices", "value": ["D2Q7"]}])", "/lattices/0", {"D2Q7", "D2Q9"}},
    {R"([{"op": "add", "path": "/lattices", "value": ["D2Q9"]}])", "/lattices", {"interaction", "collision"}},
};

}  // namespace

TEST_CASE("every broken manifest is refused at the place of its fault with words that help") {
  for (const Fault& fault : faults) {
    INFO(fault.patch);
    const Error error = refusal(good_manifest().patch(Json::parse(fault.patch)));
    INFO(error.what());
    CHECK(error.cause() == Cause::plugin_refused);
    CHECK(error.place().pointer == fault.pointer);
    CHECK(error.place().line > 0);
    for (const auto& word : fault.words) CHECK_THAT(error.what(), Contains(word));
  }
}

TEST_CASE("a manifest's numbers become SI and its order of parameters is kept") {
  const PluginFolder folder;
  const Manifest manifest = read_manifest(folder.write("good.json", good_manifest()), Units());
  REQUIRE(manifest.parameters.size() == 4);
  CHECK(manifest.kind == ModelKind::interaction);
  CHECK(manifest.library == folder.path() / "libgood.so");
  CHECK(manifest.parameters[0].maximum.value() == Approx(1e-4).epsilon(1e-14));
  CHECK_FALSE(manifest.parameters[0].default_value);
  CHECK(manifest.parameters[1].default_value.value() == Approx(3.84e6).epsilon(1e-14));
  CHECK(manifest.parameters[1].dimension == Dimension{{0, -1, 0, 0, 0, 0}});
  CHECK(manifest.parameters[2].dimension == Dimension{{0, 0, 0, 1, 0, 0}});
  CHECK(manifest.parameters[3].default_value.value() == 1);
  CHECK(manifest.needs_input("distance"));
  CHECK_FALSE(manifest.needs_input("normal_velocity"));
  CHECK(manifest.gives_output("energy"));
}

TEST_CASE("the host knows every role of the schema, and a unit of each role's own dimension") {
  const Json& words =
      rouleau::plugin::manifest_schema()["properties"]["parameters"]["items"]["properties"]["role"]["enum"];
  REQUIRE(words.size() >= 8);
  const Units units;
  for (const std::string name : words) {
    INFO(name);
    const auto role = role_named(name);
    REQUIRE(role);
    CHECK(facts_of(*role).name == name);
    CHECK(facts_of(*role).role == *role);
    CHECK(facts_of(*role).dimension == units.dimension(facts_of(*role).unit));
  }
  CHECK_FALSE(role_named("modulus"));
}

TEST_CASE("a parameter is found by its role in any unit of the role's dimension") {
  Json well = good_manifest();
  well["parameters"][0]["role"] = "depth";
  const PluginFolder folder;
  const Manifest manifest = read_manifest(folder.write("good.json", well), Units());
  CHECK(manifest.parameter_with(Role::depth) == std::optional<std::size_t>(0));
  CHECK_FALSE(manifest.parameter_with(Role::cutoff));
}

TEST_CASE("state variables begin with their initial value in SI, or with zero") {
  Json remembering = good_manifest();
  remembering["state"] = Json::parse(
      R"([{"name": "age", "unit": "ms", "initial": 5}, {"name": "bonds", "unit": "1/um2", "doc": "Per area."}])");
  const PluginFolder folder;
  const Manifest manifest = read_manifest(folder.write("good.json", remembering), Units());
  REQUIRE(manifest.state.size() == 2);
  CHECK(manifest.state[0].name == "age");
  CHECK(manifest.state[0].initial == Approx(5e-3));
  CHECK(manifest.state[1].unit == "1/um2");
  CHECK(manifest.state[1].dimension == Dimension{{0, -2, 0, 0, 0, 0}});
  CHECK(manifest.state[1].initial == 0);

  remembering["checks"] = Json::parse(R"([{"inputs": {"distance": 1e-6, "bonds": 2}, "outputs": {"force": 0}}])");
  CHECK_NOTHROW(read_manifest(folder.write("good.json", remembering), Units()));
}

TEST_CASE("every quantity but four that are numbers has a unit, which messages write behind it") {
  std::set<std::string> numbers;
  for (const ModelKind kind : {ModelKind::membrane, ModelKind::interaction}) {
    for (const int dimension : {2, 3}) {
      Manifest manifest{};
      manifest.kind = kind;
      manifest.dimensions = {dimension};
      for (const auto& names : {inputs_of(kind, dimension), outputs_of(kind, dimension)}) {
        for (const std::string& name : names) {
          INFO(name);
          CHECK_NOTHROW(dimension_of(manifest, name));
          if (unit_of(manifest, name).empty()) numbers.insert(name);
        }
      }
    }
  }
  CHECK(numbers == std::set<std::string>{"area_ratio", "invariant_1", "invariant_2", "stretch"});
  Manifest bending{};
  bending.kind = ModelKind::membrane;
  CHECK(dimension_of(bending, "moment_by_curvature") == Dimension{{1, 2, -2, 0, 0, 0}});
  CHECK(dimension_of(bending, "pressure") == Dimension{{1, -1, -2, 0, 0, 0}});
}

TEST_CASE("keys that begin with x- are the author's own and may stand in every object") {
  Json own = good_manifest();
  own["x-note"] = {{"a", 1}};
  own["parameters"][0]["x-symbol"] = "D_e";
  own["inactive_when"]["x-why"] = "no well";
  own["claims"]["x-tested"] = true;
  own["checks"] = Json::parse(R"([{"inputs": {"distance": 1e-6, "x-n": "note"}, "outputs": {"force": 0}, "x-n": 1}])");
  const PluginFolder folder;
  const Manifest manifest = read_manifest(folder.write("own.json", own), Units());
  CHECK(manifest.inactive_when == Json{{"depth", 0}});
  CHECK(manifest.claims == Json::object());
}

TEST_CASE("a membrane law belongs to one element") {
  Json law = good_manifest();
  law["kind"] = "membrane";
  law["needs"] = {"stretch"};
  law["gives"] = {"tension", "energy", "tension_by_stretch"};
  const PluginFolder folder;
  CHECK_NOTHROW(read_manifest(folder.write("law.json", law), Units()));

  law["gives"] = {"tension", "moment"};
  CHECK_THAT(refusal(law).what(), Contains("split it into two models"));
  law["gives"] = {"moment"};
  CHECK(refusal(law).place().pointer == "/needs/0");
  law["gives"] = {"energy"};
  CHECK_THAT(refusal(law).what(), Contains("must give"));
  law["needs"] = {"area", "rest_area", "perimeter", "rest_perimeter"};
  law["gives"] = {"pressure", "perimeter_tension", "energy"};
  CHECK_NOTHROW(read_manifest(folder.write("cell.json", law), Units()));
}

TEST_CASE("a membrane law says in which dimensions it works, and what its elements are in three") {
  Json law = good_manifest();
  law["kind"] = "membrane";
  law["needs"] = {"stretch"};
  law["gives"] = {"tension", "energy"};
  const PluginFolder folder;
  const auto read = [&] { return read_manifest(folder.write("law.json", law), Units()); };
  CHECK(read().works_in(2));
  CHECK(!read().works_in(3));

  law["dimensions"] = {2, 3};
  CHECK(refusal(law).place().pointer == "/dimensions");
  law["in_3d"] = Json::parse(R"({"needs": ["invariant_1"], "gives": ["stress_1", "energy"],
                                 "checks": [{"inputs": {"invariant_1": 0}, "outputs": {"stress_1": 0}}]})");
  const Manifest both = read(), surface = both.in(3);
  CHECK(both.dimension() == 2);
  CHECK(both.in(2).gives == std::vector<std::string>{"tension", "energy"});
  CHECK(surface.dimension() == 3);
  CHECK(surface.gives == std::vector<std::string>{"stress_1", "energy"});
  CHECK(unit_of(surface, "energy") == "J/m2");

  law["in_3d"]["gives"] = {"tension"};
  CHECK(refusal(law).place().pointer == "/in_3d/gives/0");
  law["in_3d"]["gives"] = {"stress_1", "moment"};
  CHECK_THAT(refusal(law).what(), Contains("split it into two models"));
  law["in_3d"].erase("checks");
  law["in_3d"]["gives"] = {"energy"};
  CHECK_THAT(refusal(law).what(), Contains("in three dimensions must give"));
  law["in_3d"]["gives"] = {"stress_1"};
  law["in_3d"]["checks"] = Json::parse(R"([{"inputs": {"stretch": 1}, "outputs": {"stress_1": 0}}])");
  CHECK(refusal(law).place().pointer == "/in_3d/checks/0/inputs/stretch");

  law["dimensions"] = {3};
  CHECK_THAT(refusal(law).what(), Contains("themselves say it"));
  law.erase("in_3d");
  CHECK(refusal(law).place().pointer == "/needs/0");
  law["needs"] = {"volume", "rest_volume"};
  law["gives"] = {"pressure", "energy"};
  CHECK(unit_of(read(), "energy") == "J");

  law["state"] = Json::parse(R"([{"name": "dashpot", "unit": "1"}])");
  CHECK(refusal(law).place().pointer == "/state/0");
  CHECK_THAT(refusal(law).what(), Contains("cannot remember \"dashpot\" yet"));
  law.erase("state");
  law["needs"] = {"invariant_2", "invariant_2_rate"};
  law["gives"] = {"stress_2", "energy"};
  CHECK(refusal(law).place().pointer == "/needs/1");
  CHECK_THAT(refusal(law).what(), Contains("do not have it yet"));
  law["needs"] = Json::array();
  law["gives"] = {"shear_viscosity", "moment"};
  CHECK_THAT(refusal(law).what(), Contains("split it into two models"));
  law["gives"] = {"area_viscosity"};
  law["checks"] = Json::parse(R"([{"inputs": {}, "outputs": {"area_viscosity": 1e-7}}])");
  CHECK(unit_of(read(), "area_viscosity") == "N s/m");

  Json pair = good_manifest();
  pair.erase("dimensions");
  const auto works_in_space = [&] { return read_manifest(folder.write("pair.json", pair), Units()).works_in(3); };
  CHECK(works_in_space());
  pair["needs"] = {"distance", "normal_velocity"};
  CHECK(works_in_space());
  pair["needs"] = {"distance", "tangential_velocity"};
  CHECK(!works_in_space());
  pair["needs"] = {"distance", "sliding_speed"};
  CHECK(works_in_space());
  pair["needs"] = {"distance"};
  pair["dimensions"] = {2, 3};
  CHECK_NOTHROW(read_manifest(folder.write("pair.json", pair), Units()));
  pair["needs"] = {"distance", "tangential_velocity"};
  CHECK(refusal(pair).place().pointer == "/dimensions");
}

TEST_CASE("a collision operator works on the lattices that its manifest names, on D2Q9 if it names none") {
  const PluginFolder folder;
  Json manifest = {{"manifest", 1},           {"abi", 1},           {"kind", "collision"},
                   {"id", "mixes"},           {"version", "1.0.0"}, {"library", "libmixes.so"},
                   {"title", "Mixes"},        {"license", "MIT"},   {"needs", {"populations"}},
                   {"gives", {"populations"}}};
  const auto works = [&] {
    const Manifest read = read_manifest(folder.write("mixes.json", manifest), Units());
    return std::pair{read.works_in(2), read.works_in(3)};
  };
  CHECK(works() == std::pair{true, false});
  manifest["lattices"] = {"D2Q9", "D3Q19"};
  CHECK(works() == std::pair{true, true});
  manifest["lattices"] = Json::array({"D3Q19"});
  CHECK(works() == std::pair{false, true});
}

TEST_CASE("the manifests of the shipped plugins are accepted and name existing libraries' sources") {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SHIPPED_PLUGINS)) {
    if (entry.path().extension() != ".json") continue;
    INFO(entry.path());
    const Manifest manifest = read_manifest(entry.path(), Units());
    // A library may hold several models; its folder, its source and it itself have one name.
    CHECK(manifest.library.filename().string() == "lib" + entry.path().parent_path().filename().string() + ".so");
    CHECK(entry.path().parent_path().parent_path().filename() == to_string(manifest.kind));
    ++count;
  }
  CHECK(count >= 5);
}

TEST_CASE("malformed text, folders and oversized files are refused without being taken for manifests") {
  const PluginFolder folder;
  const Error malformed =
      thrown_by([&] { read_manifest(folder.write("a.json", std::string("{\"manifest\": 1,\n x}")), Units()); });
  CHECK(malformed.cause() == Cause::plugin_refused);
  CHECK(malformed.place().line == 2);
  const Error absent = thrown_by([&] { read_manifest(folder.path() / "absent.json", Units()); });
  CHECK(absent.cause() == Cause::plugin_refused);
  CHECK_THAT(absent.what(), Contains("cannot be read"));
  CHECK_THAT(thrown_by([&] { read_manifest(folder.path(), Units()); }).what(), Contains("it is a directory"));
  const auto large = folder.write("large.json", std::string((1 << 20) + 1, ' '));
  CHECK_THAT(thrown_by([&] { read_manifest(large, Units()); }).what(), Contains("1 MiB"));
}
