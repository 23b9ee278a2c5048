// What "numerics": "auto" chooses: pins hold, errors that are asked for decide, limits of the plan prevail.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "json/document.hpp"
#include "plan/plan_report.hpp"
#include "plan/read_scene.hpp"
#include "scratch_folder.hpp"

using namespace rouleau::plan;
using namespace rouleau::plugin;
using namespace rouleau::scene;
using Catch::Matchers::Contains;

namespace {

const std::string auto_scenes = ROULEAU_PHYSICS_SCENES;

Catalog shipped_plugins(const Scene& /*unused*/) {
  return Catalog(std::vector<std::filesystem::path>{ROULEAU_PLUGINS});
}

ReadScene chosen(const std::vector<std::string>& overrides, const std::string& scene = "/auto-capsule.json") {
  return read_within_limits(auto_scenes + scene, overrides, shipped_plugins);
}
Scene chosen_scene(const std::vector<std::string>& overrides) { return chosen(overrides).scene; }

std::string target_of(double error, const std::string& of) {
  return R"(/numerics={"auto": {"error": )" + std::to_string(error) + R"(, "of": ")" + of +
         R"("}, "precision": "f32"})";
}

double estimated_cost(const Scene& scene) {
  const Catalog catalog = shipped_plugins(scene);
  return estimate(make_plan(scene, catalog)).wall_s;
}

}  // namespace

TEST_CASE("a smaller target error costs more, and the error that is expected is below it") {
  double before = 0;
  for (const char* target : {"0.05", "0.02", "0.01", "0.005", "0.002"}) {
    const auto [scene, choice] = chosen({std::string("/numerics/auto/error=") + target});
    REQUIRE(choice);
    CHECK(choice->expected.total() <= std::stod(target));
    CHECK(choice->doubt.empty());
    CHECK(estimated_cost(scene) >= 0.995 * before);  // density factors have three digits
    before = estimated_cost(scene);
  }
  CHECK(estimated_cost(chosen_scene({"/numerics/auto/error=0.002"})) >
        2 * estimated_cost(chosen_scene({"/numerics/auto/error=0.05"})));
}

TEST_CASE(
    "a smaller target is not cheaper, whichever stage has a density factor of its own, and its lattice is not "
    "coarser",
    "[optimised]") {
  const std::string demo = "/../../../scenes/four-cells-shear.json", at_rest = "/stages/0/start=impulsive";
  struct Case {
    std::string scene;
    std::vector<std::string> overrides;
  };
  const std::vector<Case> cases{
      {"/auto-capsule.json", {at_rest}},
      {"/auto-capsule.json", {at_rest, "/stages/0/density_factor=200"}},
      {"/auto-capsule.json", {at_rest, "/stages/0/density_factor=3000"}},
      {"/auto-capsule.json",
       {R"(/stages/-={"name": "slow", "shear_rate": "10 1/s", "strain": 5, "density_factor": 500})"}},
      {demo, {}},
      {demo, {"/stages/1/density_factor=1000"}},
      {demo, {"/stages/1/density_factor=6000"}},
  };
  for (const Case& c : cases) {
    for (const char* of : {"steady", "motion"}) {
      double cost = 1e300;
      int rows = 1 << 30;
      for (const char* target : {"0.005", "0.01", "0.02", "0.05", "0.1"}) {
        std::vector<std::string> overrides{std::string(R"(/numerics={"auto": {"error": )") + target + R"(, "of": ")" +
                                           of + "\"}}"};
        overrides.insert(overrides.end(), c.overrides.begin(), c.overrides.end());
        if (c.scene == demo) {
          overrides.emplace_back(
              R"(/domain={"size": ["50.176 um", "25.088 um"], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}})");
        }
        const Scene scene = chosen(overrides, c.scene).scene;
        INFO(c.scene << " " << (c.overrides.empty() ? "" : c.overrides.back()) << " " << of << " " << target);
        CHECK(estimated_cost(scene) <= cost * 1.02);  // factors are rounded to three digits
        CHECK(scene.domain.nodes[1] <= rows);
        cost = estimated_cost(scene);
        rows = scene.domain.nodes[1];
      }
    }
  }
}

