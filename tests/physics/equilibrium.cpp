// Stages that end by the rate of the cells' energy.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>

#include "scene_run.hpp"

using namespace rouleau::test;

namespace {

/// Two red cells side by side that attract each other, at two thirds of the paper's resolution.
SceneRun attracted(const std::string& rate, const std::string& interactions = "") {
  std::vector<std::string> overrides{
      R"(/domain/size=["15.68 um", "15.68 um"])",
      "/domain/nodes=[54, 54]",
      "/cell_types/rbc/segments=66",
      R"(/cell_types/rbc/interior_viscosity="1.2 cP")",
      R"(/cells=[{"type": "rbc", "row": {"count": 2, "spacing": "3.52 um", "axis": "x", "angle": "90 deg",
                                         "center": ["7.84 um", "7.84 um"]}}])",
      R"(/output={"cells": {"seconds": 0.2}})",
      R"(/stages=[{"name": "attract", "duration": "15 s", "density_factor": 13000, "until": "equilibrium"}])",
      R"(/equilibrium={"window": 0.2, "rate": ")" + rate + "\"}"};
  if (!interactions.empty()) overrides.push_back("/interactions=" + interactions);
  return run_scene(ROULEAU_SCENES "/four-cells-shear.json", overrides);
}

/// Elastic, bending and interaction energy, their sum and the sum of their magnitudes, of each output.
struct Energies {
  std::vector<double> sum, magnitude;
};
Energies energies(const SceneRun& run) {
  Energies all;
  const auto elastic = run.series_column("elastic_energy_J_per_m"),
             bending = run.series_column("bending_energy_J_per_m"),
             interaction = run.series_column("interaction_energy_J_per_m");
  for (std::size_t i = 0; i < elastic.size(); ++i) {
    all.sum.push_back(elastic[i] + bending[i] + interaction[i]);
    all.magnitude.push_back(std::abs(elastic[i]) + std::abs(bending[i]) + std::abs(interaction[i]));
  }
  return all;
}

}  // namespace

TEST_CASE("a pair of cells that attract each other ends when its energy's rate has fallen to what was asked for",
          "[equilibrium]") {
  const SceneRun run = attracted("0.02 1/s");
  REQUIRE(run.summary["status"] == "completed");
  CHECK(run.summary["stages"][0]["ended_by"] == "equilibrium");
  const auto time = run.series_column("time_s");
  const Energies energy = energies(run);
  const std::size_t last = time.size() - 1;
  REQUIRE(last > 4);
  const auto rate = [&](std::size_t i) {
    return std::abs(energy.sum[i] - energy.sum[i - 1]) / (time[i] - time[i - 1]) / energy.magnitude[i];
  };
  // The run ends a step after the window; outputs are at the windows' ends, to half a step. The last row may follow the
  // one before it by one step only.
  const std::size_t end = time[last] - time[last - 1] < 0.1 ? last - 1 : last;
  std::cout << "pair at rest: equilibrium at " << time[last] << " s; rates of the last windows";
  for (std::size_t i = end - 3; i <= end; ++i) std::cout << " " << rate(i);
  std::cout << " 1/s\n";
  CHECK(rate(end) < 0.02 * 1.05);
  for (std::size_t i = 1; i < end; ++i) CHECK(rate(i) > 0.02 * 0.95);
  // Asked for a slower end, it goes on to a lower energy.
  const SceneRun later = attracted("0.012 1/s");
  CHECK(later.summary["stages"][0]["ended_by"] == "equilibrium");
  CHECK(later.summary["simulated_time_s"].get<double>() > time[last] + 0.2);
  CHECK(energies(later).sum.back() < energy.sum.back());
}

TEST_CASE("cells that nothing moves are in equilibrium after one window", "[equilibrium]") {
  const SceneRun run = attracted("0.001 1/s", "[]");
  CHECK(run.summary["stages"][0]["ended_by"] == "equilibrium");
  CHECK(run.summary["simulated_time_s"].get<double>() == Approx(0.2).epsilon(0.01));
}
