// Capsules that shear drives away from a wall: against boundary integrals above an infinite wall, and in a channel.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iostream>
#include <numbers>

#include "scene_run.hpp"

using namespace rouleau::test;
using std::numbers::pi;

TEST_CASE("a capsule near a wall rises and moves along it as the boundary integral says", "[lift]") {
  // tests/reference/capsule_at_wall.py: rows of strain, height, distance, deformation, angle over pi, area.
  const nlohmann::json reference =
      nlohmann::json::parse(std::ifstream(std::string(ROULEAU_REFERENCE) + "/capsule_at_wall.json"));
  const SceneRun run = run_scene(scenes + "/lift.json", {"/stages/0/strain=4"});
  REQUIRE(run.summary["status"] == "completed");
  const auto strain = run.column("strain"), x = run.column("x_m"), y = run.column("y_m"),
             deformation = run.column("deformation"), angle = run.column("angle_rad");
  constexpr double radius = 4e-6;
  int compared = 0;
  double before = 0;
  for (const nlohmann::json& row : reference["rows"]) {
    const double at = row[0].get<double>(), height = row[1].get<double>(), distance = row[2].get<double>();
    const double speed = (distance - before) / 0.5;
    before = distance;
    // At first the fluid's inertia (Re 0.05) lets the capsule go with the flow until it disturbs that.
    if (at < 2.5 || at > 4.01) continue;
    const auto i = static_cast<std::size_t>(std::lround(at / 0.5));
    REQUIRE(strain.at(i) == Approx(at).margin(1e-3));
    const double risen = y[i] / radius - 1.5, moves = (x[i] - x[i - 1]) / radius / 0.5;
    std::cout << "strain " << at << ": risen by " << risen << " (" << height - 1.5 << "), moves by " << moves << " ("
              << speed << "), deformation " << deformation[i] << " (" << row[3] << "), angle/pi " << angle[i] / pi
              << " (" << row[4] << ")\n";
    CHECK(risen == Approx(height - 1.5).epsilon(0.02));
    CHECK(moves == Approx(speed).epsilon(0.02));
    CHECK(deformation[i] == Approx(row[3].get<double>()).epsilon(0.02));
    CHECK(angle[i] / pi == Approx(row[4].get<double>()).margin(0.004));
    ++compared;
  }
  CHECK(compared == 4);
}

TEST_CASE("a capsule beside the middle of a channel does as the boundary integral says", "[lift]") {
  // tests/reference/capsule_in_channel.py: rows of strain, centre, deformation, angle in degrees, relative viscosity,
  // area.
  struct Case {
    double capillary, ratio;
  };
  const auto [capillary, ratio] = GENERATE(Case{0.05, 1}, Case{0.2, 5});
  constexpr double radius = 4e-6, height = 9.6, place = 1.6 / 9.6;
  const double modulus = 9.6e-8 / capillary;  // mu g a over Ca
  const SceneRun run = run_scene(
      scenes + "/capsule.json",
      {R"(/domain/size=["51.2 um", "38.4 um"])", "/domain/nodes=[128, 96]", R"(/cells/0/at=["25.6 um", "6.4 um"])",
       "/cell_types/capsule/segments=63",
       "/cell_types/capsule/interior_viscosity=" + nlohmann::json(1.2e-3 * ratio).dump(),
       "/cell_types/capsule/membrane/0/parameters/shear_modulus=" + nlohmann::json(modulus).dump(),
       "/cell_types/capsule/membrane/1/parameters/modulus=" + nlohmann::json(0.01 * modulus * radius * radius).dump(),
       R"(/numerics={"tau": 2, "density_factor": 375, "coupling": "auto", )"
       R"("slip_correction": true, "area_correction": true})",
       "/stages/0/strain=8", R"(/output={"cells": {"strain": 1}})"});
  REQUIRE(run.summary["status"] == "completed");
  const auto y = run.column("y_m"), deformation = run.column("deformation"), angle = run.column("angle_rad");
  const nlohmann::json reference =
      nlohmann::json::parse(std::ifstream(std::string(ROULEAU_REFERENCE) + "/capsules_in_channels.json"));
  int compared = 0;
  for (const nlohmann::json& other : reference["cases"]) {
    if (other["height"] != height || std::abs(other["place"].get<double>() - place) > 1e-9) continue;
    if (other["capillary"] != capillary || other["ratio"] != ratio) continue;
    for (const nlohmann::json& row : other["rows"]) {
      const double at = row[0].get<double>();
      // Before, the fluid's inertia (Re 0.1) and the membrane's way to its shape show.
      if (at < 5 || at > 8.01 || at != std::floor(at)) continue;
      const auto i = static_cast<std::size_t>(at);
      const double rise = row[1].get<double>() - place * height;
      std::cout << "Ca " << capillary << ", ratio " << ratio << ", strain " << at << ": rise "
                << y[i] / radius - place * height << " (" << rise << "), deformation " << deformation[i] << " ("
                << row[2] << "), angle " << angle[i] * 180 / pi << " (" << row[3] << ")\n";
      CHECK(y[i] / radius - place * height == Approx(rise).epsilon(0.02));
      CHECK(deformation[i] == Approx(row[2].get<double>()).epsilon(0.02));
      CHECK(angle[i] * 180 / pi == Approx(row[3].get<double>()).margin(0.3));
      ++compared;
    }
  }
  CHECK(compared == 4);
}