TEST_CASE("a factor of a stage's own that takes the target leaves half of it to the lattice, and that is said") {
  const auto [scene, choice] = chosen({R"(/numerics={"auto": {"error": 0.01}})", "/stages/0/density_factor=6250"});
  REQUIRE(choice);
  // Of a motion, and what the membrane makes of the lattice's fluid.
  CHECK(choice->expected.inertia > 0.024 * 1.6667);
  CHECK(choice->expected.inertia < 1.05 * 0.024 * 1.6667);
  CHECK(choice->expected.resolution <= 0.005);
  CHECK(choice->expected.resolution > 0.003);
  CHECK_THAT(choice->doubt, Contains("more than the target of 1 %"));
}

TEST_CASE("each stage gets the density factor that its own error leaves room for") {
  const std::string stages = R"(/stages=[{"name": "rest", "duration": "0.2 s"},
      {"name": "fast", "shear_rate": "40 1/s", "strain": 10, "start": "developed"},
      {"name": "slow", "shear_rate": "4 1/s", "strain": 10, "start": "developed"},
      {"name": "late", "shear_rate": "4 1/s", "strain": 10},
      {"name": "stop", "duration": "0.2 s"}])",
                    motion = "/numerics={\"auto\": {\"error\": 0.02}}";
  const auto [scene, choice] = chosen({stages, motion});
  const auto factor = [](const Scene& of, std::size_t stage) { return of.stages[stage].density_factor; };
  CHECK(choice->expected.total() <= 0.02);
  CHECK(choice->doubt.empty());
  // The Reynolds number of the fast stage and of the slow one is nearly the same; a start at rest takes from that of
  // the late one.
  CHECK(factor(scene, 2) == Approx(10 * factor(scene, 1)).epsilon(0.1));
  CHECK(factor(scene, 3) < factor(scene, 2) / 1.25);
  CHECK(factor(scene, 0) > factor(scene, 2));
  CHECK(factor(scene, 4) == Approx(std::min({factor(scene, 1), factor(scene, 2), factor(scene, 3)})).epsilon(0.01));
  double least = 1e300;
  for (std::size_t i = 0; i < 5; ++i) least = std::min(least, factor(scene, i));
  CHECK(scene.numerics.density_factor == least);

  const auto [pinned, of_pinned] = chosen({stages, motion, "/numerics/density_factor=100"});
  for (std::size_t i = 0; i < 5; ++i) CHECK(factor(pinned, i) == 100);
  CHECK_FALSE(of_pinned->has("/numerics/density_factor"));

  const Scene given = chosen({stages, motion, "/stages/2/density_factor=100"}).scene;
  CHECK(factor(given, 2) == 100);
  CHECK(factor(given, 1) > 200);
}

TEST_CASE("cells that drift or meet have no steady state, and the fluid's density counts as for a motion") {
  const std::string steady = R"(/numerics={"auto": {"error": 0.02, "of": "steady"}})";
  const auto inertia = [&](const std::string& cells) {
    const auto [scene, choice] = chosen({steady, "/cells=" + cells});
    const double reynolds = 1e3 * 20 * 4e-6 * 4e-6 / 1.2e-3 * scene.numerics.density_factor;
    CHECK(choice->expected.total() <= 0.02);
    return std::pair(choice->expected.inertia, 0.024 * reynolds);
  };
  const auto [of_settled, as_motion] = inertia(R"([{"type": "capsule", "at": ["20 um", "12.8 um"]}])");
  CHECK(of_settled < as_motion / 3);
  for (const char* cells :
       {R"([{"type": "capsule", "at": ["20 um", "9 um"]}])",
        R"([{"type": "capsule", "at": ["10 um", "12.8 um"]}, {"type": "capsule", "at": ["30 um", "12.8 um"]}])"}) {
    const auto [of_moving, wanted] = inertia(cells);
    CHECK(of_moving > 0.995 * wanted);
    CHECK(of_moving < 1.05 * wanted);
  }
}

