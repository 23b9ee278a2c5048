// Quantities of a study: how they are read, and what they find in run directories whose numbers are known exactly.
#include "study/quantity.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <functional>

#include "json/document.hpp"
#include "json/schema.hpp"
#include "plan/read_scene.hpp"
#include "study/exact_flow.hpp"
#include "study/study_document.hpp"
#include "unit/run_fixture.hpp"

using rouleau::Cause;
using rouleau::Error;
using namespace rouleau::files;
using namespace rouleau::json;
using namespace rouleau::monitor;
using namespace rouleau::observe;
using namespace rouleau::run;
using namespace rouleau::scene;
using namespace rouleau::study;
using namespace rouleau::test;

namespace {

using Json = nlohmann::json;

Quantity quantity_of(const Json& written, const std::string& file = "study.json") {
  const Json study{{"quantities", {written}}, {"rouleau_study", 1}, {"scene", "scene.json"}, {"matrix", Json::array()}};
  const Document document = Document::parse(study.dump(), file);
  validate(document, study_schema());
  return read_quantity(document, "/quantities/0");
}

/// What is said of a quantity that cannot be right, without the place.
std::string refusal(const Json& written) {
  try {
    quantity_of(written);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    CHECK(error.place().pointer.find("/quantities/0") == 0);
    CHECK(error.place().line == 1);
    const std::string text = error.what();
    return text.substr(text.find('\n') + 3);
  }
  return "";
}

/// Four round cells in a box of 40 x 20 um, at rest for 2 s and then sheared with 20 1/s.
Json scene_of_cells() {
  return Json::parse(R"({
    "rouleau": 1,
    "domain": {"size": ["40 um", "20 um"], "nodes": [64, 32], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"},
    "cell_types": {"rbc": {"shape": {"circle": {"radius": "2 um"}}, "segments": 32, "interior_viscosity": "1 cP",
                   "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-6 N/m"}}]}},
    "cells": [{"type": "rbc", "row": {"count": 4, "spacing": "6 um", "axis": "x", "angle": "0 deg",
                                       "center": ["20 um", "10 um"]}}],
    "stages": [{"name": "rest", "duration": "2 s"}, {"name": "shear", "shear_rate": "20 1/s", "strain": 15}],
    "output": {"cells": {"strain": 0.25}}})");
}

Json scene_of_fluid(const std::string& stage,
                    const std::string& output = R"({"fields": {"strain": 1, "quantities": ["density"]}})") {
  Json scene = Json::parse(R"({
    "rouleau": 1,
    "domain": {"size": ["10 um", "20 um"], "nodes": [8, 16], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"}, "numerics": {"density_factor": 10}})");
  scene["stages"] = {Json::parse(stage)};
  scene["output"] = Json::parse(output);
  return scene;
}

/// A directory written by the program's own writers.
class WrittenRun {
 public:
  WrittenRun(const Json& scene, const std::vector<Snapshot>& snapshots, const Summary& summary = small_summary()) {
    std::ofstream(folder_.path() / "scene.json") << scene;
    const Scene read = rouleau::plan::read_scene(folder_.path() / "scene.json");
    RunDirectory run(directory(), read);
    for (const Snapshot& snapshot : snapshots) run.write(snapshot);
    run.finish(to_json(summary));
  }
  [[nodiscard]] std::filesystem::path directory() const { return folder_.path() / "run"; }
  [[nodiscard]] Measured measured(const Json& written) const { return measure(quantity_of(written), directory()); }
  [[nodiscard]] double value(const Json& written) const {
    const Measured result = measured(written);
    CHECK(std::isfinite(result.value) == result.why_not.empty());
    return result.value;
  }

 private:
  ScratchFolder folder_;
};

/// 2 s at rest, then strain 15 in outputs of a quarter. Cell k: deformation 0.1 k + strain/100, angle falls by
/// 1/8 turn in each strain from 90 deg, its outline turns once in strain 4; gap 1 um + 0.1 um (strain - 8)^2 / 64.
std::vector<Snapshot> sheared_cells() {
  std::vector<Snapshot> snapshots;
  for (int i = -2; i <= 60; ++i) {
    Snapshot s;
    s.step = i + 2;
    s.strain = i < 0 ? 0 : 0.25 * i;
    s.time = i < 0 ? i + 2.0 : 2 + s.strain / 20;
    s.stage = i <= 0 ? 0 : 1;
    s.stage_name = i <= 0 ? "rest" : "shear";
    s.relative_viscosity = i <= 0 ? std::nan("") : 1 + s.strain / 10;
    s.mach_max = 0.01 * s.strain;
    for (int k = 0; k < 4; ++k) {
      CellSnapshot cell{};
      cell.cell = k;
      cell.type = "rbc";
      cell.angle = std::numbers::pi / 2 - s.strain * std::numbers::pi / 4;
      if (k == 3 && i <= 0) cell.angle = std::nan("");
      cell.deformation = 0.1 * k + s.strain / 100;
      cell.area = 20e-12;
      cell.tank_treading_angle = -s.strain / 4 * 2 * std::numbers::pi;
      cell.min_gap = 1e-6 * (k + 1) + 0.1e-6 * (s.strain - 8) * (s.strain - 8) / 64;
      s.cells.push_back(cell);
    }
    snapshots.push_back(s);
  }
  return snapshots;
}

Summary summary_of_cells() {
  Summary summary = small_summary();
  summary.mass_drift = 1e-13;
  summary.area_drift_max = 2e-4;
  summary.aggregates_final = 4;
  summary.plan.attracting[{"rbc", "rbc"}] = 1e-7;
  summary.aggregate_history = {{0, 0, 4, {}, false},    {0, 1, 1, {}, false},        {8.75, 2.4375, 3, {}, false},
                               {10, 2.5, 4, {}, false}, {12.5, 2.625, 3, {}, false}, {13, 2.65, 4, {}, false}};
  return summary;
}

Json named(Json keys) {
  keys["name"] = "q";
  return keys;
}

}  // namespace

