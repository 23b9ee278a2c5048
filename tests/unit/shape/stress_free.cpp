// Cell types with a state of rest of their own: from the words of a scene to the membranes that are placed.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <fstream>
#include <numbers>

#include "core/membrane/geometry.hpp"
#include "plan/placed_cells.hpp"
#include "plan/plan_report.hpp"
#include "plan/read_scene.hpp"
#include "plugin/catalog.hpp"
#include "scratch_folder.hpp"
#include "shape/extent.hpp"
#include "shape/surface.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;
using core::TriangleSurface;

namespace {

const char* const neo_hookean = R"([{"model": "neo-hookean", "parameters": {"shear_modulus": "4 uN/m"}}])";

/// A scene of three dimensions with one cell of these shapes and laws in a periodic box.
class Written {
 public:
  explicit Written(const std::string& shapes, const std::string& laws = neo_hookean)
      : file_(folder_.write("scene.json", R"({"rouleau": 1,
          "domain": {"size": ["16 um", "16 um", "16 um"], "nodes": [32, 32, 32], "y": "periodic"},
          "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
          "cell_types": {"rbc": {)" + shapes + R"(, "membrane": )" +
                                              laws + R"(}},
          "cells": [{"type": "rbc", "at": ["8 um", "8 um", "8 um"]}],
          "stages": [{"name": "rest", "duration": "1 ms"}]})")) {}

  [[nodiscard]] scene::Scene read(const std::vector<std::string>& changes = {}) const {
    return plan::read_scene(file_, changes);
  }
  [[nodiscard]] plan::PlanReport report() const {
    static const plugin::Catalog catalog({ROULEAU_PLUGINS});
    const scene::Scene scene = read();
    return plan::make_report(plan::make_plan(scene, catalog));
  }
  [[nodiscard]] std::string fault() const {
    try {
      static_cast<void>(read());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] const test::ScratchFolder& folder() const { return folder_; }

 private:
  test::ScratchFolder folder_;
  std::filesystem::path file_;
};

double area_of(const TriangleSurface& surface) { return core::content_of(surface).area; }

}  // namespace

TEST_CASE("a spheroid has the area and volume that it is given, or those of the other shape") {
  const bool prolate = GENERATE(false, true);
  for (const double reduced : {0.3, 0.64, 0.95, 0.999, 1.0}) {
    // Exact area of the spheroid with these axes: Knud Thomsen's would be 1 % off.
    const core::Vec<3> axes = core::spheroid_axes({135, reduced * std::pow(135, 1.5) / (6 * std::sqrt(M_PI))}, prolate);
    CHECK(4 * M_PI / 3 * axes.prod() == Approx(reduced * std::pow(135, 1.5) / (6 * std::sqrt(M_PI))).epsilon(1e-6));
    const core::SurfaceContent found = core::content_of(core::ellipsoid(80, axes));
    CHECK(found.area == Approx(135).epsilon(1e-3));
    CHECK(found.reduced_volume() == Approx(reduced).epsilon(1e-3));
  }
  const auto content = [](const std::string& shapes) {
    return core::content_of(shape::make_surface(Written(shapes + ", \"triangles\": 8000").read().cell_types[0]));
  };
  const std::string kind = prolate ? "prolate" : "oblate";
  const core::SurfaceContent own =
      content(R"("shape": {"spheroid": {"area": "130 um^2", "volume": "90 um^3", "kind": ")" + kind + "\"}}");
  CHECK(own.area == Approx(130e-12).epsilon(3e-3));
  CHECK(own.volume == Approx(90e-18).epsilon(5e-3));
  const core::SurfaceContent of_disc = content(R"("shape": {"spheroid": {"kind": ")" + kind +
                                               R"("}}, "stress_free": {"biconcave": {"radius": "3.91 um"}})"),
                             disc = core::content_of(core::biconcave_disc(20, 3.91e-6));
  CHECK(of_disc.area == Approx(disc.area).epsilon(3e-3));
  CHECK(of_disc.volume == Approx(disc.volume).epsilon(5e-3));
}