TEST_CASE("a limit of one stage does not bound another's density factor") {
  // Cells that attract each other strongly bound the factor at rest; a slow flow is bound by its error or by the same
  // limit.
  const std::string stages = R"(/stages=[{"name": "fast", "shear_rate": "40 1/s", "strain": 10, "start": "developed"},
      {"name": "slow", "shear_rate": "0.01 1/s", "strain": 1, "start": "developed"}])";
  const std::vector<std::string> stiff{stages, "/cell_types/capsule/membrane/0/parameters/shear_modulus=1.92e-4",
                                       "/numerics={\"auto\": {\"error\": 0.02}}"};
  const ReadScene read = chosen(stiff);
  const Catalog catalog = shipped_plugins(read.scene);
  const Plan plan = make_plan(read.scene, catalog, read.numerics_choice);
  for (const Limit& limit : find_limits(plan)) {
    INFO(limit.name);
    if (limit.remedied_by == RemediedBy::density_factor) CHECK(limit.margin >= 1);
  }
  // The slow stage is at a limit of the stiffness, and the fast one is below it.
  CHECK(read.scene.stages[1].density_factor > 1.25 * read.scene.stages[0].density_factor);
  CHECK(read.scene.stages[1].density_factor < 1000 * read.scene.stages[0].density_factor);
}

TEST_CASE("where a developed start is cheaper for the same target, the choice says by how much") {
  const auto why_factor = [](const ReadScene& read) {
    for (const ChosenValue& value : read.numerics_choice->values)
      if (value.pointer == "/numerics/density_factor") return value.why;
    return std::string();
  };
  const std::vector<std::string> motion{"/numerics/auto/of=motion"},
      at_rest{"/numerics/auto/of=motion", "/stages/0/start=impulsive"};
  const ReadScene late = chosen(at_rest), developed = chosen(motion);
  const std::string why = why_factor(late), words = "(\"start\": \"developed\") the run would take ";
  INFO(why);
  REQUIRE_THAT(why, Contains(words) && Contains(" times as long"));
  const double said = std::stod(why.substr(why.find(words) + words.size()));
  CHECK(said == Approx(estimated_cost(developed.scene) / estimated_cost(late.scene)).epsilon(0.1));
  CHECK_THAT(why_factor(developed), !Contains("developed"));
}

TEST_CASE("what a scene gives is not chosen") {
  const auto [scene, choice] = chosen({"/numerics/tau=0.8", "/numerics/density_factor=1000", "/domain/nodes=[160,80]",
                                       "/cell_types/capsule/segments=90", "/numerics/slip_correction=false"});
  CHECK(scene.numerics.tau == 0.8);
  CHECK(scene.numerics.density_factor == 1000);
  CHECK(scene.domain.nodes == std::vector<int>{160, 80});
  CHECK(scene.cell_types[0].segments == 90);
  CHECK_FALSE(scene.numerics.slip_correction);
  CHECK(scene.numerics.area_correction);
  CHECK(scene.numerics.coupling == "auto");
  CHECK(choice->values.size() == 2);
  // The plain scheme at 12.5 spacings a radius is further than 1 % from the truth, and says so.
  CHECK_THAT(choice->doubt, Contains("more than the target of 1 %"));
}

TEST_CASE("a lattice that leaves next to nothing of the target is told what it costs") {
  const std::string target = "/numerics={\"auto\": {\"error\": 0.01}}";
  const ReadScene open = chosen({target}, "/auto-biconcave.json");
  CHECK(open.numerics_choice->doubt.empty());
  const ReadScene named = chosen({target, "/domain/nodes=[208,104]"}, "/auto-biconcave.json");
  CHECK_THAT(named.numerics_choice->doubt, Contains("leave domain.nodes out, or allow a larger error"));
  CHECK(estimated_cost(named.scene) > 2 * estimated_cost(open.scene));
}

TEST_CASE("a slip correction between cells wants an area correction, which auto chooses") {
  const std::string scene = std::string(ROULEAU_SCENES) + "/four-cells-shear.json";
  const auto warned = [&](const std::vector<std::string>& overrides) {
    const auto [read, choice] = read_within_limits(scene, overrides, shipped_plugins);
    REQUIRE(read.numerics.slip_correction);
    const Catalog catalog = shipped_plugins(read);
    const std::vector<std::string> warnings = make_report(make_plan(read, catalog, choice)).warnings;
    return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.starts_with("numerics.slip_correction with attracting cells");
    });
  };
  CHECK(warned({"/numerics/slip_correction=true"}));
  CHECK_FALSE(warned({"/numerics/slip_correction=true", "/numerics/area_correction=true"}));
  CHECK_FALSE(warned({"/numerics={\"auto\": {\"error\": 0.05}}"}));
}