TEST_CASE("quantities of cells are interpolated between the rows of cells.csv", "[quantity]") {
  const WrittenRun run(scene_of_cells(), sheared_cells(), summary_of_cells());
  CHECK(run.value(named({{"kind", "deformation"}})) == Approx(0.15));
  CHECK(run.value(named({{"kind", "deformation"}, {"cell", 2}, {"at", "end"}})) == Approx(0.35));
  CHECK(run.value(named({{"kind", "deformation"}, {"cell", 1}, {"at", {{"strain", 3.1}}}})) == Approx(0.131));
  CHECK(run.value(named({{"kind", "deformation"}, {"at", {{"time", "2.1 s"}}}})) == Approx(0.02));
  CHECK(run.value(named({{"kind", "deformation"}, {"at", {{"mean_from_strain", 10}}}})) == Approx(0.125));
  CHECK(run.value(named({{"kind", "angle"}, {"at", {{"strain", 1}}}})) == Approx(45));
  CHECK(run.value(named({{"kind", "angle"}})) == Approx(90 - 15 * 45));  // followed over turns
  CHECK(run.value(named({{"kind", "passage"}, {"angle", "-90 deg"}})) == Approx(4));
  CHECK(run.value(named({{"kind", "passage"}, {"angle", "-90 deg"}, {"cell", 3}})) == Approx(4));
  CHECK(run.value(named({{"kind", "period"}})) == Approx(4));
  CHECK(run.value(named({{"kind", "period"}, {"of", "rotation"}})) == Approx(8));
  CHECK(run.value(named({{"kind", "period"}, {"of", "rotation"}, {"turns", 0.5}, {"from_strain", 5.1}})) == Approx(4));
  CHECK(run.value(named({{"kind", "column"}, {"table", "cells"}, {"column", "area_m2"}, {"cell", 1}})) == 20e-12);
}

TEST_CASE("the smallest gap is that of the whole run, of an instant, or of one cell", "[quantity]") {
  const WrittenRun run(scene_of_cells(), sheared_cells(), summary_of_cells());
  CHECK(run.value(named({{"kind", "gap"}})) == Approx(1e-6));
  CHECK(run.value(named({{"kind", "gap"}, {"at", {{"strain", 0}}}})) == Approx(1.1e-6));
  CHECK(run.value(named({{"kind", "gap"}, {"cell", 2}, {"at", {{"strain", 8}}}})) == Approx(3e-6));
}

