// Whose a checkpoint is: which differences are told, and which of them --force may pass over.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "json/document.hpp"
#include "plan/read_scene.hpp"
#include "run/checkpoint_match.hpp"

using namespace rouleau::core;
using namespace rouleau::observe;
using namespace rouleau::plan;
using namespace rouleau::plugin;
using namespace rouleau::run;
using namespace rouleau::scene;
using Catch::Contains;

namespace {

/// The four-cell scene in its second stage, read with these --set.
struct Reading {
  explicit Reading(const std::vector<std::string>& overrides)
      : scene(read_scene(std::string(ROULEAU_SCENES) + "/four-cells-shear.json", overrides)),
        catalog({ROULEAU_PLUGINS}),
        plan(make_plan(scene, catalog)) {}
  Scene scene;
  Catalog catalog;
  Plan plan;
};

nlohmann::json facts_of(const Reading& reading, int stage) {
  RunState state{Observer(reading.scene)};
  state.stage = stage;
  return checkpoint_facts(reading.plan, state, 1);
}

std::vector<Difference> compared(const std::vector<std::string>& then, const std::vector<std::string>& now,
                                 int stage = 1) {
  return differences(facts_of(Reading(then), stage), Reading(now).plan, stage);
}

}  // namespace

TEST_CASE("a run does not differ from itself") { CHECK(compared({}, {}).empty()); }

TEST_CASE("what decides about outputs and ends may change, what a state means may not") {
  struct Row {
    const char* change;
    bool harmless;
  };
  const auto row = GENERATE(
      Row{"/title=\"another\"", true}, Row{"/output/fields/strain=2", true}, Row{"/checks/mach=0.2", true},
      Row{"/stages/1/strain=30", true}, Row{"/stages/1/name=\"flow\"", true}, Row{"/at_rest/window=\"0.1 s\"", true},
      Row{"/stages/1/shear_rate=\"30 1/s\"", false}, Row{"/stages/1/density_factor=2000", false},
      Row{"/stages/0/duration=\"6 s\"", false}, Row{"/fluid/viscosity=\"1.3 cP\"", false},
      Row{"/numerics/precision=\"f32\"", false}, Row{"/cell_types/rbc/segments=90", false},
      Row{"/interactions/0/parameters/depth=\"6e-8 J/m2\"", false}, Row{"/domain/nodes=[512,256]", false});
  CAPTURE(row.change);
  const auto found = compared({}, {row.change});
  REQUIRE(found.size() == (std::string(row.change).find("nodes") == std::string::npos ? 1 : 2));
  for (const Difference& difference : found) CHECK(difference.harmless == row.harmless);
  const std::string pointer(row.change, std::find(row.change, row.change + std::strlen(row.change), '='));
  // A part that the scene did not have is told of where it begins.
  CHECK_THAT(found.front().what, Contains(pointer) || Contains("not in the checkpoint's scene"));
}

TEST_CASE("later stages may change and be added; a stage that is over or running may not go") {
  const std::string third = R"(/stages/-={"name": "rest", "duration": "1 s"})";
  for (const Difference& difference : compared({}, {third})) CHECK(difference.harmless);
  for (const Difference& difference : compared({}, {"/stages/1/shear_rate=\"5 1/s\""}, 0)) CHECK(difference.harmless);
  const auto gone = compared({third}, {}, 2);
  REQUIRE(gone.size() == 1);
  CHECK_FALSE(gone.front().harmless);
  CHECK_THAT(gone.front().what, Contains("/stages/2") && Contains("not there now"));
}

TEST_CASE("another program may go on, and another library as long as it remembers the same") {
  const Reading reading({});
  nlohmann::json facts = facts_of(reading, 1);
  facts["program"] = "0.0.1";
  auto found = differences(facts, reading.plan, 1);
  REQUIRE(found.size() == 1);
  CHECK(found.front().harmless);
  CHECK_THAT(found.front().what, Contains("0.0.1 in the checkpoint"));

  facts = facts_of(reading, 1);
  facts["plugins"][0]["sha256"] = std::string(64, '0');
  found = differences(facts, reading.plan, 1);
  REQUIRE(found.size() == 1);
  CHECK(found.front().harmless);
  facts["plugins"][0]["state"] = {{{"name", "memory"}, {"unit", "1"}}};
  found = differences(facts, reading.plan, 1);
  REQUIRE(found.size() == 1);
  CHECK_FALSE(found.front().harmless);
  CHECK_THAT(found.front().what, Contains("remembers other things"));
}