TEST_CASE("the chosen scene read again is the same scene") {
  const Scene scene = chosen_scene({});
  const auto [again, choice] = chosen({"/numerics=" + scene.document->root()["numerics"].dump(),
                                       "/domain=" + scene.document->root()["domain"].dump(),
                                       "/cell_types=" + scene.document->root()["cell_types"].dump()});
  CHECK(again.document->root() == scene.document->root());
  CHECK(choice->values.empty());
}

TEST_CASE("limits of the plan bound the choice") {
  const auto worst_margin = [](const Scene& scene) {
    const Catalog catalog = shipped_plugins(scene);
    double least = 1e300;
    for (const Limit& limit : find_limits(make_plan(scene, catalog))) {
      if (limit.remedied_by != RemediedBy::nothing) least = std::min(least, limit.margin);
    }
    return least;
  };
  // A membrane a thousand times stiffer.
  const std::vector<std::string> stiff{"/cell_types/capsule/membrane/0/parameters/shear_modulus=1.92e-3"};
  CHECK(chosen_scene(stiff).numerics.density_factor < chosen_scene({}).numerics.density_factor / 3);
  CHECK(worst_margin(chosen_scene(stiff)) >= 1);
  // Membranes that meet at a gap of half a micrometre want two spacings there.
  const std::vector<std::string> sticky{
      R"(/interactions=[{"between": ["capsule", "capsule"], "model": "morse", "parameters": {"depth": "5.2e-8 J/m2", )"
      R"("decay": "3.84 1/um", "zero_force_distance": "0.2 um", "cutoff": "2 um"}}])"};
  const Scene attracted = chosen_scene(sticky);
  CHECK(attracted.domain.size.x() / attracted.domain.nodes[0] <= 0.1e-6 * (1 + 1e-9));
  CHECK(attracted.numerics.slip_correction);
  const std::string deep = "/interactions/0/parameters/depth=\"1.3e-6 J/m2\"";
  CHECK_FALSE(chosen_scene({sticky[0], deep}).numerics.slip_correction);
  // In the plain scheme cells that pass each other are off by more than one alone.
  const std::string second = R"(/cells/-={"type": "capsule", "at": ["5 um", "5 um"]})",
                    wanted = target_of(0.05, "motion"), plain = "/numerics/slip_correction=false";
  const auto lattice = [&](const std::vector<std::string>& changes) {
    const auto [scene, choice] = chosen(changes);
    CHECK(choice->expected.total() <= 0.05);
    return scene.domain.nodes[1];
  };
  CHECK(lattice({wanted, plain, second}) > lattice({wanted, plain}));
}

TEST_CASE("auto needs a lattice, and without it a scene needs its own") {
  CHECK_THROWS_WITH(chosen_scene({"/domain/size=[\"50 um\", \"17.3456789123 um\"]"}),
                    Contains("no lattice with the same spacing along both can be chosen"));
  CHECK_THROWS_WITH(chosen_scene({"/numerics={}"}), Contains("\"nodes\" is missing"));
}

TEST_CASE("a flow without cells keeps its own inertia") {
  const Scene scene = chosen_scene({"/cells=[]"});
  CHECK(scene.numerics.density_factor == 1);
  CHECK(scene.domain.nodes[1] >= 16);
}

TEST_CASE("a mean speed of the walls counts among what the Mach number bounds") {
  // Without any shear, and beside a shear that the error alone would allow larger steps for.
  const auto mach = [](const std::string& stage) {
    const Scene scene = chosen_scene({"/stages=[" + stage + "]", "/output/cells={\"seconds\": 0.1}"});
    return make_stage_setting(scene, 0).fastest_wall() * std::sqrt(3.0);
  };
  CHECK(mach(R"({"name": "carry", "duration": "1 s", "walls": {"lower": "5 mm/s", "upper": "5 mm/s"}})") < 0.2);
  CHECK(mach(R"({"name": "carry", "duration": "1 s", "start": "developed",
                 "walls": {"lower": "20 mm/s", "upper": "20.5 mm/s"}})") < 0.2);
}

namespace {

const std::string in_space = "/auto-capsule-3d.json";

std::string domain_of(const std::string& size, const std::string& walls) {
  return "/domain={\"size\": " + size + ", " + walls + "}";
}
const std::string tube = R"("walls": {"tube": {"radius": "8 um"}})";
const std::vector<std::string> in_tube{
    domain_of(R"(["24 um", "18 um", "18 um"])", tube), R"(/cells/0/at=["12 um", "9 um", "9 um"])",
    R"(/stages=[{"name": "flow", "pressure_gradient": "1e5 Pa/m", "duration": "0.1 s"}])",
    R"(/output/cells={"seconds": "10 ms"})"};

}  // namespace

