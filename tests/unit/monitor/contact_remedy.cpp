// What a failure in contact advises, by the potentials of the scene; tests/limits/check_remedies.py tries it.
#include "monitor/contact_remedy.hpp"

#include <catch2/catch.hpp>

#include "plan/read_scene.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;

namespace {

struct Planned {
  explicit Planned(const std::vector<std::string>& overrides)
      : scene(plan::read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", overrides)),
        plan(plan::make_plan(scene, catalog)) {}
  plugin::Catalog catalog{{ROULEAU_PLUGINS}};
  scene::Scene scene;
  plan::Plan plan;
  [[nodiscard]] std::string against_attraction(int stage = 0) const {
    return monitor::attraction_remedy(plan, plan.stages[stage]);
  }
  [[nodiscard]] std::string against_crossing(int other) const {
    return monitor::crossing_remedy(plan, plan.stages[0], 0, other);
  }
};

std::string depth(const std::string& value) { return "/interactions/0/parameters/depth=\"" + value + " J/m2\""; }
const std::string slip = "/numerics/slip_correction=true", area = "/numerics/area_correction=true";

}  // namespace

TEST_CASE("who leaks under attraction is told all that helps, and nothing that is there already") {
  const std::string deep = Planned({depth("2e-5")}).against_attraction();
  CHECK_THAT(deep, Contains("numerics.slip_correction and numerics.area_correction to true") &&
                       Contains(R"(["rbc", "self"])") && Contains("lower /stages/0/density_factor"));
  CHECK_THAT(Planned({depth("2e-5"), slip, area}).against_attraction(), !Contains("correction"));
  // A shallow well squeezes no cell and compresses no fluid.
  CHECK(Planned({depth("1e-8")}).against_attraction() ==
        "set numerics.slip_correction and numerics.area_correction to true");
  CHECK(Planned({depth("1e-8"), slip, area}).against_attraction().empty());
  CHECK_THAT(Planned({depth("2e-4")}).against_attraction(), Contains("lower the attraction to a depth of 5e-05 J/m2"));
  CHECK(Planned({"/interactions=[]"}).against_attraction().empty());
  // Of the last stage, whose factor is that of the scene.
  CHECK_THAT(Planned({depth("2e-5")}).against_attraction(1), !Contains("/stages/0"));
}

TEST_CASE("cells that cross are told to attract less only where they attract each other") {
  const Planned bare({"/interactions=[]"});
  CHECK_THAT(bare.against_crossing(1), Contains(R"(add an interaction "repulsion" between ["rbc", "rbc"])") &&
                                           Contains("a cutoff of 0.392 um or more") && !Contains("attraction"));
  CHECK_THAT(bare.against_crossing(0), Contains(R"(["rbc", "self"])") && !Contains("attraction"));
  const Planned repelled({R"(/interactions=[{"between": ["rbc", "rbc"], "model": "repulsion",
                                             "parameters": {"strength": "1e-7 J/m2"}}])"});
  CHECK_THAT(repelled.against_crossing(1), Contains("more strength"));
  CHECK_THAT(Planned({depth("2e-4")}).against_crossing(1), Contains("lower the attraction"));
}
