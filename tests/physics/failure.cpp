// Runs that really fail, and what they report.
#include <algorithm>
#include <catch2/catch.hpp>

#include "scene_run.hpp"

using namespace rouleau::test;

TEST_CASE("energy that a suspension at rest gains stops it, though nothing else looks wrong", "[failure]") {
  const std::string two_cells = std::string(ROULEAU_SCENES) + "/../limits/scenes/two-cells.json";
  const std::vector<std::string> at_rest{"/numerics/coupling=semi-implicit", "/stages/1/strain=0.01"};
  const auto run = [&](const std::string& modulus, const std::string& limit) {
    auto overrides = at_rest;
    overrides.push_back("/cell_types/rbc/membrane/0/parameters/shear_modulus=\"" + modulus + "\"");
    overrides.push_back("/checks/energy_growth=" + limit);
    return run_scene(two_cells, overrides);
  };
  // A thousand times a red cell's modulus: the semi-implicit step bears it as far as any other check can see.
  const SceneRun stopped = run("6e-3 N/m", "0.01"), on = run("6e-3 N/m", "1000"), right = run("6e-6 N/m", "0.01");
  REQUIRE(stopped.summary["status"] == "diverged");
  CHECK(stopped.summary["failure"]["reason"] == "energy_growth");
  CHECK(stopped.summary["failure"]["value"] > 0.01);
  CHECK(on.summary["status"] == "completed");
  CHECK(right.summary["status"] == "completed");
  CHECK(right.summary["energy"]["largest_growth_at_rest_relative"] == 0);
  // What was gained has not been written.
  CHECK(stopped.series_column("step").back() < stopped.summary["failure"]["step"]);
  const std::vector<double> total = stopped.series_column("total_energy_J_per_m");
  const double least = *std::min_element(total.begin(), total.end());
  const nlohmann::json gain = stopped.summary["energy"];
  const double there_is =
      gain["largest_growth_at_rest_J_per_m"].get<double>() / gain["largest_growth_at_rest_relative"].get<double>();
  CHECK(total.back() - least < 0.01 * there_is);
}

TEST_CASE("a segment that gives way too far stops a run", "[failure]") {
  const std::string two_cells = std::string(ROULEAU_SCENES) + "/../limits/scenes/two-cells.json";
  const SceneRun run = run_scene(two_cells, {"/checks/stretch=1.01"});
  REQUIRE(run.summary["status"] == "diverged");
  const nlohmann::json failure = run.summary["failure"];
  CHECK(failure["reason"] == "uneven_nodes");
  CHECK((failure["value"] > 1.01 || failure["value"] < 1 / 1.01));
  CHECK(failure["cell"] >= 0);
}
