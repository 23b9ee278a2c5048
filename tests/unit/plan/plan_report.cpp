// What a plan reports, and in which order.
#include "plan/plan_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "plan/read_scene.hpp"

using namespace rouleau;
using namespace rouleau::plan;
using Catch::Matchers::Contains;

TEST_CASE("a plan shows the speeds of walls that have a mean, and holds the faster one to the limit") {
  const scene::Scene scene = read_scene(
      std::string(ROULEAU_SCENES) + "/four-cells-shear.json",
      {R"(/stages=[{"name": "flow", "duration": "1 s", "walls": {"lower": "-0.5 mm/s", "upper": "0.1 mm/s"}}])",
       "/output={}"});
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const Plan plan = make_plan(scene, catalog);
  const PlanReport report = make_report(plan);
  std::map<std::string, double> si, lattice;
  for (const Conversion& row : report.conversions) si[row.quantity] = row.si, lattice[row.quantity] = row.lattice;
  CHECK(si.at("lower wall's speed") == Approx(-0.5e-3).epsilon(1e-12));
  CHECK(si.at("upper wall's speed") == Approx(0.1e-3).epsilon(1e-12));
  CHECK(si.at("shear rate") == Approx(0.6e-3 / 25.088e-6).epsilon(1e-12));
  const double faster = std::abs(lattice.at("lower wall's speed"));
  CHECK(report.dimensionless.at("mach_wall") == Approx(faster * std::sqrt(3.0)).epsilon(1e-12));
  const auto limit = std::find_if(report.limits.begin(), report.limits.end(),
                                  [](const Limit& l) { return l.name.starts_with("Mach number of the walls"); });
  REQUIRE(limit != report.limits.end());
  CHECK(limit->value == report.dimensionless.at("mach_wall"));
  CHECK_THAT(limit->remedy, Contains("the walls' speeds"));
}

TEST_CASE(
    "warnings go from what the scene says to what follows from it: parameters, flow, kernel, slip, auto, limits") {
  const scene::Scene scene =
      read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json",
                 {R"(/cell_types/rbc/membrane/0/parameters/shear_modulus="6 N/m")", R"(/domain/y="periodic")",
                  R"(/stages=[{"name": "fall", "duration": "1 s", "pressure_gradient": "3 Pa/m"}])", "/output={}",
                  "/numerics/kernel=roma3", "/numerics/slip_correction=true"});
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const Plan plan = make_plan(
      scene, catalog,
      NumericsChoice{.target = 0.01, .steady = false, .expected = {}, .values = {}, .doubt = "there is a doubt"});
  const PlanReport report = make_report(plan);
  const std::vector<std::string>& warnings = report.warnings;
  REQUIRE(warnings.size() > 5);
  CHECK_THAT(warnings[0], Contains("shear_modulus"));
  CHECK_THAT(warnings[1], Contains("no wall holds it"));
  CHECK_THAT(warnings[2], Contains("kernel roma3"));
  CHECK_THAT(warnings[3], Contains("numerics.slip_correction with attracting cells"));
  CHECK(warnings[4] == "there is a doubt");
  for (std::size_t i = 5; i < warnings.size(); ++i) CHECK(warnings[i].starts_with(report.limits[i - 5].name + " is "));
  CHECK(to_json(plan, report)["numerics_choice"]["target_error"] == 0.01);
}

TEST_CASE("strain of an oscillating stage is the integral of the shear rate's magnitude") {
  const double base = GENERATE(0.0, 0.3, -0.3, 1.7, -1.7), amplitude = GENERATE(1.0, -1.0);
  StageSetting setting{};
  setting.shear_rate = base;
  setting.oscillating_rate = amplitude;
  setting.oscillation.frequency = 1.0 / 1000;
  double sum = 0;
  for (long step = 0; step <= 2600; ++step) {
    if (step % 100 == 0) {
      CAPTURE(step);
      CHECK(setting.strain_after(step) == Approx(sum).epsilon(1e-5).margin(1e-2));
    }
    sum += std::abs(base + amplitude * std::sin(2 * std::numbers::pi * (static_cast<double>(step) + 0.5) / 1000));
  }
}
