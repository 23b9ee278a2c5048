// The numbers that a plan makes of models' parameters: of what they are, never of what they are called.
#include <cmath>
#include <fstream>

#include "plan/plan_report.hpp"
#include "plan/read_scene.hpp"
#include "plugin/plugin_folder.hpp"

using namespace rouleau::plan;
using namespace rouleau::plugin;
using namespace rouleau::scene;
using namespace rouleau::test;
using Json = nlohmann::json;

namespace {

/// mu g R of the scene below, N/m.
constexpr double stress_times_radius = 1.2e-3 * 20 * 3.91e-6;

Scene scene_with(const std::vector<std::string>& overrides) {
  return read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", overrides);
}

std::map<std::string, double> numbers(const std::vector<std::string>& overrides,
                                      const std::vector<std::filesystem::path>& folders) {
  const Scene scene = scene_with(overrides);
  const Catalog catalog(folders);
  return make_report(make_plan(scene, catalog)).dimensionless;
}

std::map<std::string, double> shipped_numbers(const std::vector<std::string>& overrides) {
  return numbers(overrides, {ROULEAU_PLUGINS});
}

/// The third party's two models with these lists of parameters, in the scene in place of the neo-Hookean law and of the
/// Morse potential.
std::map<std::string, double> numbers_of_third_party(const Json& of_law, const Json& in_law, const Json& of_well,
                                                     const Json& in_well) {
  const PluginFolder folder;
  folder.copy(TESTED_third_party, "libthird.so");
  Json manifest = {
      {"manifest", 1},   {"abi", 1}, {"version", "1.0.0"}, {"library", "libthird.so"}, {"title", "Third party's"},
      {"license", "MIT"}};
  const auto add = [&](const char* kind, const char* id, const char* need, Json gives, const Json& parameters) {
    manifest.update({{"kind", kind}, {"id", id}, {"needs", {need}}, {"gives", gives}, {"parameters", parameters}});
    folder.write(std::string(kind) + ".json", manifest);
  };
  add("membrane", "org.example.law", "stretch", {"tension", "tension_by_stretch"}, of_law);
  add("interaction", "org.example.well", "distance", {"force", "energy"}, of_well);
  const Json law = {{"model", "org.example.law"}, {"parameters", in_law}};
  const Json well = {{"between", {"rbc", "rbc"}}, {"model", "org.example.well"}, {"parameters", in_well}};
  return numbers({"/cell_types/rbc/membrane/0=" + law.dump(), "/interactions/0=" + well.dump()},
                 {ROULEAU_PLUGINS, folder.path()});
}

const Json well_of_another_name = Json::parse(R"([{"name": "attraction", "unit": "J/m2"},
                                                  {"name": "range", "unit": "um"}])");
const Json a_well = {{"attraction", "2e-7 J/m2"}, {"range", "1 um"}};

}  // namespace

TEST_CASE("the capillary number is made with the parameter whose role is the shear modulus, whatever its name") {
  const Json law = Json::parse(R"([{"name": "elasticity", "unit": "dyn/cm", "role": "shear_modulus"},
                                   {"name": "shear_modulus", "unit": "N/m"}])");
  const auto found = numbers_of_third_party(law, {{"elasticity", "6e-6 N/m"}, {"shear_modulus", "1 N/m"}},
                                            well_of_another_name, a_well);
  CHECK(found.at("capillary") == Approx(stress_times_radius / 6e-6));
  CHECK(found.at("membrane_strain") == Approx(stress_times_radius / 18e-6));
}

TEST_CASE("a parameter without a role is never taken for the shear modulus, nor for a depth by its name") {
  const Json law = Json::parse(R"([{"name": "elasticity", "unit": "N/m"}, {"name": "shear_modulus", "unit": "Pa"}])");
  const Json well = Json::parse(R"([{"name": "attraction", "unit": "J/m2"}, {"name": "range", "unit": "um"},
                                    {"name": "depth", "unit": "m"}])");
  Json in_well = a_well;
  in_well["depth"] = "3 um";
  const auto found =
      numbers_of_third_party(law, {{"elasticity", "6e-6 N/m"}, {"shear_modulus", "5 Pa"}}, well, in_well);
  CHECK(std::isnan(found.at("capillary")));
  CHECK(found.at("membrane_strain") == Approx(stress_times_radius / 18e-6));
  CHECK(found.at("adhesion_number") == Approx(2e-7 / stress_times_radius));
}