TEST_CASE("quantities of the suspension come from series.csv and summary.json", "[quantity]") {
  const WrittenRun run(scene_of_cells(), sheared_cells(), summary_of_cells());
  CHECK(run.value(named({{"kind", "relative_viscosity"}, {"at", {{"strain", 5.1}}}})) == Approx(1.51));
  // Four cells of 20 um2 in 800 um2.
  CHECK(run.value(named({{"kind", "relative_viscosity"}, {"intrinsic", true}, {"at", {{"strain", 5}}}})) == Approx(5));
  CHECK(run.value(named({{"kind", "column"}, {"table", "series"}, {"column", "mach_max"}})) == Approx(0.15));
  CHECK(run.value(named({{"kind", "area_drift"}})) == 2e-4);
  CHECK(run.value(named({{"kind", "mass_drift"}})) == 1e-13);
  CHECK(run.value(named({{"kind", "aggregate_count"}})) == 4);
}

namespace {

/// Two spheres of 30 um3 in a box of 40 x 20 x 10 um or, with walls, a tube of 5 um radius: cell k is at 3 (k + 1) um/s
/// t along x and t^2 um along z; their contact has 2 um2 and grows by 1 um2/s.
WrittenRun spheres(bool tube) {
  Json scene = Json::parse(R"({
    "rouleau": 1, "domain": {"size": ["40 um", "20 um", "10 um"], "nodes": [64, 32, 16], "y": "periodic"},
    "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"},
    "cell_types": {"ball": {"shape": {"sphere": {"radius": "2 um"}}, "membrane": []}},
    "cells": [{"type": "ball", "at": ["5 um", "10 um", "5 um"]}, {"type": "ball", "at": ["15 um", "10 um", "5 um"]}],
    "stages": [{"name": "flow", "pressure_gradient": "30 Pa/m", "duration": "4 s"}]})");
  if (tube) {
    scene["domain"] = Json::parse(R"({"size": ["40 um", "10 um", "10 um"], "nodes": [64, 16, 16]})");
    scene["domain"]["walls"] = {{"tube", {{"radius", "5 um"}}}};
    for (Json& cell : scene["cells"]) cell["at"][1] = "5 um";
  }
  std::vector<Snapshot> snapshots;
  for (int i = 0; i <= 4; ++i) {
    Snapshot s;
    s.step = i;
    s.time = i;
    s.strain = 0;
    s.stage_name = "flow";
    s.relative_viscosity = 1 + 0.1 * i;
    for (int k = 0; k < 2; ++k) {
      CellSnapshot cell{};
      cell.cell = k;
      cell.type = "ball";
      cell.x = 3e-6 * (k + 1) * i;
      cell.z = 1e-6 * i * i;
      cell.volume = 30e-18;
      cell.surface_area = 50e-12;
      s.cells.push_back(cell);
    }
    s.contacts.push_back({.cell_a = 0,
                          .cell_b = 0,
                          .image = {1, 0, 0},
                          .gap = 1e-7,
                          .contact_length = std::nan(""),
                          .contact_area = 1e-12 * (2 + i)});
    snapshots.push_back(s);
  }
  return {scene, snapshots, summary_of_cells()};
}

}  // namespace

TEST_CASE("in three dimensions cells have speeds, contacts areas, and the share of cells is one of volumes",
          "[quantity]") {
  const WrittenRun box = spheres(false), tube = spheres(true);
  CHECK(box.value(named({{"kind", "speed"}})) == Approx(3e-6));
  CHECK(box.value(named({{"kind", "speed"}, {"cell", 1}, {"from_time", "1 s"}})) == Approx(6e-6));
  CHECK(box.value(named({{"kind", "speed"}, {"along", "z"}})) == Approx(6e-6));  // from 2 to 4 s
  CHECK(box.measured(named({{"kind", "speed"}, {"from_time", "4 s"}})).why_not == "the run ends at 4 s");
  CHECK(box.value(named({{"kind", "contact_area"}})) == Approx(6e-12));
  CHECK(box.value(named({{"kind", "contact_area"}, {"at", {{"mean_from_time", "2 s"}}}})) == Approx(5e-12));
  CHECK(box.measured(named({{"kind", "contact_length"}})).why_not.find("ask for contact_area") != std::string::npos);
  const Json intrinsic = named({{"kind", "relative_viscosity"}, {"intrinsic", true}});
  CHECK(box.value(intrinsic) == Approx(0.4 / (60.0 / 8000)));
  CHECK(tube.value(intrinsic) == Approx(0.4 / (60 / (std::numbers::pi * 25 * 40))));
  const WrittenRun plane(scene_of_cells(), sheared_cells(), summary_of_cells());
  CHECK(plane.value(named({{"kind", "contact_length"}})) == 0);
  CHECK(plane.measured(named({{"kind", "contact_area"}})).why_not.find("ask for contact_length") != std::string::npos);
  CHECK(plane.measured(named({{"kind", "speed"}, {"along", "z"}})).why_not == "a run in two dimensions has no z_m");
}

