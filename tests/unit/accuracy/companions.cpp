// Which companions a scene has.
#include "accuracy/companions.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "plan/read_scene.hpp"

using namespace rouleau;
using namespace rouleau::accuracy;

namespace {

constexpr double share = 0.38, long_run_s = 1000;

Companions of_capsule(const std::vector<std::string>& changes) {
  return choose_companions(plan::read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/capsule.json", changes),
                           {.run_s = long_run_s});
}

}  // namespace

TEST_CASE("companions have the scene's shape on a coarser lattice, segments with it, and cost a part of the run") {
  const Companions companions = of_capsule({});
  REQUIRE(companions.runs.size() == 3);
  CHECK(companions.expected_share <= share);
  CHECK(companions.refinement > 4.0 / 3);
  const auto on = [&](const Companion& companion, double refinement) {
    const nlohmann::json& scene = companion.scene;
    const double nx = scene["domain"]["nodes"][0], ny = scene["domain"]["nodes"][1];
    CHECK(nx == 2 * ny);
    CHECK(128 / ny == Approx(refinement));
    CHECK(scene["cell_types"]["capsule"]["segments"] == std::lround(126 / refinement));
  };
  CHECK(companions.runs[0].role == Role::lattice);
  CHECK(companions.runs[0].scene["numerics"]["density_factor"] == 1562.5);
  on(companions.runs[0], companions.refinement);
  CHECK(companions.runs[1].role == Role::order);
  CHECK(companions.coarsest / companions.refinement == Approx(1.25).epsilon(0.05));
  on(companions.runs[1], companions.coarsest);
  // Half the density on the coarser of the two, without slip correction with the same relaxation time.
  CHECK(companions.runs[2].role == Role::inertia);
  CHECK(companions.runs[2].against == 1);
  on(companions.runs[2], companions.coarsest);
  CHECK(companions.density == 0.5);
  CHECK(companions.runs[2].scene["numerics"]["density_factor"] == 1562.5 / 2);
  CHECK(companions.runs[2].scene["numerics"]["tau"] == 1.0);
  CHECK(companions.order == 1);
}

TEST_CASE(
    "with slip correction the fluid of the companion of another density gives way as before, for moments on the finer "
    "lattice") {
  const auto corrected = [](const std::string& tau, bool moments) {
    return choose_companions(plan::read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/capsule.json",
                                              {"/numerics/slip_correction=true", "/numerics/tau=" + tau}),
                             {.run_s = long_run_s, .moments = moments});
  };
  const bool moments = GENERATE(false, true);
  const Companions companions = corrected("1", moments);
  CHECK(companions.order == 2);
  CHECK(companions.density == 0.5);
  const Companion& light = companions.runs.back();
  CHECK(light.against == (moments ? 0 : 1));
  CHECK(light.scene["domain"]["nodes"] ==
        companions.runs[static_cast<std::size_t>(light.against)].scene["domain"]["nodes"]);
  // It gives way to pressures by (tau - 1/2)^2 times the density.
  CHECK(light.scene["numerics"]["tau"].get<double>() == Approx(0.5 + 0.5 * std::sqrt(2)));
  // A relaxation time above 3 is avoided.
  const Companions dense = corrected("2.5", moments);
  CHECK(dense.density == 2);
  CHECK(dense.runs.back().scene["numerics"]["tau"].get<double>() == Approx(0.5 + 2 / std::sqrt(2)));
  CHECK(dense.runs.back().scene["numerics"]["density_factor"] == 3125);
}