TEST_CASE("in three dimensions a smaller target costs more on a lattice that is not coarser, and its error is below it",
          "[optimised]") {
  const std::string shape = "/cell_types/capsule/shape=", wide = R"(["24 um", "18 um", "12 um"])",
                    walls = R"("y": {"lower": {"wall": {}}, "upper": {"wall": {}}})",
                    inside = R"(/cells/0/at=["12 um", "9 um", "6 um"])";
  const std::vector<std::vector<std::string>> cases{
      {},
      {"/stages/0/start=impulsive"},
      {"/cell_types/capsule/interior_viscosity=\"6 cP\""},
      {shape + R"({"biconcave": {"radius": "3.91 um"}})"},
      {shape + R"({"ellipsoid": {"semi_axes": ["4 um", "3 um", "2.5 um"]}})", domain_of(wide, walls), inside},
      {R"(/interactions=[{"between": ["capsule", "capsule"], "model": "morse", )"
       R"("parameters": {"depth": "1e-8 J/m2"}}])"},
      in_tube};
  for (const auto& changes : cases) {
    for (const char* of : {"steady", "motion"}) {
      double cost = 0;
      int rows = 0;
      for (const double target : {0.1, 0.05, 0.03, 0.02}) {
        std::vector<std::string> overrides{target_of(target, of)};
        overrides.insert(overrides.end(), changes.begin(), changes.end());
        const auto [scene, choice] = chosen(overrides, in_space);
        INFO((changes.empty() ? "" : changes.front()) << " " << of << " " << target);
        CHECK(choice->expected.total() <= target);
        CHECK(choice->doubt.empty());
        CHECK(estimated_cost(scene) >= cost * 0.98);  // factors are rounded to three digits
        CHECK(scene.domain.nodes[1] >= rows);
        CHECK(scene.numerics.area_correction);
        CHECK(scene.numerics.slip_correction);
        CHECK(scene.numerics.kernel == "sharp6");
        cost = estimated_cost(scene);
        rows = scene.domain.nodes[1];
      }
    }
  }
}

TEST_CASE("a lattice of three dimensions has the ratios of its domain, and nodes that a scene gives stay") {
  const std::string walls = R"("y": {"lower": {"wall": {}}, "upper": {"wall": {}}})";
  const std::string sides = domain_of(R"(["24 um", "12 um", "18 um"])", walls),
                    inside = R"(/cells/0/at=["12 um", "6 um", "9 um"])";
  const std::vector<int> chosen_nodes = chosen({sides, inside}, in_space).scene.domain.nodes;
  CHECK(chosen_nodes[0] == 2 * chosen_nodes[1]);
  CHECK(2 * chosen_nodes[2] == 3 * chosen_nodes[1]);
  const std::string more = R"("nodes": [96, 48, 72], )";
  const auto [scene, choice] = chosen({domain_of(R"(["24 um", "12 um", "18 um"])", more + walls), inside,
                                       "/numerics/tau=1.5", "/cell_types/capsule/triangles=2880"},
                                      in_space);
  CHECK(scene.domain.nodes == std::vector<int>{96, 48, 72});
  CHECK(scene.numerics.tau == 1.5);
  CHECK(scene.cell_types[0].triangles == 2880);
  for (const ChosenValue& value : choice->values) CHECK(value.pointer.starts_with("/numerics/"));
  const auto again =
      chosen({"/numerics=" + scene.document->root()["numerics"].dump(),
              "/domain=" + scene.document->root()["domain"].dump(), inside, "/cell_types/capsule/triangles=2880"},
             in_space);
  CHECK(again.scene.document->root() == scene.document->root());
  CHECK(again.numerics_choice->values.empty());
}