TEST_CASE("a stress-free shape without a size has the area of the cell, and its reduced volume") {
  const std::string free = GENERATE(R"({"spheroid": {"reduced_volume": 0.95}})", R"({"sphere": {}})");
  const scene::CellType type =
      Written(R"("shape": {"biconcave": {"radius": "3.91 um"}}, "triangles": 1280, "stress_free": )" + free)
          .read()
          .cell_types[0];
  const TriangleSurface first = shape::make_surface(type), rest = shape::stress_free_surface(type, first);
  CHECK(area_of(rest) == Approx(area_of(first)).epsilon(1e-12));
  CHECK(core::content_of(rest).reduced_volume() ==
        Approx(free.find("0.95") != std::string::npos ? 0.95 : 1).epsilon(0.01));
  CHECK(rest.triangles == first.triangles);
  // Area and volume stay those of the cell.
  const core::RestSurface placed = *plan::make_cells<3>(Written(R"("shape": {"biconcave": {"radius": "3.91 um"}},
      "triangles": 1280, "stress_free": {"sphere": {"radius": "2 um"}})")
                                                            .read())
                                        .types[0];
  CHECK(placed.rest_volume == Approx(core::content_of(first).volume * std::pow(0.5e-6, -3)).epsilon(1e-12));
  CHECK(placed.rest_surface_area == Approx(area_of(first) * std::pow(0.5e-6, -2)).epsilon(1e-12));
  double at_rest = 0;
  for (const double area : placed.triangle_area) at_rest += area;
  CHECK(at_rest == Approx(area_of(core::ellipsoid(8, {4, 4, 4}))).epsilon(1e-12));
}

TEST_CASE("a stress-free sphere stands for a prestretch") {
  const auto placed = [](const std::string& shapes) {
    return *plan::make_cells<3>(Written(shapes + R"(, "triangles": 320)").read()).types[0];
  };
  const core::RestSurface
      one = placed(R"("shape": {"sphere": {"radius": "3 um", "prestretch": 1.25}})"),
      two = placed(R"("shape": {"sphere": {"radius": "3 um"}}, "stress_free": {"sphere": {"radius": "2.4 um"}})");
  CHECK(one.x == two.x);
  for (std::size_t t = 0; t < one.triangle_area.size(); ++t) {
    CHECK(one.inverse_12[t] == Approx(two.inverse_12[t]).margin(1e-12));
    CHECK(one.triangle_area[t] == Approx(two.triangle_area[t]).epsilon(1e-12));
  }
}

TEST_CASE("an outline at rest has the segments and the curvature of its stress-free shape") {
  const test::ScratchFolder folder;
  const auto file = folder.write("scene.json", R"({"rouleau": 1,
      "domain": {"size": ["16 um", "16 um"], "nodes": [32, 32], "y": "periodic"},
      "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
      "cell_types": {"cell": {"shape": {"ellipse": {"semi_axes": ["4 um", "2 um"]}}, "segments": 60,
                              "stress_free": {"circle": {}}, "membrane": []}},
      "cells": [{"type": "cell", "at": ["8 um", "8 um"]}], "stages": [{"name": "rest", "duration": "1 ms"}]})");
  const core::Membranes cells = plan::make_cells<2>(plan::read_scene(file, {}));
  const auto [least, most] = core::stretch_range(cells, cells.cells[0]);
  CHECK(least == Approx(1).epsilon(1e-9));
  CHECK(most == Approx(1).epsilon(1e-9));
  const core::RestShape& rest = *cells.types[0];
  for (const double curvature : rest.rest_curvature)
    CHECK(curvature == Approx(2 * std::numbers::pi / rest.rest_perimeter).epsilon(1e-9));
  CHECK(rest.rest_area == Approx(core::enclosed_area(cells, cells.cells[0])).epsilon(1e-12));
  const core::Membranes larger =
      plan::make_cells<2>(plan::read_scene(file, {R"(/cell_types/cell/stress_free={"circle": {"radius": "2 um"}})"}));
  CHECK(core::stretch_range(larger, larger.cells[0]).most ==
        Approx(rest.rest_perimeter * 0.5 / (2 * 60 * std::sin(std::numbers::pi / 60) * 2)).epsilon(1e-9));
}