TEST_CASE(
    "in three dimensions thin cells with the sharp kernel have companions of seven spacings a radius, others coarser "
    "ones") {
  const auto chosen = [](const std::string& nodes, const std::vector<std::string>& changes) {
    std::vector<std::string> overrides{"/domain/nodes=[" + nodes + "," + nodes + "," + nodes + "]"};
    overrides.insert(overrides.end(), changes.begin(), changes.end());
    return choose_companions(
        plan::read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/biconcave-capsule-3d.json", overrides),
        {.run_s = long_run_s, .moments = true});
  };
  const double radius = 10.5;  // on 84 nodes
  const Companions thin = chosen("84", {});
  CHECK(thin.why_none.empty());
  CHECK(radius / thin.refinement >= 7);
  CHECK(radius / thin.coarsest >= 5.5);
  CHECK(thin.density == 2);
  CHECK(thin.expected_share > share);
  CHECK(thin.expected_share < 2 * share);
  for (const char* other :
       {R"(/cell_types/rbc/shape={"sphere": {"radius": "3.91 um"}})", "/numerics/slip_correction=false"}) {
    INFO(other);
    const Companions usual = chosen("84", {other});
    CHECK(usual.why_none.empty());
    CHECK(usual.expected_share <= share);
    CHECK(radius / usual.refinement < 7);
  }
  CHECK_THAT(chosen("64", {}).why_none, Catch::Matchers::Contains("fewer than 7"));
}

TEST_CASE("companions whose fluid must not give way take shorter steps") {
  const scene::Scene scene =
      plan::read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/capsule.json",
                       {"/numerics/slip_correction=true", "/numerics/density_factor=5000", "/numerics/tau=2.5"});
  const Companions plain = choose_companions(scene, {.run_s = long_run_s}),
                   stiff = choose_companions(scene, {.run_s = long_run_s}, 0.01);
  REQUIRE(stiff.runs.size() == 3);
  CHECK(plain.runs[0].scene["numerics"]["tau"] == 2.5);
  const double tau = stiff.runs[0].scene["numerics"]["tau"];
  CHECK(stiff.runs[1].scene["numerics"]["tau"] == tau);
  // 2.7 (tau - 1/2) times the shear rate in a step; viscosity (tau - 1/2)/3 is the fluid's over the density, spacings
  // and steps.
  const double rows = stiff.runs[1].scene["domain"]["nodes"][1], spacing = 25.6e-6 / rows;
  const double step = (tau - 0.5) / 3 * spacing * spacing * 5000 * 1e3 / 1.2e-3;
  CHECK(2.7 * (tau - 0.5) * 20 * step == Approx(0.01));
  // The lattice's error of round cells does not depend on tau; that of biconcave ones grows by a fifth for each unit
  // above 1.
  const double nodes = stiff.runs[0].scene["domain"]["nodes"][1];
  CHECK(stiff.refinement == Approx(128 / nodes));
}

TEST_CASE("of a run with many outputs that reports moments companions have a quarter of them") {
  const scene::Scene scene = plan::read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/capsule.json");
  const auto interval = [&](long outputs, bool moments) {
    const RunCost cost{.run_s = long_run_s, .outputs = outputs, .moments = moments};
    return choose_companions(scene, cost).runs[0].scene["output"]["cells"]["strain"].get<double>();
  };
  CHECK(interval(1000, true) == 1);
  CHECK(interval(100, true) == 0.25);
  CHECK(interval(1000, false) == 0.25);
}

TEST_CASE("companions of a three-dimensional run have fewer nodes along each of three sides, and fewer triangles") {
  const scene::Scene scene = plan::read_scene(
      std::string(ROULEAU_SCENES) + "/../tests/physics/scenes/plain-capsule-3d.json", {"/domain/nodes=[64, 64, 64]"});
  const Companions companions = choose_companions(scene, {.run_s = long_run_s});
  REQUIRE(companions.why_none.empty());
  CHECK(companions.order == 1);  // without slip correction
  CHECK(companions.expected_share < 0.4);
  REQUIRE(companions.runs.size() == 3);
  for (const auto& [run, coarser] : {std::pair(0, companions.refinement), {1, companions.coarsest}}) {
    const nlohmann::json& changed = companions.runs[static_cast<std::size_t>(run)].scene;
    const auto nodes = changed["domain"]["nodes"].get<std::vector<int>>();
    CHECK(nodes == std::vector<int>(3, static_cast<int>(std::lround(64 / coarser))));
    const double edges =
        std::sqrt(scene.cell_types[0].triangles / changed["cell_types"]["capsule"]["triangles"].get<double>());
    CHECK(edges == Approx(coarser).epsilon(0.15));
    CHECK_FALSE(changed["cell_types"]["capsule"].contains("segments"));
  }
}

