// What a plan reports, and in which order.
#include "plan/plan_report.hpp"

#include <catch2/catch.hpp>

#include "plan/read_scene.hpp"

using namespace rouleau;
using namespace rouleau::plan;
using Catch::Matchers::Contains;

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
