// What a plan finds out about potentials by asking them: wells at any scale, and what the lattice makes of them.
#include <catch2/catch.hpp>

#include "plan/plan_report.hpp"
#include "plan/potential_shape.hpp"
#include "plan/read_scene.hpp"
#include "plugin/model.hpp"

using namespace rouleau;
using namespace rouleau::plan;
using namespace rouleau::plugin;
using namespace rouleau::scene;

namespace {

const Catalog& plugins() {
  static const Catalog catalog({ROULEAU_PLUGINS});
  return catalog;
}

PotentialShape shape_of(const char* id, const std::vector<double>& values) {
  return find_shape(make_potential(plugins().find(ModelKind::interaction, id, {}), values, {{1, 1, 1}, 1.0, false}));
}

/// Limit whose name begins so, in a scene of the scenes folder.
const Limit* limit(const PlanReport& plan, const std::string& begin) {
  for (const Limit& candidate : plan.limits) {
    if (candidate.name.starts_with(begin)) return &candidate;
  }
  return nullptr;
}

const std::string scenes = ROULEAU_SCENES;

}  // namespace

TEST_CASE("the well of a Morse potential is found wherever it lies and however narrow it is") {
  for (const double distance : {2.5, 0.06, 1e-4}) {
    for (const double sharpness : {1.0, 30.0, 1000.0, 1e5}) {
      const double decay = sharpness / distance;
      CAPTURE(distance, decay);
      const PotentialShape found = shape_of("morse", {1.3, decay, distance, 36});
      REQUIRE(found.well);
      CHECK(found.range == 36);
      CHECK(found.well->distance == Approx(distance).epsilon(1e-12));
      CHECK(found.well->depth == Approx(1.3).epsilon(1e-12));
      // The strongest attraction, depth x decay/2, lies between samples that stand within 2 %.
      CHECK(found.well->width() == Approx(2 / decay).epsilon(1e-3));
      CHECK(found.stiffness == Approx(2 * 1.3 * decay * decay).epsilon(1e-3));
    }
  }
}

TEST_CASE("a Lennard-Jones well is as deep as its parameter says and 0.37 of its distance wide") {
  const PotentialShape found = shape_of("lennard-jones", {1.3, 2.5, 36});
  REQUIRE(found.well);
  CHECK(found.well->distance == Approx(2.5).epsilon(1e-12));
  CHECK(found.well->depth == Approx(1.3).epsilon(1e-12));
  // Strongest attraction where s = (r0/r)^6 = 7/13: 12 De s (1 - s)/r.
  const double s = 7.0 / 13, attraction = 12 * 1.3 * s * (1 - s) / (2.5 * std::pow(s, -1.0 / 6));
  CHECK(found.well->attraction == Approx(attraction).epsilon(1e-3));
  CHECK(found.stiffness == Approx(72 * 1.3 / 6.25).epsilon(1e-3));
}

TEST_CASE("a repulsion has a range and no well, and an attraction down to contact has its well there") {
  const PotentialShape repulsion = shape_of("repulsion", {1.3, 5});
  CHECK(!repulsion.well);
  CHECK(repulsion.range == 5);
  CHECK(repulsion.stiffness == Approx(3 * 1.3 / 25).epsilon(0.01));
  const PotentialShape attraction = shape_of("morse", {1.3, 0.4, 1e-9, 36});
  REQUIRE(attraction.well);
  CHECK(attraction.well->distance == 0);
}

TEST_CASE("plan warns with the number that depletion lies far below the lattice, and that a wider well does not") {
  const Scene physical = read_scene(scenes + "/depletion-physical.json", {});
  const PlanReport warned = make_report(make_plan(physical, plugins()));
  const Limit* gap = limit(warned, "equilibrium gap of depletion");
  REQUIRE(gap != nullptr);
  // 15.16 nm on a lattice of 196 nm (tests/unit/sdk/depletion.cpp has the distance from a separate evaluation).
  CHECK(gap->value == Approx(15.16 / 196).epsilon(1e-3));
  CHECK(gap->margin < 0.05);
  std::string warnings;
  for (const std::string& warning : warned.warnings) warnings += warning + "\n";
  CHECK(warnings.find("equilibrium gap of depletion in lattice spacings is 0.0773") != std::string::npos);
  CHECK(!warned.wells.at(0).stands_for);

  const Scene regularised = read_scene(scenes + "/depletion-regularised.json", {});
  const PlanReport plan = make_report(make_plan(regularised, plugins()));
  CHECK(plan.warnings.empty());
  CHECK(limit(plan, "equilibrium gap of depletion")->value == Approx(2.5));
  const auto& [model, between, well, stands_for, widened, doubt] = plan.wells.at(0);
  REQUIRE(stands_for);
  CHECK(well.depth == Approx(stands_for->depth).epsilon(1e-9));
  CHECK(well.depth == Approx(1.3203e-6).epsilon(1e-4));
  CHECK(stands_for->distance == Approx(15.16e-9).epsilon(1e-3));
  REQUIRE(widened);
  CHECK(*widened == Approx(well.width / stands_for->width));
  CHECK(*widened > 10);
}

TEST_CASE("plan warns of a repulsion whose range the lattice does not resolve") {
  const std::string file = scenes + "/depletion-physical.json";
  const auto plan_with = [&](const std::string& range) {
    const Scene scene = read_scene(
        file, {R"(/interactions/0={"between": ["rbc", "rbc"], "model": "repulsion", "parameters": {"strength": 1e-8, )"
               R"("cutoff": ")" +
               range + "\"}}"});
    return make_report(make_plan(scene, plugins())).warnings;
  };
  CHECK(plan_with("0.6 um").empty());
  const std::vector<std::string> warnings = plan_with("0.196 um");
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("range of the repulsion of repulsion in lattice spacings is 1, below") != std::string::npos);
}

TEST_CASE("parameters that a model refuses are an error at its place in the scene, with the model's reason") {
  const Scene scene =
      read_scene(scenes + "/depletion-regularised.json", {R"(/interactions/0/parameters/concentration="8 g/dL")"});
  try {
    make_plan(scene, plugins());
    FAIL("a well that is not there was regularised");
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    CHECK(error.place().pointer == "/interactions/0");
    CHECK(std::string(error.what()).find("no well to regularise; take the model \"repulsion\"") != std::string::npos);
  }
}

TEST_CASE("a stage that is to end once cells have parted is refused where nothing joins them") {
  const std::string file = scenes + "/blood/pair-2d.json";
  CHECK(make_plan(read_scene(file, {}), plugins()).stages.at(1).stage->until_parted);
  for (const char* without :
       {"/interactions=[]", "/interactions/0/parameters/depth=0", R"(/interactions/0/between=["rbc", "wall"])"}) {
    CAPTURE(without);
    const Scene scene = read_scene(file, {without});
    try {
      make_plan(scene, plugins());
      FAIL("it would wait for what never comes");
    } catch (const Error& error) {
      CHECK(error.cause() == Cause::bad_input);
      CHECK(error.place().pointer == "/stages/1/until");
      CHECK(std::string(error.what()).find("no interaction attracts the cells") != std::string::npos);
    }
  }
}