TEST_CASE("dissociation is told from the start of shear, as exactly as the outputs allow", "[quantity]") {
  const WrittenRun run(scene_of_cells(), sheared_cells(), summary_of_cells());
  const Measured all = run.measured(named({{"kind", "dissociation_strain"}}));
  CHECK(all.value == 10);
  CHECK(all.uncertainty == 0.25);
  CHECK(run.value(named({{"kind", "dissociation_strain"}, {"count", 3}})) == 8.75);
  CHECK(run.value(named({{"kind", "dissociation_strain"}, {"for_good", true}})) == 13);
  CHECK(run.measured(named({{"kind", "dissociation_strain"}, {"count", 5}})).why_not == "there are never 5 aggregates");
  CHECK(run.measured(named({{"kind", "dissociation_strain"}, {"count", 1}})).why_not ==
        "there are 1 aggregates or more already when shear begins");
}

TEST_CASE("what a run does not have is not a number but a reason", "[quantity]") {
  const WrittenRun run(scene_of_cells(), sheared_cells(), summary_of_cells());
  const auto why_not = [&](const Json& keys) {
    const Measured result = run.measured(named(keys));
    CHECK(std::isnan(result.value));
    return result.why_not;
  };
  CHECK(why_not({{"kind", "deformation"}, {"cell", 4}}) == "the run has no cell 4");
  CHECK(why_not({{"kind", "deformation"}, {"at", {{"strain", 16}}}}) ==
        "the run has no strain 16: it goes from 0 to 15");
  CHECK(why_not({{"kind", "deformation"}, {"at", {{"time", 4}}}}).find("the run has no time 4: it goes") == 0);
  CHECK(why_not({{"kind", "angle"}, {"cell", 3}, {"at", {{"strain", 0.1}}}}) == "it is not defined at that instant");
  CHECK(why_not({{"kind", "angle"}, {"cell", 3}, {"at", {{"mean_from_strain", 0}}}}) ==
        "it is not defined at every output from that strain on");
  CHECK(why_not({{"kind", "passage"}, {"angle", "-1000 deg"}}) == "the long axis never passes -1000 deg");
  CHECK(why_not({{"kind", "period"}, {"turns", 4}}) == "the outline does not turn 4 times in the run");
  CHECK(why_not({{"kind", "velocity_l2"}, {"flow", "couette"}}) ==
        "the scene has cells, and the exact flow is of the fluid alone");
}

TEST_CASE("a run that did not complete has no values", "[quantity]") {
  Summary summary = summary_of_cells();
  summary.status = "diverged";
  summary.failure = Failure{};
  summary.failure->message = "a node moved too far";
  const WrittenRun run(scene_of_cells(), sheared_cells(), summary);
  const Measured result = run.measured(named({{"kind", "deformation"}}));
  CHECK(std::isnan(result.value));
  CHECK(result.why_not == "the run diverged: a node moved too far");
}

