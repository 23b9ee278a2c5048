// A capsule that shear drives away from a wall: against boundary integrals above an infinite wall.
#include <catch2/catch.hpp>
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