TEST_CASE("a start from rest has a companion of its own where it takes a good part of the strain") {
  const Companions companions = of_capsule({"/stages/0/start=impulsive", "/stages/0/strain=3"});
  REQUIRE(companions.runs.size() == 4);
  CHECK(companions.runs[0].scene["stages"][0]["start"] == "impulsive");
  CHECK(companions.runs[1].scene["stages"][0]["start"] == "impulsive");
  CHECK(companions.runs[2].role == Role::start);
  CHECK(companions.runs[2].against == 1);
  CHECK(companions.runs[2].scene["stages"][0]["start"] == "developed");
  CHECK(companions.runs[3].scene["stages"][0]["start"] == "developed");
  CHECK(companions.runs[3].against == 2);
  CHECK(companions.expected_share <= share);
  // H^2/(24 nu) times the density factor is a strain of 0.7.
  CHECK(of_capsule({"/stages/0/start=impulsive", "/stages/0/strain=22"}).runs.size() == 3);
}

TEST_CASE("the density factors of all stages change together, and a true density is not changed") {
  const Companions companions = of_capsule({R"(/stages=[{"name":"rest","duration":"1 s","density_factor":100},)"
                                            R"({"name":"shear","shear_rate":20,"strain":9}])"});
  const nlohmann::json& scene = companions.runs.back().scene;
  CHECK(scene["stages"][0]["density_factor"] == 100 * companions.density);
  CHECK(scene["numerics"]["density_factor"] == 1562.5 * companions.density);
  CHECK_FALSE(scene["stages"][1].contains("density_factor"));
  CHECK(of_capsule({"/numerics/density_factor=1"}).runs.size() == 2);
  const Companions nearly = of_capsule({"/numerics/density_factor=1.25"});
  CHECK(nearly.density == 0.8);
  CHECK(nearly.relaxed == Approx(0.2));
}

TEST_CASE("what auto chose is pinned in the companions") {
  const scene::Scene scene = plan::read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/auto-capsule.json");
  const Companions companions = choose_companions(scene, {.run_s = long_run_s});
  REQUIRE_FALSE(companions.runs.empty());
  const nlohmann::json& companion = companions.runs[0].scene;
  CHECK_FALSE(companion["numerics"].contains("auto"));
  CHECK(companion["numerics"]["tau"] == scene.numerics.tau);
  CHECK(companion["numerics"]["slip_correction"] == true);
}

TEST_CASE("numbers of nodes without a common divisor, and cells that would be too small, have no companions") {
  const Companions odd = of_capsule({"/domain/nodes=[129,65]", R"(/domain/size=["51.6 um","26 um"])"});
  CHECK(odd.runs.empty());
  CHECK(odd.why_none.find("129 x 65") != std::string::npos);
  const Companions coarse = of_capsule({"/domain/nodes=[32,16]", "/cell_types/capsule/segments=16"});
  CHECK(coarse.runs.empty());
  CHECK(coarse.why_none.find("radius") != std::string::npos);
}

TEST_CASE(
    "of a run that takes a twentieth of a second companions are coarser, for starting them takes a part of its time") {
  const scene::Scene scene = plan::read_scene(std::string(ROULEAU_PHYSICS_SCENES) + "/capsule.json");
  const Companions quick = choose_companions(scene, {.run_s = 0.05}),
                   patient = choose_companions(scene, {.run_s = long_run_s});
  CHECK(quick.refinement > patient.refinement);
  CHECK(quick.expected_share < patient.expected_share);
  // So do outputs, of which companions have as many.
  CHECK(choose_companions(scene, {.run_s = long_run_s, .outputs_s = 0.06 * long_run_s}).refinement >
        patient.refinement);
}