TEST_CASE("without cells a lattice of three dimensions resolves what lies between its walls") {
  const std::string thin = R"(["2.5 um", "20 um", "20 um"])",
                    flow = R"(/stages=[{"name": "flow", "pressure_gradient": "1e4 Pa/m", "duration": "0.4 s"}])",
                    output = R"(/output/cells={"seconds": "0.1 s"})",
                    wall = R"({"lower": {"wall": {}}, "upper": {"wall": {}}})";
  const auto of = [&](const std::string& walls, double target) {
    const ReadScene read =
        chosen({target_of(target, "motion"), domain_of(thin, walls), "/cells=[]", flow, output}, in_space);
    CHECK(read.numerics_choice->expected.total() <= target);
    CHECK(read.numerics_choice->doubt.empty());
    CHECK(read.scene.numerics.density_factor == 1);
    return read.scene.domain.nodes;
  };
  CHECK(of("\"y\": " + wall + ", \"z\": " + wall, 0.01) == std::vector<int>{4, 32, 32});
  // A tube's radius has eight spacings at least, more where its flow rate asks for them (1 over the square of the
  // radius).
  const std::string round = R"("walls": {"tube": {"radius": "10 um"}})";
  CHECK(of(round, 0.05)[1] >= 16);
  CHECK(of(round, 0.005)[1] >= 2 * std::sqrt(1 / 0.005));
}

TEST_CASE("auto leaves a surface from a file its triangles") {
  const rouleau::test::ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "cube.off";
  std::ofstream(file) << "OFF\n8 12 0\n-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n"
                      << "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 7 6\n3 1 2 6\n3 1 6 5\n"
                      << "3 0 4 7\n3 0 7 3\n";
  const std::string mesh =
      R"(/cell_types/capsule/shape={"mesh": {"file": ")" + file.string() + R"(", "unit": "3 um"}})";
  const auto [scene, choice] = chosen({mesh}, in_space);
  CHECK(scene.cell_types[0].triangles == 0);
  CHECK(choice->expected.total() <= 0.05);
}

TEST_CASE("limits of the plan bound the choice in three dimensions, where stiff cells step semi-implicitly") {
  const Scene stiff = chosen({"/cell_types/capsule/membrane/0/parameters/shear_modulus=2.4e-3"}, in_space).scene;
  const Catalog catalog = shipped_plugins(stiff);
  const Plan plan = make_plan(stiff, catalog);
  CHECK(plan.semi_implicit);
  for (const Limit& limit : find_limits(plan))
    if (limit.remedied_by != RemediedBy::nothing) CHECK(limit.margin >= 1);
}

TEST_CASE(
    "one thin cell that is placed along the flow leaves that position the later, the denser the fluid, and gets a "
    "lighter one") {
  const auto inertia = [](const std::string& angle) {
    const ReadScene read =
        chosen({"/cells/0/angle=\"" + angle + "\"", R"(/numerics={"auto": {"error": 0.03}})"}, "/auto-biconcave.json");
    CHECK(read.numerics_choice->expected.total() <= 0.03);
    return read.numerics_choice->expected.inertia / read.scene.numerics.density_factor;
  };
  const double across = inertia("90 deg");
  for (const char* along : {"0 deg", "20 deg", "180 deg", "-20 deg"}) CHECK(inertia(along) > 3 * across);
  for (const char* other : {"45 deg", "135 deg"}) CHECK(inertia(other) == Approx(across).epsilon(0.01));
}

TEST_CASE(
    "a tenth of the target is the most by which forces that are held may delay what cells do, and steps are not "
    "shorter") {
  const std::string stiff = R"(/cell_types/capsule/membrane/0={"model": "skalak", "parameters": )"
                            R"({"shear_modulus": "5e-6 N/m", "area_dilation": 200}})";
  for (const double target : {0.05, 0.02, 0.01}) {
    const ReadScene read = chosen({target_of(target, "steady"), stiff}, in_space);
    INFO(target);
    const Catalog catalog = shipped_plugins(read.scene);
    const Plan plan = make_plan(read.scene, catalog, read.numerics_choice);
    double strain = 0;
    for (const Limit& limit : find_limits(plan)) {
      if (limit.name.starts_with("strain during which")) {
        strain = limit.value;
        CHECK(limit.limit == Approx(std::min(target, 0.15 / 6)));
      }
    }
    CHECK(strain <= std::min(target, 0.15 / 6));
    CHECK(strain > 0.85 * std::min(target, 0.15 / 6));
  }
}

