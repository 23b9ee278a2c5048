// A capsule in the channel against the boundary-integral solution in tests/reference/capsule_channel.json.
#include <catch2/catch.hpp>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <sstream>

#include "scene_run.hpp"

using namespace rouleau;
using namespace rouleau::study;
using namespace rouleau::test;

namespace {

struct Steady {
  double deformation, angle_deg, period, intrinsic_viscosity, area_drift_per_strain;
};

/// Steady values from the last quarter of a run; the period from one whole turn of the marker that ends the run.
Steady steady_state(const SceneRun& run) {
  const auto strain = run.column("strain"), d = run.column("deformation"), angle = run.column("angle_rad");
  const auto marker = run.column("tank_treading_angle_rad"), area = run.column("area_m2");
  const double phi = area.front() / (51.2e-6 * 25.6e-6);
  const auto viscosity = run.series_column("relative_viscosity");
  return {d.back(), angle.back() * 180 / std::numbers::pi, length_of_turns(strain, marker, 1, std::nullopt),
          (viscosity.back() - 1) / phi, std::abs(area.back() / area.front() - 1) / strain.back()};
}

nlohmann::json reference(double ca, double lambda) {
  for (const auto& entry : read_reference("capsule_channel.json")) {
    if (entry["parameters"]["Ca"] == ca && entry["parameters"]["lam"] == lambda) return entry["steady"];
  }
  FAIL("no such reference");
  return {};
}

}  // namespace

TEST_CASE("segments up to the limit of plan keep the area", "[capsule]") {
  const auto [segments, most] = GENERATE(table<int, double>({{126, 1e-4}, {63, 2e-4}}));
  const SceneRun run = run_scene(scenes + "/capsule.json",
                                 {"/cell_types/capsule/segments=" + std::to_string(segments), "/stages/0/strain=5"});
  REQUIRE(run.summary["status"] == "completed");
  CHECK(run.summary["warnings"].empty());
  // The circle it begins as has no long axis; the capsule it becomes is inclined to the flow, and by no half turns
  // more.
  const auto angle = run.column("angle_rad");
  CHECK(std::isnan(angle.front()));
  for (std::size_t i = 1; i < angle.size(); ++i) CHECK((angle[i] > 0 && angle[i] < std::numbers::pi / 3));
  const auto area = run.column("area_m2");
  const double drift = (area.back() / area.front() - 1) / 5;
  std::cout << "capsule with " << segments << " segments: area drift per strain " << drift << "\n";
  CHECK(std::abs(drift) < most);
}

namespace {

/// One row of the reference and how it is run. Radius 4 um, shear rate 20 1/s, mu gamma a = 9.6e-8 N/m.
struct Capsule {
  double ca, lambda;
  int radius = 20;  ///< lattice spacings
  bool corrected = true;
};

Steady run_capsule(const Capsule& c) {
  const double modulus = 9.6e-8 / c.ca, bending = 0.01 * modulus * 16e-12;
  // Half a turn more than the start needs, and one whole turn of the membrane.
  const double strain = c.lambda > 1 ? 28 : (c.ca > 0.05 ? 30 : 22);

  const auto exact = [](const std::string& pointer, double value) {
    std::ostringstream text;
    text << pointer << "=" << std::scientific << std::setprecision(16) << value;
    return text.str();
  };
  const SceneRun run =
      run_scene(scenes + "/capsule.json",
                {"/domain/nodes=[" + std::to_string(64 * c.radius / 5) + "," + std::to_string(32 * c.radius / 5) + "]",
                 "/cell_types/capsule/segments=" + std::to_string(std::lround(2 * std::numbers::pi * c.radius)),
                 "/cell_types/capsule/interior_viscosity=\"" + std::to_string(1.2 * c.lambda) + " cP\"",
                 exact("/cell_types/capsule/membrane/0/parameters/shear_modulus", modulus),
                 exact("/cell_types/capsule/membrane/1/parameters/modulus", bending),
                 "/stages/0/strain=" + std::to_string(strain),
                 std::string("/numerics/slip_correction=") + (c.corrected ? "true" : "false"),
                 std::string("/numerics/area_correction=") + (c.corrected ? "true" : "false")});
  REQUIRE(run.summary["status"] == "completed");
  CHECK(run.summary["conservation"]["mass_drift"].get<double>() < 1e-12);
  return steady_state(run);
}

/// Deviations from the reference: relative, angle in degrees.
struct Errors {
  double deformation, angle_deg, period, viscosity;
};

Errors compare(const Capsule& c, const Steady& s) {
  const nlohmann::json r = reference(c.ca, c.lambda);
  const Errors e{s.deformation / r["D_inertia"].get<double>() - 1, s.angle_deg - r["theta_deg"].get<double>(),
                 s.period / r["tank_treading_period_gamma"].get<double>() - 1,
                 s.intrinsic_viscosity / r["intrinsic_viscosity"].get<double>() - 1};
  std::cout << "capsule, Ca " << c.ca << ", lambda " << c.lambda << ", a = " << c.radius
            << (c.corrected ? "" : ", plain scheme") << ": D " << s.deformation << " (" << 100 * e.deformation
            << " %), angle " << s.angle_deg << " deg (" << e.angle_deg << " deg), period " << s.period << " ("
            << 100 * e.period << " %), intrinsic viscosity " << s.intrinsic_viscosity << " (" << 100 * e.viscosity
            << " %), area drift per strain " << s.area_drift_per_strain << "\n";
  return e;
}

void compare_with_reference(const Capsule& c) {
  const Steady s = run_capsule(c);
  const Errors e = compare(c, s);
  // What the issue asks for; the reference is known to 1e-4.
  CHECK(std::abs(e.deformation) < 0.005);
  CHECK(std::abs(e.angle_deg) < 0.15);
  CHECK(std::abs(e.period) < 0.004);
  CHECK(std::abs(e.viscosity) < 0.007);
  CHECK(s.area_drift_per_strain < 1e-6);
}

}  // namespace

TEST_CASE("the capsule deforms, inclines, tank-treads and thickens the fluid as the boundary-integral solution",
          "[capsule]") {
  compare_with_reference(GENERATE(Capsule{0.05, 1}, Capsule{0.05, 5}));
}

TEST_CASE("the capsule is as the boundary-integral solution at smaller and larger capillary numbers, too",
          "[capsule][weekly]") {
  compare_with_reference(GENERATE(Capsule{0.0125, 1}, Capsule{0.1, 1}, Capsule{0.2, 1}));
}

TEST_CASE("with the slip correction the capsule's deformation converges to second order", "[capsule]") {
  const Capsule coarse{0.05, 5, 10}, fine{0.05, 5, 20};
  const double at_10 = compare(coarse, run_capsule(coarse)).deformation;
  const double at_20 = compare(fine, run_capsule(fine)).deformation;
  CHECK(std::log2(at_10 / at_20) > 1.8);
}

TEST_CASE("the plain scheme slips: to first order in the spacing the capsule thickens the fluid too much",
          "[capsule][weekly]") {
  const Capsule coarse{0.05, 1, 10, false}, fine{0.05, 1, 20, false};
  const double at_10 = compare(coarse, run_capsule(coarse)).viscosity;
  const double at_20 = compare(fine, run_capsule(fine)).viscosity;
  CHECK(at_20 > 0.05);
  CHECK(std::log2(at_10 / at_20) == Approx(1.2).margin(0.3));
}