namespace {

/// The exact velocity of all nodes times 1 + `scale`, at a time in s; the walls are 20 um apart.
Snapshot flow(const std::function<double(double y)>& u, double time, double scale) {
  Snapshot s;
  s.time = time;
  s.stage_name = "flow";
  s.relative_viscosity = s.area_drift_max = std::nan("");
  s.fields.nx = 8;
  s.fields.ny = 16;
  std::vector<double> velocity;
  for (int j = 0; j < 16; ++j) {
    for (int i = 0; i < 8; ++i) velocity.insert(velocity.end(), {(1 + scale) * u((j + 0.5) * 20e-6 / 16), 0.0, 0.0});
  }
  s.fields.fields.push_back(given_field("velocity", "m/s", 3, velocity));
  return s;
}

constexpr const char* exactly = R"({"fields": {"strain": 1, "quantities": ["velocity"], "precision": "f64"}})";

}  // namespace

TEST_CASE("the exact flows have no velocity error, and one that is a thousandth too fast has a thousandth",
          "[quantity]") {
  const double scale = GENERATE(0.0, 1e-3);
  const Json couette = named({{"kind", "velocity_l2"}, {"flow", "couette"}});
  const Json poiseuille = named({{"kind", "velocity_l2"}, {"flow", "poiseuille"}});
  const Json moving = scene_of_fluid(R"({"name": "flow", "shear_rate": "20 1/s", "strain": 5})", exactly);
  const Json driven = scene_of_fluid(R"({"name": "flow", "pressure_gradient": "30 Pa/m", "duration": "1 s"})",
                                     R"({"fields": {"seconds": 1, "quantities": ["velocity"], "precision": "f64"}})");
  const auto sheared = [](double y) { return 20 * (y - 10e-6); };
  const auto parabola = [](double y) { return 30 / (2 * 1e-3) * y * (20e-6 - y); };
  // Earlier fields do not count.
  const WrittenRun first(moving, {flow(parabola, 0, 0), flow(sheared, 1, scale)});
  CHECK(first.value(couette) == Approx(scale).margin(1e-14));
  CHECK(first.measured(poiseuille).why_not == "nothing drives the fluid along x in the stage flow");
  const WrittenRun second(driven, {flow(parabola, 1, scale)});
  CHECK(second.value(poiseuille) == Approx(scale).margin(1e-14));
  CHECK(second.measured(couette).why_not == "the walls do not move in the stage flow");
}

TEST_CASE("the start of a flow is compared with its series, at the viscosity it is simulated with", "[quantity]") {
  const Json moving = scene_of_fluid(R"({"name": "flow", "shear_rate": "20 1/s", "strain": 5})", exactly);
  // Kinematic viscosity 1e-6 m2/s over the density factor 10: height^2 / nu is 4 ms.
  const double time = 0.06 * 4e-3;
  const auto start = [](double y) { return 200e-6 * couette_start(y / 20e-6 - 0.5, 0.06); };
  const WrittenRun run(moving, {flow(start, time, 0)});
  CHECK(run.value(named({{"kind", "velocity_l2"}, {"flow", "couette"}, {"steady", false}})) == Approx(0).margin(1e-13));
  std::vector<double> now, later;
  for (int j = 0; j < 16; ++j) {
    now.push_back(start((j + 0.5) * 20e-6 / 16));
    later.push_back(20 * ((j + 0.5) * 20e-6 / 16 - 10e-6));
  }
  CHECK(run.value(named({{"kind", "velocity_l2"}, {"flow", "couette"}})) == Approx(relative_l2(now, later)));
}

TEST_CASE("the series of the start tend to the steady flows", "[quantity]") {
  CHECK(couette_start(0.3, 10) == Approx(0.6));
  CHECK(poiseuille_start(0.3, 10) == Approx(4 * 0.3 * 0.7));
  CHECK(couette_start(0.3, std::numeric_limits<double>::infinity()) == 0.6);
  CHECK(poiseuille_start(0.5, 1e-3) == Approx(8e-3).epsilon(1e-3));  // far from the walls: acceleration alone
  CHECK(tube_start(0.3, std::numeric_limits<double>::infinity()) == 1 - 0.3 * 0.3);
  CHECK(tube_start(0.3, 4) == Approx(1 - 0.3 * 0.3));
  CHECK(tube_start(0.2, 1e-3) == Approx(4e-3).epsilon(1e-3));
  CHECK(tube_start(1.5, 1) == 0);
}