TEST_CASE("the slip of a stiff cell that turns over is smoothed no further than the target allows") {
  for (const double stiffness : {1e-4, 6e-4}) {
    const std::string stiff =
        "/cell_types/rbc/membrane/0/parameters/shear_modulus=\"" + std::to_string(stiffness) + " N/m\"";
    const ReadScene read = chosen({R"(/numerics={"auto": {"error": 0.03}})", stiff}, "/auto-biconcave.json");
    const Catalog catalog = shipped_plugins(read.scene);
    double smoothing = 0;
    for (const Limit& limit : find_limits(make_plan(read.scene, catalog, read.numerics_choice))) {
      if (limit.name.starts_with("smoothing of the slip")) smoothing = limit.value;
    }
    INFO(stiffness);
    CHECK(smoothing > 0.01);
    CHECK(smoothing <= 0.03);
  }
}

TEST_CASE("without a lattice that fits three sides auto says what to write, and nothing else is wrong") {
  const auto message = [](const std::string& size) {
    try {
      chosen({"/domain/size=" + size}, in_space);
    } catch (const rouleau::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char* size : {R"(["24 um", "24 um", "17.3456789123 um"])", R"(["24.01 um", "24 um", "24 um"])",
                           R"(["24 um", "24.01 um", "24 um"])"}) {
    CHECK_THAT(message(size), Contains("/domain/size") && Contains("along all three") && Contains("or give nodes") &&
                                  !Contains("sphere"));
  }
}

TEST_CASE("cells at random in a tube are no reason to refuse numerics that are left open", "[optimised]") {
  const std::string tube = std::string(ROULEAU_SCENES) + "/../tests/physics/scenes/auto-capsule-3d.json";
  const std::vector<std::string> changes{
      R"(/domain={"size": ["20 um", "10 um", "10 um"], "walls": {"tube": {"axis": "x", "radius": "5 um"}}})",
      R"(/cells=[{"type": "capsule", "random": {"count": 3, "seed": 1}}])",
      R"(/stages=[{"name": "flow", "duration": "1 ms", "mean_velocity": "1 mm/s", "start": "developed"}])",
      "/output={}",
      R"(/cell_types/capsule/shape={"sphere": {"radius": "2 um"}})",
      R"(/numerics={"auto": {"error": 0.1}})"};
  const auto [scene, choice] = read_within_limits(tube, changes, shipped_plugins);
  REQUIRE(choice);
  CHECK(scene.cells.size() == 3);
  // Also those that where cells lie decides.
  const Catalog catalog = shipped_plugins(scene);
  for (const Limit& limit : find_limits(make_plan(scene, catalog, choice))) {
    INFO(limit.name);
    if (limit.remedied_by == RemediedBy::density_factor) CHECK(limit.margin >= 1);
  }
}

TEST_CASE("with convective inertia nothing of a denser fluid dies out on the way to a steady state") {
  const std::string steady = R"(/numerics={"auto": {"error": 0.02, "of": "steady"}})";
  const auto [without, of_linear] = chosen({steady});
  const auto [scene, choice] = chosen({steady, "/fluid/inertia=true"});
  const double reynolds = 1e3 * 20 * 4e-6 * 4e-6 / 1.2e-3 * scene.numerics.density_factor;
  CHECK(choice->expected.inertia > 0.995 * 0.024 * reynolds);
  CHECK(scene.numerics.density_factor < without.numerics.density_factor / 1.5);
}

TEST_CASE("what is next to nothing of an error is nothing") {
  const auto [scene, choice] =
      chosen({R"(/numerics={"auto": {"error": 0.02, "of": "steady"}})", "/stages/0/strain=4000"});
  CHECK((choice->expected.inertia == 0 || choice->expected.inertia >= 1e-6));
}

TEST_CASE(
    "where a pin leaves no room for the target no lattice is taken that is much finer than what is left deserves") {
  // At this factor the fluid's inertia alone is 4.8 % of a motion.
  const std::string motion = R"(/numerics={"auto": {"error": 0.01}, "density_factor": 7500})";
  const auto [scene, choice] = chosen({motion});
  REQUIRE(choice);
  CHECK_THAT(choice->doubt, Contains("more than the target of 1 %") && Contains("numerics.density_factor"));
  const double pinned = choice->expected.total() - choice->expected.resolution;
  CHECK(pinned > 0.045);
  CHECK(choice->expected.resolution < 0.1 * choice->expected.total());
  CHECK(choice->expected.resolution > 0.02 * choice->expected.total());
  CHECK(4e-6 / scene.domain.size.x() * scene.domain.nodes[0] < 30);  // spacings a radius, of at most 80
}