TEST_CASE("a mesh at rest has the triangles of the shape, or is refused") {
  const auto obj = [](const TriangleSurface& surface) {
    std::ostringstream text;
    text.precision(17);
    for (const core::Vec<3>& node : surface.nodes)
      text << "v " << node.x() << " " << node.y() << " " << node.z() << "\n";
    for (const auto& [a, b, c] : surface.triangles) text << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
    return text.str();
  };
  const std::string mesh = R"({"mesh": {"file": "m.obj", "unit": "1 um"}})",
                    disc = R"({"biconcave": {"radius": "3.91 um"}})";
  const Written fits(R"("shape": )" + disc + R"(, "triangles": 320, "stress_free": )" + mesh),
      begins(R"("shape": )" + mesh + R"(, "stress_free": )" + disc),
      other(R"("shape": )" + disc + R"(, "triangles": 500, "stress_free": )" + mesh);
  TriangleSurface sphere = core::ellipsoid(4, {3, 3, 3});
  for (const Written* written : {&fits, &begins, &other}) written->folder().write("m.obj", obj(sphere));
  CHECK(fits.fault().empty());
  CHECK(begins.fault().empty());
  CHECK(plan::make_cells<3>(begins.read()).types[0]->triangle_area.front() ==
        Approx(core::rest_surface(core::biconcave_disc(4, 7.82)).triangle_area.front()).epsilon(1e-9));
  CHECK_THAT(other.fault(), Contains("/cell_types/rbc/stress_free") && Contains("320") && Contains("500"));
  std::swap(sphere.triangles[7], sphere.triangles[8]);
  fits.folder().write("m.obj", obj(sphere));
  CHECK_THAT(fits.fault(), Contains("other triangles") && Contains("same order"));
}

TEST_CASE("a plan says how far the first shape is stretched, and the energy that this takes") {
  const auto first =
      Written(R"("shape": {"sphere": {"radius": "3 um"}}, "stress_free": {"sphere": {"radius": "2.5 um"}},
                             "triangles": 320)")
          .report()
          .first_stretches;
  REQUIRE(first.size() == 1);
  CHECK(first[0].type == "rbc");
  CHECK(first[0].least == Approx(1.2).epsilon(1e-6));
  CHECK(first[0].most == Approx(1.2).epsilon(1e-6));
  // Neo-Hookean, both principal stretches the same.
  CHECK(first[0].energy == Approx(4e-6 / 2 * (2 * 1.44 - 3 + std::pow(1.2, -4))).epsilon(1e-9));
  CHECK(first[0].tension == Approx(4e-6 * (1 - std::pow(1.2, -6))).epsilon(1e-9));
  CHECK(Written(R"("shape": {"sphere": {"radius": "3 um"}}, "triangles": 320)").report().first_stretches.empty());
}

TEST_CASE("a plan warns of stress-free shapes with which a red cell may become a cup") {
  const auto warns = [](const std::string& free) {
    const plan::PlanReport report =
        Written(R"("shape": {"biconcave": {"radius": "3.91 um"}}, "triangles": 1280, "stress_free": )" + free).report();
    return std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& warning) {
      return warning.find("come to rest as a cup") != std::string::npos;
    });
  };
  CHECK(warns(R"({"sphere": {}})"));
  CHECK(warns(R"({"spheroid": {"reduced_volume": 0.98}})"));
  CHECK_FALSE(warns(R"({"spheroid": {"reduced_volume": 0.95}})"));
  CHECK_FALSE(warns(R"({"spheroid": {"reduced_volume": 0.7}})"));
  CHECK_FALSE(warns(R"({"biconcave": {"radius": "3.91 um"}})"));
}

TEST_CASE("cells at random that begin as spheroids fill a tube that is narrower than the disc in which they rest") {
  constexpr double spacing = 0.25e-6, tube = 3.3e-6;
  const scene::Scene scene =
      Written(R"("shape": {"spheroid": {"kind": "prolate"}}, "triangles": 720,
                 "stress_free": {"biconcave": {"radius": "3.91 um"}})")
          .read(
              {R"(/domain={"size": ["60 um", "8 um", "8 um"], "nodes": [240, 32, 32], "walls": {"tube": {"radius": "3.3 um"}}})",
               R"(/cells=[{"type": "rbc", "random": {"count": 2, "seed": 1, "gap": "0.3 um"}}])"});
  const core::Surfaces cells = plan::make_cells<3>(scene);
  REQUIRE(cells.cell_count() == 2);
  for (int i = 0; i < cells.node_count(); ++i)
    CHECK(spacing * std::hypot(cells.position[1][i] - 15.5, cells.position[2][i] - 15.5) < tube - 0.29e-6);
  // Nodes lie evenly: an affine image of the sphere would stretch the disc's edges by up to 2.6.
  CHECK(core::first_stretch(*cells.types[0]).most < 2);
}
