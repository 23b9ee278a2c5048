#include <catch2/catch.hpp>
#include <filesystem>

#include "json/document.hpp"
#include "scene/read_scene.hpp"
#include "scene/scene.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using namespace rouleau::json;
using namespace rouleau::scene;
using Catch::Matchers::Contains;

namespace {

const std::filesystem::path contract_scene = std::filesystem::path(ROULEAU_SCENES) / "four-cells-shear.json";

/// Conversions multiply a handful of factors, each rounded once.
Approx about(double value) { return Approx(value).epsilon(16 * std::numeric_limits<double>::epsilon()).scale(0); }

Scene read(const std::filesystem::path& file, const std::vector<std::string>& overrides = {}) {
  return read_scene(std::make_shared<const Document>(read_document(file, overrides)));
}

std::string message_of(const std::vector<std::string>& overrides) {
  try {
    (void)read(contract_scene, overrides);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the contract's scene comes out in SI units") {
  const auto scene = read(contract_scene);
  CHECK_FALSE(scene.title.empty());
  CHECK(scene.domain.size.x() == about(50.176e-6));
  CHECK(scene.domain.size.y() == about(25.088e-6));
  CHECK(scene.domain.nodes == std::vector<int>{256, 128});
  CHECK_FALSE(scene.domain.periodic[1]);
  CHECK(scene.fluid.density == about(1000));
  CHECK(scene.fluid.viscosity == about(1.2e-3));
  CHECK_FALSE(scene.fluid.inertia);
  CHECK(scene.fluid.body_force == Vector());
  CHECK(scene.fluid.collision.model == "trt");
  CHECK(scene.fluid.collision.parameters["magic"] == 0.1875);
  CHECK(scene.fluid.collision.pointer == "/fluid/collision");
  CHECK(scene.numerics.tau == 1.0);
  CHECK(scene.numerics.density_factor == 3000);
  CHECK(scene.numerics.precision == Precision::f64);

  REQUIRE(scene.cell_types.size() == 1);
  const auto& type = scene.cell_types[0];
  CHECK(type.name == "rbc");
  CHECK(std::get<Biconcave>(type.shape).radius == about(3.91e-6));
  CHECK(type.segments == 100);
  CHECK(type.interior_viscosity == about(6e-3));
  REQUIRE(type.membrane.size() == 2);
  CHECK(type.membrane[1].model == "bending");
  CHECK(type.membrane[1].pointer == "/cell_types/rbc/membrane/1");
  CHECK(type.membrane[1].parameters["modulus"] == "3.6e-12 dyn cm");

  REQUIRE(scene.cells.size() == 4);
  CHECK(scene.cells[0].center.x() == about(25.088e-6 - 1.5 * 3.52e-6));
  CHECK(scene.cells[3].center.x() == about(25.088e-6 + 1.5 * 3.52e-6));
  CHECK(scene.cells[2].center.y() == about(12.544e-6));
  CHECK(scene.cells[2].angle == about(1.5707963267948966));
  CHECK(scene.cells[2].pointer == "/cells/0");

  REQUIRE(scene.interactions.size() == 1);
  CHECK(scene.interactions[0].between == std::array<int, 2>{0, 0});
  CHECK(scene.interactions[0].potential.model == "morse");

  REQUIRE(scene.stages.size() == 2);
  CHECK(scene.stages[0].until_at_rest);
  CHECK(scene.stages[0].duration.value() == 7.0);
  CHECK(scene.stages[0].density_factor == 13000);
  CHECK(scene.stages[0].shear_rate == 0.0);
  CHECK(scene.stages[1].density_factor == 3000);
  CHECK(scene.stages[1].shear_rate == 20.0);
  CHECK(scene.stages[1].strain.value() == 15.0);
  CHECK_FALSE(scene.stages[1].duration);
  CHECK(scene.stages[1].start == WallStart::impulsive);
  CHECK(scene.stages[1].pointer == "/stages/1");

  CHECK(scene.output.cells.strain.value() == 0.25);
  CHECK(scene.output.fields.strain.value() == 1.0);
  CHECK(scene.output.quantities == std::vector<std::string>{"velocity", "viscosity"});
  CHECK(scene.output.checkpoint_seconds.value() == 600.0);
  CHECK(scene.output.aggregate_gap == about(0.75e-6));
  CHECK(scene.at_rest.displacement == about(0.01e-6));
  CHECK(scene.at_rest.window == about(0.2));
}

TEST_CASE("what a scene leaves out has the documented default") {
  const rouleau::test::ScratchFolder folder;
  const auto scene = read(folder.write("least.json", R"({"rouleau": 1,
    "domain": {"size": [8e-6, 4e-6], "nodes": [8, 4], "y": "periodic"},
    "fluid": {"density": 1000, "viscosity": 1e-3},
    "cell_types": {"drop": {"shape": {"circle": {"radius": "1 um"}}, "segments": 8, "membrane": []}},
    "stages": [{"name": "rest", "duration": 1e-3}]})"));
  CHECK(scene.domain.periodic[1]);
  CHECK(scene.fluid.collision.model == "trt");
  CHECK(scene.fluid.collision.parameters == nlohmann::json::object());
  CHECK(scene.numerics.density_factor == 1.0);
  CHECK(scene.stages[0].density_factor == 1.0);
  CHECK(scene.cell_types[0].interior_viscosity == 1e-3);
  CHECK(std::get<Circle>(scene.cell_types[0].shape).prestretch == 1.0);
  CHECK(scene.cells.empty());
  CHECK(scene.output.cells.never());
  CHECK(scene.output.fields.never());
  CHECK(scene.output.checkpoint_seconds == 600.0);
  CHECK(scene.checks.every_steps == 200);
  CHECK(scene.checks.stretch == 5);
  CHECK(scene.checks.energy_growth == 0.01);
  CHECK(scene.place("/fluid/density").line == 3);
}

TEST_CASE("everything that a scene may say is read") {
  const std::string drop =
      R"({"shape": {"circle": {"radius": "2 um", "prestretch": 1.05}}, "segments": 64, "membrane": []})";
  const std::string egg = R"({"shape": {"ellipse": {"semi_axes": ["2 um", "1 um"]}}, "segments": 64, "membrane": []})";
  const auto scene = read(
      contract_scene,
      {"/fluid/body_force=[\"10 N/m3\", 0]", "/numerics/precision=f32", "/numerics/tau=0.8", "/cell_types/drop=" + drop,
       "/cell_types/egg=" + egg, "/cells/-={\"type\": \"drop\", \"at\": [\"1 um\", \"2 um\"], \"angle\": \"45 deg\"}",
       "/cells/-={\"type\": \"egg\", \"list\": [{\"at\": [1e-6, 2e-6]}, {\"at\": [3e-6, 4e-6], \"angle\": 1}]}",
       "/cells/0/row/axis=y", "/interactions/0/between/1=egg", "/stages/1/start=developed",
       "/stages/1/pressure_gradient=1 kPa/m", "/stages/1/duration=0.5 s", "/output/cells/seconds=10 ms",
       "/output/aggregate_gap=1 um", "/at_rest={\"displacement\": \"0.02 um\", \"window\": \"0.1 s\"}",
       "/checks={\"mach\": 0.1, \"node_step\": 0.2, \"area_drift\": 0.01, \"stretch\": 3, "
       "\"energy_growth\": 0.001, \"every_steps\": 50}",
       "/plugin_dirs=[\"mine\"]"});
  CHECK(scene.fluid.body_force == Vector(10, 0));
  CHECK(scene.numerics.precision == Precision::f32);
  CHECK(scene.numerics.tau == 0.8);
  REQUIRE(scene.cell_types.size() == 3);
  CHECK(std::get<Circle>(scene.cell_types[0].shape).prestretch == 1.05);
  CHECK(std::get<Ellipse>(scene.cell_types[1].shape).semi_axes.x() == about(2e-6));
  REQUIRE(scene.cells.size() == 7);
  CHECK(scene.cells[0].center.x() == scene.cells[3].center.x());
  CHECK(scene.cells[3].center.y() - scene.cells[0].center.y() == Approx(3 * 3.52e-6).epsilon(1e-12));
  CHECK(scene.cells[4].type == 0);
  CHECK(scene.cells[4].angle == about(0.78539816339744828));
  CHECK(scene.cells[6].type == 1);
  CHECK(scene.cells[6].center == Vector(3e-6, 4e-6));
  CHECK(scene.cells[6].angle == 1.0);
  CHECK(scene.cells[6].pointer == "/cells/2/list/1");
  CHECK(scene.interactions[0].between == std::array<int, 2>{2, 1});
  CHECK(scene.stages[1].start == WallStart::developed);
  CHECK(scene.stages[1].pressure_gradient == Vector(1000, 0));
  CHECK(scene.stages[1].duration.value() == 0.5);
  CHECK(scene.output.cells.seconds.value() == about(0.01));
  CHECK(scene.output.aggregate_gap == about(1e-6));
  CHECK(scene.at_rest.displacement == about(0.02e-6));
  CHECK(scene.checks.every_steps == 50);
  CHECK(scene.checks.stretch == 3);
  CHECK(scene.checks.energy_growth == 0.001);
  const auto beside = std::filesystem::path(contract_scene).parent_path();
  CHECK(scene.plugin_dirs == std::vector<std::filesystem::path>{beside / "mine"});
}

TEST_CASE("walls have a shear rate and a mean speed, of either sign") {
  const auto stage = [](const std::string& keys) {
    return read(contract_scene, {"/stages/1={\"name\": \"flow\", \"duration\": \"1 s\", " + keys + "}", "/output={}"})
        .stages[1];
  };
  const double height = 25.088e-6;
  const Stage faster = stage(R"("walls": {"lower": "1 mm/s", "upper": "2 mm/s"})");
  CHECK(faster.shear_rate == about(1e-3 / height));
  CHECK(faster.mean_wall_speed == about(1.5e-3));
  const Stage slower = stage(R"("walls": {"lower": 1e-3, "upper": "-2 mm/s"})");
  CHECK(slower.shear_rate == about(-3e-3 / height));
  CHECK(slower.mean_wall_speed == about(-0.5e-3));
  // The same speed in two units.
  const Stage same = stage(R"("walls": {"lower": "0.3 mm/s", "upper": "0.03 cm/s"})");
  CHECK(same.shear_rate == 0);
  CHECK(same.mean_wall_speed == about(0.3e-3));
  const Stage back = stage(R"("shear_rate": "-20 1/s", "strain": 3, "start": "developed")");
  CHECK(back.shear_rate == -20.0);
  CHECK(back.mean_wall_speed == 0.0);
}

TEST_CASE("a stage may end by the energy's rate") {
  const auto scene = read(contract_scene, {"/stages/0/until=equilibrium"});
  CHECK(scene.stages[0].until_equilibrium);
  CHECK_FALSE(scene.stages[0].until_at_rest);
  CHECK(scene.equilibrium.rate == about(1e-3));
  CHECK(scene.equilibrium.window == about(0.2));
  const auto own =
      read(contract_scene, {"/stages/0/until=equilibrium", R"(/equilibrium={"rate": "1 1/min", "window": "50 ms"})"});
  CHECK(own.equilibrium.rate == about(1.0 / 60));
  CHECK(own.equilibrium.window == about(0.05));
}

TEST_CASE("a mean velocity stands in place of a pressure gradient") {
  const Stage stage =
      read(contract_scene,
           {R"(/stages/1={"name": "flow", "duration": "1 s", "mean_velocity": "-1 mm/s", "start": "developed"})",
            "/output={}"})
          .stages[1];
  CHECK(stage.mean_velocity.value() == about(-1e-3));
  CHECK(stage.pressure_gradient.x() == 0);
  CHECK(stage.start == WallStart::developed);
}

TEST_CASE("the amplitude of an oscillation is of what drives the stage") {
  const auto stage = [](const std::string& keys) {
    return read(contract_scene, {"/stages/1={\"name\": \"flow\", \"duration\": \"1 s\", " + keys + "}", "/output={}"})
        .stages[1];
  };
  const Stage shear = stage(R"("shear_rate": "3 1/s", "oscillation": {"amplitude": "20 1/s", "frequency": "5 Hz"})");
  CHECK(shear.shear_rate == 3);
  CHECK(shear.oscillation.shear_rate == 20);
  CHECK(shear.oscillation.frequency == about(5));
  CHECK(shear.oscillates());
  const Stage wall = stage(R"("walls": {"lower": 0, "upper": 0}, "oscillation":
      {"amplitude": {"lower": "0 mm/s", "upper": "1 mm/s"}, "frequency": "1 kHz"})");
  CHECK(wall.shear_rate == 0);
  CHECK(wall.oscillation.shear_rate == about(1e-3 / 25.088e-6));
  CHECK(wall.oscillation.mean_wall_speed == about(0.5e-3));
  CHECK(wall.oscillation.frequency == about(1000));
  const Stage driven = stage(R"("pressure_gradient": 0, "oscillation": {"amplitude": "-2 kPa/m", "frequency": 10})");
  CHECK(driven.pressure_gradient.x() == 0);
  CHECK(driven.oscillation.pressure_gradient == about(-2000));
  CHECK_FALSE(stage(R"("shear_rate": "3 1/s")").oscillates());
}

TEST_CASE("a ramp of what drives a stage is kept as its mean and half of what it rises by") {
  const auto stage = [](const std::string& keys) {
    return read(contract_scene, {"/stages/1={\"name\": \"flow\", \"duration\": \"1 s\", " + keys + "}", "/output={}"})
        .stages[1];
  };
  const Stage shear = stage(R"("shear_rate": {"from": "50 1/s", "to": "2 1/s"})");
  CHECK(shear.shear_rate == 26);
  CHECK(shear.oscillation.shear_rate == -24);
  CHECK(shear.changes());
  CHECK_FALSE(shear.oscillates());
  CHECK_FALSE(shear.shears_steadily());
  const Stage driven = stage(R"("pressure_gradient": {"from": 0, "to": "1 kPa/m"})");
  CHECK(driven.pressure_gradient.x() == about(500));
  CHECK(driven.oscillation.pressure_gradient == about(500));
}

TEST_CASE("a stage may end by a mean that is known, or once aggregates have parted") {
  const auto stage = [](const std::string& until) {
    return read(contract_scene, {R"(/stages/1={"name": "flow", "shear_rate": 5, "strain": 9, "until": )" + until + "}"})
        .stages[1];
  };
  const Stage mean = stage(R"({"relative_viscosity": {"standard_error": 0.02}})");
  CHECK(mean.until_mean == "relative_viscosity");
  CHECK(mean.until_standard_error == 0.02);
  CHECK(mean.may_end_early());
  CHECK(stage(R"("parted")").until_parted);
  CHECK_FALSE(read(contract_scene).stages[1].may_end_early());
}

TEST_CASE("a model is swapped with its parameters by set") {
  const auto scene = read(contract_scene, {"/fluid/collision={\"model\": \"bgk\"}"});
  CHECK(scene.fluid.collision.model == "bgk");
  CHECK(scene.fluid.collision.parameters.empty());
}

TEST_CASE("a fault in what set gave names the option") {
  CHECK(message_of({"/numerics/tau=0.4"}) ==
        "--set /numerics/tau\n  0.4 is out of range; tau must be above 0.5 and at most 100\n"
        "  tau: Relaxation time of the suspending fluid in time steps; 1 when left out. Viscosity vanishes at 0.5.");
  CHECK_THAT(message_of({"/fluid/viscosity=6 Pa"}),
             Contains("--set /fluid/viscosity\n  \"6 Pa\" is a pressure; viscosity wants Pa s"));
  CHECK_THAT(message_of({"/numerics/tao=1"}),
             Contains("--set /numerics/tao\n  unknown key \"tao\"; did you mean \"tau\"?"));
  CHECK_THAT(message_of({"/cells/0/row/count=5", "/cells/0/type=rcb"}),
             Contains("no cell type is called \"rcb\"; did you mean \"rbc\"?"));
}

TEST_CASE("a spacing that differs along x and y comes with the exact remedy") {
  const auto message = message_of({"/domain/nodes=[200, 100]", "/domain/size/1=25 um"});
  CHECK_THAT(message, Contains("write size [\"50.176 um\", \"25.088 um\"]"));
  CHECK(message_of({"/domain/nodes=[200, 100]", "/domain/size/1=25.088 um"}).empty());
  CHECK_THAT(message_of({"/domain/nodes=[200, 128]"}), Contains("or nodes [200, 100]"));
}

TEST_CASE("numbers beyond any sense are refused before anything is computed from them") {
  for (const char* value :
       {"1e300", "-1e300", "0", "-1", "\"1e300 m\"", "\"1e-300 m\"", "1e-320", "true", "null", "[]", "{}", "\"\""}) {
    for (const char* pointer :
         {"/domain/size/0", "/fluid/density", "/fluid/viscosity", "/numerics/density_factor",
          "/cell_types/rbc/segments", "/cell_types/rbc/shape/biconcave/radius", "/cell_types/rbc/interior_viscosity",
          "/cells/0/row/count", "/cells/0/row/spacing", "/domain/nodes/0", "/stages/0/duration", "/stages/1/strain",
          "/output/cells/strain", "/output/checkpoint/seconds", "/output/aggregate_gap", "/at_rest/window",
          "/checks/every_steps"}) {
      if (std::string(value) == "1e-320" && std::string(pointer).find("strain") != std::string::npos)
        continue;  // tiny, but fine
      if (std::string(value) == "1e-320" && std::string(pointer) == "/numerics/density_factor") continue;
      INFO(pointer << '=' << value);
      CHECK_FALSE(message_of({std::string(pointer) + '=' + value}).empty());
    }
  }
}

TEST_CASE("no value in the scene can be replaced by one of another kind without a scene or an error coming out") {
  const auto root = Document::read(contract_scene).root().flatten();
  for (const auto& [pointer, value] : root.items()) {
    for (const char* other : {"0", "-1", "1e300", "18446744073709551615", "null", "true", "[]", "{}", "[[[]]]", "\"\"",
                              "\"x\"", "{\"a\": {\"b\": []}}"}) {
      (void)message_of({pointer + '=' + other});  // a crash is what this looks for
    }
  }
  SUCCEED();
}

TEST_CASE("reading neither counts nor places cells that are wanted at random") {
  const Scene scene = read(contract_scene, {R"(/cells=[{"type": "rbc", "at": ["5 um", "6 um"]},
                                  {"type": "rbc", "random": {"hematocrit": 0.1, "seed": 1, "gap": "0.3 um"}},
                                  {"type": "rbc", "at": ["15 um", "6 um"]}])"});
  CHECK(scene.cells.size() == 2);
  REQUIRE(scene.packings.size() == 1);
  CHECK(scene.packings[0].hematocrit == 0.1);
  CHECK(scene.packings[0].first == 1);
  CHECK(scene.packings[0].count == 0);
  CHECK(scene.packings[0].gap == about(0.3e-6));
  CHECK(scene.packings[0].upper == scene.domain.size);
}
