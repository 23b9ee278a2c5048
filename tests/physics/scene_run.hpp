// Runs a scene end to end, as `rouleau run` does, and reads back what a user reads: cells.csv and summary.json.
#pragma once

#include <unistd.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "plan/read_scene.hpp"
#include "run/simulation.hpp"
#include "scratch_folder.hpp"
#include "study/quantity.hpp"

namespace rouleau::test {

using namespace files;
using namespace plan;
using namespace plugin;
using namespace run;
using namespace scene;

inline const std::string scenes = ROULEAU_PHYSICS_SCENES;

struct SceneRun {
  nlohmann::json scene, summary;
  std::map<std::string, std::vector<std::string>> cells;     ///< columns of cells.csv
  std::map<std::string, std::vector<std::string>> series;    ///< columns of series.csv
  std::map<std::string, std::vector<std::string>> profiles;  ///< columns of profiles.csv; empty where it is not wanted

  /// A column as numbers, rows of one cell only.
  [[nodiscard]] std::vector<double> column(const std::string& name, int cell = 0) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < cells.at(name).size(); ++i) {
      if (cells.at("cell")[i] == std::to_string(cell)) values.push_back(std::stod(cells.at(name)[i]));
    }
    return values;
  }
  [[nodiscard]] std::vector<double> series_column(const std::string& name) const { return numbers(series.at(name)); }
  [[nodiscard]] std::vector<double> profile(const std::string& name) const { return numbers(profiles.at(name)); }

 private:
  static std::vector<double> numbers(const std::vector<std::string>& texts) {
    std::vector<double> values;
    for (const std::string& text : texts) values.push_back(std::stod(text));
    return values;
  }
};

inline std::map<std::string, std::vector<std::string>> read_table(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::map<std::string, std::vector<std::string>> table;
  std::vector<std::string> names;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream cells(line);
    std::vector<std::string> fields;
    for (std::string field; std::getline(cells, field, ',');) fields.push_back(field);
    if (names.empty()) {
      names = fields;
    } else {
      for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) table[names[i]].push_back(fields[i]);
    }
  }
  return table;
}

inline SceneRun run_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                          int threads = 1) {
  const auto catalog_of = [](const Scene&) { return Catalog({ROULEAU_PLUGINS}); };
  const auto [scene, numerics_choice] = read_within_limits(file, overrides, catalog_of);
  const Catalog catalog = catalog_of(scene);
  const Plan plan = make_plan(scene, catalog, numerics_choice);
  const test::ScratchFolder folder;
  RunOptions options;
  options.threads = threads;
  options.quiet = true;
  {
    RunDirectory directory(folder.path() / "run", scene);
    simulate(plan, make_report(plan), options, &directory);
  }
  SceneRun run;
  std::ifstream(folder.path() / "run" / "scene.json") >> run.scene;
  std::ifstream(folder.path() / "run" / "summary.json") >> run.summary;
  run.cells = read_table(folder.path() / "run" / "cells.csv");
  run.series = read_table(folder.path() / "run" / "series.csv");
  run.profiles = read_table(folder.path() / "run" / "profiles.csv");
  return run;
}

inline nlohmann::json read_reference(const std::string& name) {
  nlohmann::json data;
  std::ifstream(std::filesystem::path(ROULEAU_REFERENCE) / name) >> data;
  return data;
}

}  // namespace rouleau::test
