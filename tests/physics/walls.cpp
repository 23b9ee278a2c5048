// Walls that move the other way round, and walls that carry the whole flow with them.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "scene_run.hpp"

using namespace rouleau::test;

namespace {

/// The capsule, at 64 rows ten spacings a radius, without slip, in the channel 25.6 um high.
SceneRun sheared(const std::string& y, const std::string& drive, const std::string& end, int rows = 64) {
  const SceneRun run =
      run_scene(scenes + "/capsule.json",
                {"/domain/nodes=[" + std::to_string(2 * rows) + ", " + std::to_string(rows) + "]",
                 R"(/output={"cells": {"seconds": 0.0125}})", "/cell_types/capsule/segments=" + std::to_string(rows),
                 "/numerics/slip_correction=true", "/numerics/area_correction=true",
                 R"(/cells/0/at=["25.6 um", ")" + y + R"( um"])",
                 R"(/stages=[{"name": "flow", "start": "developed", )" + drive + ", " + end + "}]"});
  REQUIRE(run.summary["status"] == "completed");
  return run;
}

/// From the first output to the last, radii.
double way(const SceneRun& run, const char* name) {
  const auto values = run.column(name);
  return (values.back() - values.front()) / 4e-6;
}

// 20/s over 25.6 um; 0.5 mm/s on top is twice the walls' own speed.
const std::string still_walls = R"("shear_rate": "20 1/s")",
                  moving_walls = R"("walls": {"lower": "0.244 mm/s", "upper": "0.756 mm/s"})";

}  // namespace

TEST_CASE("a negative shear rate is the mirror image of the positive one", "[walls]") {
  const SceneRun right = sheared("10", R"("shear_rate": "20 1/s")", R"("strain": 3)"),
                 left = sheared("10", R"("shear_rate": "-20 1/s")", R"("strain": 3)");
  CHECK(left.summary["strain"] == right.summary["strain"]);
  CHECK(left.summary["steps"] == right.summary["steps"]);
  const auto same = [&](const std::vector<double>& a, const std::vector<double>& b, double margin) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).margin(margin));
  };
  same(left.column("deformation"), right.column("deformation"), 1e-9);
  same(left.column("y_m"), right.column("y_m"), 1e-9 * 4e-6);
  same(left.series_column("relative_viscosity"), right.series_column("relative_viscosity"), 1e-9);
  CHECK(left.series_column("particle_stress_Pa").back() ==
        Approx(-right.series_column("particle_stress_Pa").back()).epsilon(1e-8));
  const double turned = left.column("angle_rad").back() + right.column("angle_rad").back();
  CHECK(std::abs(std::remainder(turned, std::numbers::pi)) < 1e-8);
  // Displacements along x mirror each other.
  const auto x = left.column("x_m"), other = right.column("x_m");
  CHECK(x.back() - x.front() == Approx(other.front() - other.back()).epsilon(1e-8));
}

TEST_CASE("a mean speed of both walls carries a sheared capsule along and changes neither shape nor viscosity",
          "[walls]") {
  const std::string y = GENERATE(std::string("12.8"), std::string("9"));  // in the middle and off it
  const SceneRun still = sheared(y, still_walls, R"("strain": 4)"), moved = sheared(y, moving_walls, R"("strain": 4)");
  CHECK(moved.summary["steps"] == still.summary["steps"]);
  CHECK(moved.summary["strain"].get<double>() == Approx(still.summary["strain"].get<double>()).epsilon(1e-12));
  const double time = moved.summary["simulated_time_s"], carried = way(moved, "x_m") - way(still, "x_m");
  const double deformation = still.column("deformation").back(), other = moved.column("deformation").back();
  std::cout << "capsule at " << y << " um: carried " << carried << " radii, the walls' mean way "
            << 0.5e-3 * time / 4e-6 << "; deformation " << deformation << " and " << other << "; relative viscosity "
            << still.series_column("relative_viscosity").back() << " and "
            << moved.series_column("relative_viscosity").back() << "\n";
  CHECK(carried == Approx(0.5e-3 * time / 4e-6).epsilon(1e-3));
  CHECK(other == Approx(deformation).epsilon(2e-3));
  CHECK(moved.series_column("relative_viscosity").back() ==
        Approx(still.series_column("relative_viscosity").back()).epsilon(2e-3));
}

TEST_CASE("the drift that a mean speed of both walls adds falls with the square of the spacing", "[walls]") {
  const auto added = [](int rows) {
    const SceneRun still = sheared("9", still_walls, R"("strain": 4)", rows),
                   moved = sheared("9", moving_walls, R"("strain": 4)", rows);
    const double drift = way(moved, "y_m") - way(still, "y_m");
    std::cout << rows << " rows: drift across " << way(still, "y_m") << " radii, with a mean speed " << drift
              << " more\n";
    return std::abs(drift);
  };
  const double coarse = added(64), fine = added(96);
  CHECK(std::log(coarse / fine) / std::log(1.5) > 1.7);
  CHECK(fine < 1.5e-3);
}

TEST_CASE("walls with the same speed take a fluid along and shear nothing", "[walls]") {
  const SceneRun run =
      sheared("12.8", R"("walls": {"lower": "0.3 mm/s", "upper": "0.03 cm/s"})", R"("duration": "0.1 s")");
  CHECK(run.summary["strain"] == 0.0);
  for (const double stress : run.series_column("particle_stress_Pa")) CHECK(std::abs(stress) < 1e-6);
  const auto x = run.column("x_m");
  CHECK(x.back() - x.front() == Approx(0.3e-3 * run.summary["simulated_time_s"].get<double>()).epsilon(1e-6));
}