TEST_CASE("a run without velocity says what to ask for", "[quantity]") {
  const Json moving = scene_of_fluid(R"({"name": "flow", "shear_rate": "20 1/s", "strain": 5})");
  Snapshot nothing;
  nothing.stage_name = "flow";
  const WrittenRun run(moving, {nothing});
  CHECK(run.measured(named({{"kind", "velocity_l2"}, {"flow", "couette"}})).why_not ==
        "frames.h5 has no velocity: ask for it in output.fields");
}

TEST_CASE("kinds know their unit, their error and their target", "[quantity]") {
  const Quantity angle = quantity_of({{"name", "tilt"}, {"kind", "angle"}, {"reference", {{"value", 30.258}}}});
  CHECK(angle.unit == "deg");
  CHECK(angle.error == ErrorKind::absolute);
  CHECK(angle.reference.value == 30.258);
  const Quantity flow = quantity_of({{"name", "flow"}, {"kind", "velocity_l2"}, {"flow", "poiseuille"}});
  CHECK(flow.reference.kind == ReferenceKind::analytic);
  CHECK(flow.reference.value == 0);
  const Quantity gap = quantity_of({{"name", "gap"}, {"kind", "gap"}, {"error", "absolute"}, {"target", 1e-8}});
  CHECK(gap.unit == "m");
  CHECK(gap.error == ErrorKind::absolute);
  CHECK(gap.target == 1e-8);
  CHECK(gap.reference.kind == ReferenceKind::richardson);
  CHECK(quantity_of({{"name", "x"}, {"kind", "column"}, {"table", "series"}, {"column", "wall_power_W_per_m"}}).unit ==
        "W/m");
}

TEST_CASE("a reference can be a number of a file, with its uncertainty beside it", "[quantity]") {
  // As a study in a folder beside the references names them.
  const std::string study = std::string(ROULEAU_REFERENCE) + "/../unit/study.json";
  const Quantity d = quantity_of({{"name", "D"},
                                  {"kind", "deformation"},
                                  {"reference",
                                   {{"file", "../reference/capsule_channel.json"},
                                    {"pointer", "/1/steady/D_inertia"},
                                    {"uncertainty", "/1/error_bar/D"},
                                    {"source", "boundary integrals"}}}},
                                 study);
  CHECK(d.reference.kind == ReferenceKind::file);
  CHECK(d.reference.value == 0.2846106);
  CHECK(d.reference.uncertainty == Approx(6.09e-6).epsilon(1e-3));
  CHECK(d.reference.source == "boundary integrals");
  const Quantity passage = quantity_of(
      {{"name", "p"},
       {"kind", "passage"},
       {"angle", "-90 deg"},
       {"reference", {{"file", "../reference/biconcave_channel.json"}, {"pointer", "/0/crossing_times/-90/0"}}}},
      study);
  CHECK(passage.reference.value == 11.824);
  CHECK(passage.reference.source == "../reference/biconcave_channel.json /0/crossing_times/-90/0");
  const Quantity scaled = quantity_of({{"name", "v"},
                                       {"kind", "relative_viscosity"},
                                       {"reference",
                                        {{"file", "../reference/capsule_channel.json"},
                                         {"pointer", "/1/steady/intrinsic_viscosity"},
                                         {"uncertainty", 0.01},
                                         {"factor", 0.1},
                                         {"offset", 1}}}},
                                      study);
  CHECK(scaled.reference.value == Approx(1.215690031));
  CHECK(scaled.reference.uncertainty == 0.01);
}

TEST_CASE("references of other kinds are read", "[quantity]") {
  const auto reference = [](const Json& written) {
    return quantity_of({{"name", "D"}, {"kind", "deformation"}, {"reference", written}}).reference;
  };
  CHECK(reference("richardson").kind == ReferenceKind::richardson);
  CHECK(reference({{"richardson", {{"scheme", "corrected"}}}}).labels.at("scheme") == "corrected");
  CHECK(reference({{"point", {{"resolution", "40"}}}}).kind == ReferenceKind::point);
  const Reference value = reference({{"value", 0.2386}, {"uncertainty", 0.0002}, {"source", "a paper"}});
  CHECK(value.uncertainty == 0.0002);
  CHECK(value.source == "a paper");
}

