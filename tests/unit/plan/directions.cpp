// What a plan says of a force does not depend on the axis that it acts along.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>

#include "plan/flow.hpp"
#include "plan/plan_report.hpp"
#include "plan/read_scene.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using namespace rouleau::plan;
using Catch::Matchers::Contains;

namespace {

const std::string wall_pair = R"({"lower": {"wall": {}}, "upper": {"wall": {}}})";

/// A driven channel with a capsule; changes are as for --set.
struct Planned {
  explicit Planned(const std::vector<std::string>& changes)
      : scene(read_scene(written(), changes)), plan(make_plan(scene, catalog)), report(make_report(plan)) {}
  [[nodiscard]] std::string written() const {
    folder.write("scene.json", R"({"rouleau": 1,
      "domain": {"size": ["16 um", "12 um", "16 um"], "nodes": [32, 24, 32], "y": )" +
                                   wall_pair + R"(},
      "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP", "body_force": ["6e6 N/m3", "0 N/m3", "0 N/m3"]},
      "numerics": {"density_factor": 100},
      "cell_types": {"capsule": {"shape": {"sphere": {"radius": "3 um"}}, "triangles": 320,
        "interior_viscosity": "3.6 cP",
        "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "3e-6 N/m"}}]}},
      "cells": [{"type": "capsule", "at": ["8 um", "4.5 um", "8 um"]}],
      "stages": [{"name": "flow", "duration": "30 ms"}]})");
    return (folder.path() / "scene.json").string();
  }
  [[nodiscard]] std::map<std::string, double> limits() const {
    std::map<std::string, double> values;
    for (const Limit& limit : report.limits) values[limit.name] = limit.value;
    return values;
  }

  test::ScratchFolder folder;
  plugin::Catalog catalog{{ROULEAU_PLUGINS}};
  scene::Scene scene;
  Plan plan;
  PlanReport report;
};

std::string force(const std::string& x, const std::string& y, const std::string& z) {
  return "/fluid/body_force=[\"" + x + " N/m3\", \"" + y + " N/m3\", \"" + z + " N/m3\"]";
}
/// The same between walls across z, in a domain that has been turned.
const std::vector<std::string> walls_across_z{
    R"(/domain={"size": ["16 um", "16 um", "12 um"], "nodes": [32, 32, 24], "y": "periodic", "z": )" + wall_pair + "}",
    R"(/cells/0/at=["8 um", "8 um", "4.5 um"])"};

std::vector<std::string> with(std::vector<std::string> changes, const std::string& more) {
  changes.push_back(more);
  return changes;
}

}  // namespace

TEST_CASE("a force has the same limits, warnings and numbers along whatever axis no wall holds it") {
  const Planned along_x({});
  // Mach number, late start, cells that move through the lattice, compression.
  CHECK(along_x.report.warnings.size() >= 4);
  CHECK(along_x.report.dimensionless.at("reynolds_physical") ==
        Approx(1e3 * 6e6 * 12e-6 / 4 / 1.2e-3 * 9e-12 / 1.2e-3));
  const std::vector<std::vector<std::string>> others{{force("0", "0", "6e6")},
                                                     {force("3.6e6", "0", "-4.8e6")},
                                                     with(walls_across_z, force("6e6", "0", "0")),
                                                     with(walls_across_z, force("0", "6e6", "0"))};
  for (const std::vector<std::string>& changes : others) {
    INFO(changes.back());
    const Planned other(changes);
    const auto expected = along_x.limits(), found = other.limits();
    REQUIRE(found.size() == expected.size());
    for (const auto& [name, value] : expected) {
      INFO(name);
      REQUIRE(found.contains(name));
      CHECK(found.at(name) == Approx(value).epsilon(1e-9));
    }
    CHECK(other.report.warnings == along_x.report.warnings);
    CHECK(other.report.late_starts.size() == along_x.report.late_starts.size());
    for (const char* number : {"reynolds_physical", "reynolds_simulated", "capillary", "membrane_strain"})
      CHECK(other.report.dimensionless.at(number) == Approx(along_x.report.dimensionless.at(number)).epsilon(1e-9));
  }
}

TEST_CASE("a force that walls hold drives nothing, and compresses cells at them") {
  for (const Planned& held :
       {Planned({force("0", "6e6", "0")}), Planned(with(walls_across_z, force("0", "0", "6e6")))}) {
    CHECK(held.report.dimensionless.at("reynolds_physical") == 0);
    const scene::StageSetting& stage = held.plan.stages[0];
    CHECK(held.limits().at("compression of cells by a force across walls (stage flow)") ==
          Approx(1.5 * (std::abs(stage.body_force.y()) + stage.body_force.z()) * 24));
    CHECK(held.report.late_starts.empty());
  }
}

TEST_CASE("a force that no wall holds is told by what the scene's fluid gains, and by what is simulated") {
  for (const char* along : {"0", "2", "1"}) {
    const std::string axis = along;
    const Planned free({R"(/domain/y="periodic")",
                        force(axis == "0" ? "2000" : "0", axis == "1" ? "2000" : "0", axis == "2" ? "2000" : "0")});
    REQUIRE_FALSE(free.report.warnings.empty());
    CHECK_THAT(free.report.warnings[0], Contains("x, y and z") && Contains("gains 2 m/s every second") &&
                                            Contains("100 times as dense (numerics.density_factor), is 0.02 m/s"));
    CHECK(std::isnan(free.report.dimensionless.at("reynolds_physical")));
  }
  const Planned true_fluid({R"(/domain/y="periodic")", "/numerics/density_factor=1", force("0", "0", "2000")});
  CHECK_THAT(true_fluid.report.warnings[0], Contains("gains 2 m/s every second,") && !Contains("dense"));
}

TEST_CASE("conversions name the axis of a driving force") {
  const Planned turned({force("0", "1", "2")});
  std::map<std::string, double> si;
  for (const Conversion& row : turned.report.conversions) si[row.quantity] = row.si;
  CHECK(si.at("driving force density along y") == Approx(1));
  CHECK(si.at("driving force density along z") == Approx(2));
  CHECK_FALSE(si.contains("driving force density"));
}

TEST_CASE("a developed start is refused where the developed flow is not known") {
  const std::string developed =
      "/stages/0={\"name\": \"flow\", \"duration\": \"1 ms\", \"pressure_gradient\": "
      "\"1 Pa/m\", \"start\": \"developed\"}";
  CHECK_NOTHROW(Planned({developed}));
  CHECK_THROWS_WITH(Planned({developed, force("0", "0", "1")}), Contains("/stages/0/start") && Contains("along x"));
  CHECK_THROWS_WITH(Planned(with(walls_across_z, developed)),
                    Contains("/stages/0/start") && Contains("walls across y"));
  CHECK_THROWS_WITH(Planned({developed, R"(/domain/y="periodic")"}), Contains("no wall holds"));
}