TEST_CASE("the adhesion number is made with the depth of the well that the potential has") {
  CHECK(shipped_numbers({}).at("adhesion_number") == Approx(5.2e-8 / stress_times_radius).epsilon(1e-12));
  const std::string shifted = R"(/interactions/0={"between": ["rbc", "rbc"], "model": "lennard-jones-shifted",)"
                              R"( "parameters": {"depth": "1e-6 J/m2", "cutoff": "0.98 um"}})";
  const double depth = shipped_numbers({shifted}).at("adhesion_number") * stress_times_radius;
  CHECK(depth < 0.9e-6);  // the shift takes from the depth that the parameter gives
  CHECK(depth > 0.876e-6);
  // Of several wells the deepest, wherever it stands in the list.
  const std::string two = R"(/interactions/-={"between": ["rbc", "rbc"], "model": "morse", "parameters": {"depth": )";
  CHECK(shipped_numbers({two + R"("9e-8 J/m2"}})"}).at("adhesion_number") ==
        Approx(9e-8 / stress_times_radius).epsilon(1e-12));
  CHECK(shipped_numbers({two + R"("1e-8 J/m2"}})"}).at("adhesion_number") ==
        Approx(5.2e-8 / stress_times_radius).epsilon(1e-12));
}

TEST_CASE("what attracts nowhere has the adhesion number zero, and where there is no interaction there is none") {
  CHECK(shipped_numbers({R"(/interactions/0/parameters/depth="0 J/m2")"}).at("adhesion_number") == 0);
  CHECK(shipped_numbers({R"(/interactions/0={"between": ["rbc", "rbc"], "model": "repulsion",)"
                         R"( "parameters": {"strength": "1e-7 J/m2"}})"})
            .at("adhesion_number") == 0);
  CHECK(std::isnan(shipped_numbers({"/interactions=[]"}).at("adhesion_number")));
}

TEST_CASE("the capillary number is that of the first cell, whose radius it is made with, and of all its laws") {
  CHECK(shipped_numbers({}).at("capillary") == Approx(stress_times_radius / 6e-6));
  // Of another type, which stands before it in the alphabet and has no cell.
  CHECK(
      shipped_numbers({R"(/cell_types/capsule={"shape": {"circle": {"radius": "3 um"}}, "segments": 96, "membrane": [)"
                       R"({"model": "skalak", "parameters": {"shear_modulus": "1 N/m"}}]})"})
          .at("capillary") == Approx(stress_times_radius / 6e-6));
  CHECK(shipped_numbers(
            {R"(/cell_types/rbc/membrane/-={"model": "skalak", "parameters": {"shear_modulus": "2e-6 N/m"}})"})
            .at("capillary") == Approx(stress_times_radius / 8e-6));
}

TEST_CASE("without cells nothing is sheared or attracted") {
  const auto found =
      shipped_numbers({"/cells=[]", R"(/stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 15}])"});
  CHECK(std::isnan(found.at("capillary")));
  CHECK(std::isnan(found.at("adhesion_number")));
}

TEST_CASE("with the manifests of the first release, which had no roles, the capillary number is not known") {
  const PluginFolder folder;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(ROULEAU_PLUGINS)) {
    if (!entry.is_regular_file()) continue;
    const auto copy = folder.copy(entry.path(), std::filesystem::relative(entry.path(), ROULEAU_PLUGINS));
    if (copy.extension() != ".json") continue;
    Json manifest = Json::parse(std::ifstream(copy));
    for (Json& parameter : manifest["parameters"]) parameter.erase("role");
    std::ofstream(copy) << manifest;
  }
  const auto found = numbers({}, {folder.path()});
  CHECK(std::isnan(found.at("capillary")));
  CHECK(found.at("adhesion_number") == Approx(5.2e-8 / stress_times_radius).epsilon(1e-12));
}