TEST_CASE("a quantity that cannot be right is refused at its place, with what is allowed", "[quantity]") {
  const auto begins = [](const std::string& text, const std::string& words) { return text.find(words) == 0; };
  CHECK(begins(refusal({{"name", "q"}}), "\"kind\" is missing"));
  CHECK(begins(
      refusal({{"name", "q"}, {"kind", "deformatoin"}}),
      "found the text \"deformatoin\"; did you mean \"deformation\"?\n  kind can be: \"deformation\", \"angle\""));
  CHECK(begins(refusal(named({{"kind", "passage"}})), "\"angle\" is missing"));
  CHECK(refusal(named({{"kind", "passage"}, {"angle", "3 m"}})).find("length") != std::string::npos);
  CHECK(begins(refusal(named({{"kind", "angle"}, {"cel", 1}})), "unknown key \"cel\"; did you mean \"cell\"?"));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"turns", 2}})), "\"turns\" cannot stand here"));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"cell", -1}})), "-1 is out of range; cell must be at least 0"));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"cell", 18446744073709551615U}})),
               "18446744073709551615 is out of range; cell must be at least 0"));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"cell", "first"}})),
               "found the text \"first\"; cell wants a whole number"));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"at", "start"}})), "found the text \"start\"\n  at wants \"end\""));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"at", {{"strain", 1}, {"time", 2}}}})),
               "found 2 keys; at may have at most 1"));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"at", 3}})), "found the number 3; at wants \"end\", or an object"));
  CHECK(begins(refusal(named({{"kind", "period"}, {"turns", 0}})), "0 is out of range; turns must be above 0"));
  CHECK(begins(refusal(named({{"kind", "dissociation_strain"}, {"for_good", 1}})),
               "found the number 1; for_good wants true or false"));
  CHECK(refusal(named({{"kind", "column"}, {"table", "series"}, {"column", "mach"}}))
            .find("series.csv has no column \"mach\"") == 0);
  CHECK(begins(refusal(named({{"kind", "angle"}, {"reference", 3}})),
               "found the number 3; reference wants \"richardson\", or an object"));
  CHECK(begins(refusal(named({{"kind", "angle"}, {"reference", {{"value", 3}, {"uncertainty", -1}}}})),
               "-1 is out of range; uncertainty must be at least 0"));
  CHECK(refusal(named({{"kind", "deformation"}, {"reference", {{"value", 0}}}}))
            .find("there is no error relative to a reference of 0") == 0);
  CHECK(refusal(named({{"kind", "area_drift"}, {"reference", {{"value", 1}}}})) ==
        "area_drift should be exactly 0: leave the reference out");
  CHECK(
      begins(refusal(named({{"kind", "angle"}, {"target", "1 %"}})), "found the text \"1 %\"; target wants a number"));
  CHECK(refusal("deformation").find("found the text \"deformation\"") == 0);
}

TEST_CASE("a pointer that leads nowhere in a reference's file is refused with what is there", "[quantity]") {
  ScratchFolder folder;
  std::ofstream(folder.path() / "values.json") << R"({"steady": {"D": 0.25, "note": "good"}, "list": [1, 2]})";
  const auto said = [&](const std::string& pointer) {
    const Json written =
        named({{"kind", "deformation"}, {"reference", {{"file", "values.json"}, {"pointer", pointer}}}});
    try {
      return std::to_string(quantity_of(written, (folder.path() / "study.json").string()).reference.value);
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  CHECK(said("/steady/D") == "0.250000");
  CHECK(said("/steady/E").find("has nothing at \"/steady/E\": \"/steady\" has D, note") != std::string::npos);
  CHECK(said("/stead/D").find("did you mean \"steady\"?") != std::string::npos);
  CHECK(said("/list/2").find("\"/list\" has the entries 0 to 1") != std::string::npos);
  CHECK(said("/steady/note").find("\"good\" at \"/steady/note\", which is not a number") != std::string::npos);
  CHECK(said("steady").find("is no JSON pointer") != std::string::npos);
  const Json missing = named({{"kind", "angle"}, {"reference", {{"file", "nothing.json"}, {"pointer", "/a"}}}});
  try {
    quantity_of(missing, (folder.path() / "study.json").string());
    FAIL("it was read");
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::input_output);
  }
}
