// Models are made once and kept.
#include "plan/models.hpp"

#include <catch2/catch.hpp>

#include "plan/read_scene.hpp"
#include "plan/solver_setup.hpp"

using namespace rouleau;

TEST_CASE("a model is made once for each density factor, and every setup shares it") {
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const scene::Scene scene = plan::read_scene(
      std::string(ROULEAU_SCENES) + "/four-cells-shear.json",
      {R"(/stages=[{"name": "a", "duration": "1 ms", "density_factor": 20}, {"name": "b", "duration": "1 ms"},
                   {"name": "c", "duration": "1 ms", "density_factor": 20}])",
       "/output={}"});
  const plan::Plan plan = plan::make_plan(scene, catalog);
  REQUIRE(plan.made.size() == 3);
  CHECK(plan.made[0] != plan.made[1]);
  CHECK(plan.made[0] == plan.made[2]);
  for (const int stage : {0, 1, 2}) {
    const plan::StageModels& made = *plan.made[stage];
    const auto setup = plan::make_solver_setup<2>(plan, stage);
    CHECK(setup.collision.self == made.collision.self);
    REQUIRE(setup.interactions.size() == 1);
    CHECK(setup.interactions[0].potential.self == made.interactions[0].self);
    REQUIRE(setup.cell_types.size() == 1);
    REQUIRE(setup.cell_types[0].laws.size() == made.membranes[0].size());
    for (std::size_t law = 0; law < made.membranes[0].size(); ++law)
      CHECK(setup.cell_types[0].laws[law].self == made.membranes[0][law].self);
  }
}
