// What the constraining membrane laws do to a cell in flow.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>

#include "scene_run.hpp"

using namespace rouleau::test;

namespace {

/// An ellipse of axes 5 : 3 in shear, with a law instead of the neo-Hookean one (`place` "0") or beside it ("-").
SceneRun ellipse_with(const std::string& place, const std::string& law, const std::string& parameters) {
  return run_scene(scenes + "/capsule.json", {R"(/cell_types/capsule/shape={"ellipse": {"semi_axes": [5e-6, 3e-6]}})",
                                              "/cell_types/capsule/membrane/" + place + R"(={"model": ")" + law +
                                                  R"(", "parameters": {)" + parameters + "}}",
                                              "/stages/0/strain=8"});
}

double largest_stretch(const SceneRun& run) {
  return std::max(run.summary["stretch"]["max"].get<double>() - 1, 1 - run.summary["stretch"]["min"].get<double>());
}

double perimeter_drift(const SceneRun& run) {
  double most = 0;
  for (const double perimeter : run.column("perimeter_m")) {
    most = std::max(most, std::abs(perimeter / run.column("perimeter_m").front() - 1));
  }
  return most;
}

}  // namespace

TEST_CASE("an inextensible cell with room to change its shape lengthens in inverse proportion to the stiffness",
          "[laws]") {
  // Its tension is what the flow asks for, whatever the stiffness, so the length gained goes to zero in first order.
  double before = 0, order = 0;
  for (const double modulus : {4e-5, 1.6e-4, 6.4e-4}) {
    const SceneRun run = ellipse_with("0", "inextensible", "\"stretching_modulus\": " + std::to_string(modulus));
    REQUIRE(run.summary["status"] == "completed");
    CHECK(run.summary["warnings"].empty());
    const double gained = perimeter_drift(run), stretch = largest_stretch(run);
    const double estimate = run.summary["dimensionless"]["membrane_strain"];
    if (before > 0) order = std::log(before / gained) / std::log(4.0);
    std::cout << "inextensible, modulus " << modulus << " N/m: perimeter off by " << gained << " (order " << order
              << "), a segment by at most " << stretch << ", membrane_strain " << estimate << "\n";
    // What plan prints is the scale: the tension is a few times viscosity x shear rate x radius.
    CHECK(stretch > estimate);
    CHECK(stretch < 6 * estimate);
    CHECK(gained <= stretch);
    before = gained;
  }
  CHECK(order == Approx(1).margin(0.05));
}

TEST_CASE("a perimeter law beside an elastic one holds the perimeter, the better the stiffer", "[laws]") {
  double before = 0, order = 0;
  for (const double modulus : {1.6e-4, 6.4e-4}) {
    const SceneRun run = ellipse_with("-", "perimeter", "\"modulus\": " + std::to_string(modulus));
    REQUIRE(run.summary["status"] == "completed");
    const double gained = perimeter_drift(run);
    if (before > 0) order = std::log(before / gained) / std::log(4.0);
    std::cout << "perimeter law, modulus " << modulus << " N/m: perimeter off by " << gained << " (order " << order
              << ")\n";
    before = gained;
  }
  CHECK(order == Approx(1).margin(0.05));
}
