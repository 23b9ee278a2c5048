// Cells that are shipped: what a scene takes of them, what it keeps, and what is wrong with a name.
#include <catch2/catch.hpp>

#include "base/input_file.hpp"
#include "json/schema.hpp"
#include "scene/named_files.hpp"
#include "scene/read_scene.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using namespace rouleau::scene;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

Json scene_with(const Json& type) {
  Json scene = Json::parse(R"({
    "rouleau": 1,
    "domain": {"size": ["20 um", "20 um", "20 um"], "nodes": [40, 40, 40], "y": "periodic"},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"}, "numerics": {},
    "cells": [], "stages": [{"name": "rest", "duration": "1 ms"}], "output": {}})");
  scene["cell_types"] = {{"red", type}};
  return scene;
}

/// The document as it is read, with overrides; throws its faults.
Json read(const Json& scene, const std::vector<std::string>& overrides = {}) {
  const test::ScratchFolder folder;
  const auto file = folder.write("scene.json", scene.dump());
  auto document = std::make_shared<const json::Document>(read_document(file, overrides));
  (void)read_scene(document);
  return document->root();
}

}  // namespace

TEST_CASE("a cell type takes the keys of a shipped cell that are not written, and says what they were taken from") {
  const ShippedCell shipped = shipped_cell("human-red-cell", {"nowhere", "", 0, 0});
  const Json whole = read(scene_with({{"from", "human-red-cell"}}))["cell_types"]["red"];
  for (const auto& [key, value] : shipped.content["cell_type"].items()) CHECK(whole[key] == value);
  CHECK(whole["from"] == Json{{"cell", "human-red-cell"}, {"sha256", sha256(shipped.file)}});
  // A key of the scene counts whole: laws are those that are written, alone.
  const Json law = Json::parse(R"([{"model": "skalak", "parameters": {"shear_modulus": "5e-6 N/m"}}])");
  const Json own = read(scene_with({{"from", "human-red-cell"}, {"membrane", law}, {"interior_viscosity", "1 cP"}}));
  CHECK(own["cell_types"]["red"]["membrane"] == law);
  CHECK(own["cell_types"]["red"]["interior_viscosity"] == "1 cP");
  CHECK(own["cell_types"]["red"]["shape"] == shipped.content["cell_type"]["shape"]);
}

TEST_CASE("a scene that has taken a cell means the same whatever is shipped later: nothing more is taken") {
  Json scene = read(scene_with({{"from", "human-red-cell"}}));
  Json& type = scene["cell_types"]["red"];
  type["from"]["sha256"] = std::string(64, '0');  // of a file that is no more
  type.erase("interior_viscosity");               // which that one did not have
  CHECK(read(scene) == scene);
  type.erase("shape");
  CHECK_THROWS_WITH(read(scene), Contains("\"shape\" is missing"));
}

TEST_CASE("what is set on the command line chooses another shipped cell, or changes a part of one") {
  const Json scene = scene_with({{"from", "human-red-cell"}});
  CHECK(read(scene, {"/cell_types/red/from=capsule"})["cell_types"]["red"]["shape"].contains("sphere"));
  const Json stiff = read(scene, {"/cell_types/red/membrane/0/parameters/b2=0.75"})["cell_types"]["red"];
  CHECK(stiff["membrane"][0]["parameters"]["b2"] == 0.75);
  CHECK(stiff["membrane"][0]["parameters"]["shear_modulus"] == "3.94e-6 N/m");
}

TEST_CASE("a name that no shipped cell has is refused, and nothing that follows from it") {
  const auto words = [](const Json& scene) -> std::string {
    try {
      (void)read(scene);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string misspelt = words(scene_with({{"from", "human-redcell"}}));
  CHECK_THAT(misspelt,
             Contains("/cell_types/red/from") && Contains("did you mean \"human-red-cell\"?") && Contains("platelet"));
  CHECK_THAT(misspelt, !Contains("is missing"));
  CHECK_THAT(words(scene_with({{"from", "../cells/capsule"}})), Contains("no shipped cell is called"));
  Json flat = scene_with({{"from", "capsule"}, {"segments", 40}});
  flat["domain"]["size"].erase(2), flat["domain"]["nodes"].erase(2);
  CHECK_THAT(words(flat), Contains("is a cell of three dimensions, and the domain has two"));
  Json all = shipped_cell("capsule", {"nowhere", "", 0, 0}).content["cell_type"];
  all["from"] = "capsule";
  CHECK_THAT(words(scene_with(all)), Contains("gives nothing here"));
  CHECK_THAT(words(scene_with({{"interior_viscosity", "1 cP"}})), Contains("\"shape\" is missing"));
  CHECK_THAT(words(scene_with({{"shape", {{"sphere", {{"radius", "2 um"}}}}}})), Contains("\"membrane\" is missing"));
}

TEST_CASE("each number of a shipped cell has its source and its spread, and no source is of something else") {
  REQUIRE(cell_names().size() >= 4);
  for (const std::string& name : cell_names()) {
    CAPTURE(name);
    const Json content = shipped_cell(name, {"nowhere", "", 0, 0}).content;
    const Json values = content["cell_type"].flatten();
    for (const auto& [pointer, value] : values.items()) {
      if (pointer.ends_with("/model")) continue;
      CAPTURE(pointer);
      const std::string whole = pointer.substr(0, pointer.rfind('/'));  // of a list
      CHECK((content["sources"].contains(pointer) || content["sources"].contains(whole)));
    }
    for (const auto& [pointer, from] : content["sources"].items()) {
      CAPTURE(pointer);
      CHECK(content["cell_type"].contains(Json::json_pointer(pointer)));
    }
    CHECK_NOTHROW(read(scene_with({{"from", name}})));
  }
}
