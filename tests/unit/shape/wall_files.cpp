// Walls from files: pictures and meshes, against the shapes that they were made of.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <sstream>

#include "core/surface/triangle_surface.hpp"
#include "plan/read_scene.hpp"
#include "scratch_folder.hpp"
#include "shape/formats/mesh_file.hpp"
#include "unit/png.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;
using test::png;

namespace {

constexpr double um = 1e-6, pi = std::numbers::pi;

std::string off(const core::TriangleSurface& surface) {
  std::ostringstream out;
  out.precision(17);
  out << "OFF\n" << surface.nodes.size() << ' ' << surface.triangles.size() << " 0\n";
  for (const auto& node : surface.nodes) out << node.transpose() << '\n';
  for (const auto& [i, j, k] : surface.triangles) out << "3 " << i << ' ' << j << ' ' << k << '\n';
  return out.str();
}

/// A round tube along x, from 0 to a length, with closed ends or open ones.
core::TriangleSurface tube(double radius, double length, int around, bool closed) {
  core::TriangleSurface made;
  for (const double x : {0.0, length}) {
    for (int i = 0; i < around; ++i)
      made.nodes.push_back({x, radius * std::cos(2 * pi * i / around), radius * std::sin(2 * pi * i / around)});
  }
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    made.triangles.push_back({i, next, around + i});
    made.triangles.push_back({next, around + next, around + i});
  }
  for (const double x : {0.0, length}) {
    if (!closed) break;
    const int middle = static_cast<int>(made.nodes.size()), first = x > 0 ? around : 0;
    made.nodes.push_back({x, 0, 0});
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around;
      if (x > 0)
        made.triangles.push_back({middle, first + i, first + next});
      else
        made.triangles.push_back({middle, first + next, first + i});
    }
  }
  return made;
}

class Scenes {
 public:
  test::ScratchFolder folder;
  scene::Scene read(const std::string& domain) const {
    return plan::read_scene(folder.write("scene.json", R"({"rouleau": 1, "domain": {)" + domain + R"(},
        "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"}, "stages": [{"name": "rest", "duration": "1 ms"}]})"));
  }
  std::string message(const std::string& domain) const {
    try {
      static_cast<void>(read(domain));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

const std::string plane = R"("size": ["40 um", "20 um"], "nodes": [80, 40], )",
                  space = R"("size": ["40 um", "20 um", "20 um"], "nodes": [40, 20, 20], )";

double distance(const scene::Scene& scene, double x, double y) {
  return scene.domain.region_in_plane->distance({x * um, y * um}).value / um;
}
double distance(const scene::Scene& scene, double x, double y, double z) {
  return scene.domain.region_in_space->distance({x * um, y * um, z * um}).value / um;
}
std::string within(const std::string& shape) { return R"("walls": {"within": )" + shape + "}"; }

}  // namespace

TEST_CASE("the border of a drawn disc lies at half grey, to a small part of a pixel") {
  const Scenes scenes;
  // Grey falls over four pixels; pixels of 0.25 um: a disc of 6 um about (18, 10) um.
  const auto drawn = [](double x, double y) { return 0.5 + (24 - std::hypot(x - 72, y - 40)) / 4; };
  scenes.folder.write("disc.png", png(160, 80, drawn));
  scenes.folder.write("hole.png", png(160, 80, [&](double x, double y) { return 1 - drawn(x, y); }));
  const auto disc = scenes.read(plane + within(R"({"image": {"file": "disc.png", "pixel": "0.25 um"}})")),
             same =
                 scenes.read(plane + within(R"({"image": {"file": "hole.png", "pixel": "0.25 um", "fluid": "dark"}})")),
             hole = scenes.read(
                 plane + R"("y": "periodic", "obstacles": [{"image": {"file": "hole.png", "pixel": "0.25 um"}}])");
  for (const double angle : {0.0, 0.4, 1.0, 2.5, 4.4}) {
    const double x = 18 + 5 * std::cos(angle), y = 10 + 5 * std::sin(angle);
    CHECK(distance(disc, x, y) == Approx(1).margin(0.01));
    CHECK(distance(same, x, y) == Approx(1).margin(0.01));
    CHECK(distance(hole, x, y) == Approx(-1).margin(0.01));
  }
  CHECK(disc.domain.content() == Approx(36 * pi * um * um).epsilon(2e-3));
  CHECK(hole.domain.content() == Approx((800 - 36 * pi) * um * um).epsilon(1e-3));
}

TEST_CASE("a picture as long as a period goes on with itself, and ends where it ends otherwise") {
  const Scenes scenes;
  const auto band = [](double, double y) { return y > 5 && y < 15 ? 1.0 : 0.0; };
  scenes.folder.write("band.png", png(40, 20, band));
  const auto scene = scenes.read(plane + within(R"({"image": {"file": "band.png", "pixel": "1 um"}})"));
  for (const double x : {0.0, 0.3, 20.0, 39.9}) CHECK(distance(scene, x, 10) == Approx(5));
  CHECK(scene.domain.content() == Approx(400 * um * um).epsilon(1e-5));
  const auto moved =
      scenes.read(plane + within(R"({"image": {"file": "band.png", "pixel": "1 um", "at": ["7 um", "2 um"]}})"));
  for (const double x : {0.0, 7.0, 39.9}) CHECK(distance(moved, x, 10) == Approx(3));
  scenes.folder.write("short.png", png(20, 20, band));
  const auto shorter =
      scenes.read(plane + within(R"({"image": {"file": "short.png", "pixel": "1 um", "at": ["5 um", "0 um"]}})"));
  CHECK(distance(shorter, 8, 10) == Approx(3));
  CHECK(distance(shorter, 30, 10) == Approx(-5));
  CHECK_THAT(scenes.message(plane + within(R"({"image": {"file": "band.png", "pixel": "0.99 um"}})")),
             Contains("40 pixels along x make 39.6 um") && Contains("write \"pixel\": \"1 um\""));
  CHECK_THAT(
      scenes.message(
          plane +
          within(R"({"image": {"file": "band.png", "pixel": "1 um", "fluid": "dark", "at": ["0 um", "500 um"]}})")),
      Contains("leave no fluid"));
  scenes.folder.write("black.png", png(40, 20, [](double, double) { return 0.0; }));
  CHECK_THAT(scenes.message(plane + within(R"({"image": {"file": "black.png", "pixel": "1 um"}})")),
             Contains("nothing in the picture is lighter than half grey") && Contains("\"dark\""));
}

TEST_CASE("pictures in space: one for all heights, and a stack that rebuilds a ball", "[optimised]") {
  const Scenes scenes;
  std::string files;
  for (int k = 0; k < 20; ++k) {
    const double z = k + 0.5 - 10;
    const std::string name = "z" + std::to_string(k) + ".png";
    scenes.folder.write(name,
                        png(40, 20, [&](double x, double y) { return 0.5 + (7 - std::hypot(x - 15, y - 10, z)) / 4; }));
    files += (k > 0 ? ", \"" : "\"") + name + '"';
  }
  const auto ball =
      scenes.read(space + within(R"({"image": {"file": [)" + files + R"(], "pixel": "1 um", "spacing": "1 um"}})"));
  CHECK(distance(ball, 15, 10, 14) == Approx(3).margin(0.05));
  CHECK(distance(ball, 18, 8, 9) == Approx(7 - std::sqrt(14.0)).margin(0.05));
  CHECK(ball.domain.content() == Approx(4 * pi / 3 * 343 * um * um * um).epsilon(0.01));
  const auto column = scenes.read(space + within(R"({"image": {"file": "z10.png", "pixel": "1 um"}})"));
  CHECK(distance(column, 15, 14, 1) == Approx(std::sqrt(49 - 0.25) - 4).margin(0.05));
  CHECK(distance(column, 15, 14, 19) == distance(column, 15, 14, 1));
  scenes.folder.write("z3.png", png(41, 20, [](double, double) { return 1.0; }));
  CHECK_THAT(
      scenes.message(space + within(R"({"image": {"file": [)" + files + R"(], "pixel": "1 um", "spacing": "1 um"}})")),
      Contains("/image/file/3") && Contains("another size"));
}

TEST_CASE("a vessel from a mesh has the distances of what it was made of, through periodic ends as well",
          "[optimised]") {
  const Scenes scenes;
  const std::string mesh = R"({"mesh": {"file": "vessel.off", "unit": "1 um", "at": ["0 um", "10 um", "10 um"]}})";
  for (const bool closed : {true, false}) {
    constexpr int around = 96;
    scenes.folder.write("vessel.off", off(tube(8, 40, around, closed)));
    const auto scene = scenes.read(space + within(mesh));
    for (const double x : {0.0, 0.4, 20.0, 39.9})
      CHECK(distance(scene, x, 10, 13) == Approx(5).margin(8 * (1 - std::cos(pi / around))));
    const double area = around / 2.0 * 64 * std::sin(2 * pi / around);
    CHECK(scene.domain.content() == Approx(area * 40 * um * um * um).epsilon(1e-4));
  }
  const std::string open =
      R"("x": {"lower": {"inlet": {"pressure": "1 Pa"}}, "upper": {"outlet": {"pressure": "0 Pa"}}}, )";
  for (const bool closed : {true, false}) {
    scenes.folder.write("vessel.off", off(tube(8, 40, 96, closed)));
    const auto scene = scenes.read(space + open + within(mesh));
    for (const double x : {0.0, 0.4, 20.0, 39.9}) CHECK(distance(scene, x, 10, 13) == Approx(5).margin(0.01));
    CHECK(scene.domain.passages->through);
  }
  scenes.folder.write("vessel.off", off(tube(8, 39, 12, false)));
  CHECK_THAT(scenes.message(space + open + within(mesh)), Contains("the border is not closed"));
  scenes.folder.write("vessel.off", off(core::unit_sphere(8)));
  const auto ball = scenes.read(
      space + within(R"({"mesh": {"file": "vessel.off", "unit": "7 um", "at": ["39 um", "10 um", "10 um"]}})"));
  CHECK(distance(ball, 1, 10, 10) == Approx(5).margin(0.1));  // in its image
  CHECK(distance(ball, 20, 10, 10) == Approx(-12).margin(0.1));
}

TEST_CASE("a mesh is turned by its axis and angle as cells are", "[optimised]") {
  const Scenes scenes;
  core::TriangleSurface box = core::ellipsoid(6, {6, 3, 4});
  scenes.folder.write("box.off", off(box));
  const auto scene = scenes.read(
      space +
      within(R"({"mesh": {"file": "box.off", "unit": "1 um", "at": ["20 um", "10 um", "10 um"], "angle": "90 deg"}})"));
  CHECK(distance(scene, 20, 15, 10) > 0);
  CHECK(distance(scene, 25, 10, 10) < 0);
  const auto about = scenes.read(
      space +
      within(
          R"({"mesh": {"file": "box.off", "unit": "1 um", "at": ["20 um", "10 um", "10 um"], "axis": [0, 1, 0], "angle": "90 deg"}})"));
  CHECK(distance(about, 20, 10, 15) > 0);
  CHECK(distance(about, 20, 15, 10) < 0);
}

TEST_CASE(
    "a mesh of parts that overlap, lie in each other or are inside out is refused, one of parts that touch is not") {
  const Scenes scenes;
  const std::string mesh = R"({"mesh": {"file": "parts.off", "unit": "1 um", "at": ["20 um", "10 um", "10 um"]}})";
  const auto said = [&](const core::Vec<3>& at, double size, bool turned) {
    core::TriangleSurface parts = core::ellipsoid(6, {6, 6, 6});
    const core::Vec<3> corner[] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1},
                                   {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}};
    for (const auto& [i, j, k] : std::vector<std::array<int, 3>>{{0, 1, 3},
                                                                 {0, 3, 2},
                                                                 {4, 6, 7},
                                                                 {4, 7, 5},
                                                                 {0, 4, 5},
                                                                 {0, 5, 1},
                                                                 {2, 3, 7},
                                                                 {2, 7, 6},
                                                                 {0, 2, 6},
                                                                 {0, 6, 4},
                                                                 {1, 5, 7},
                                                                 {1, 7, 3}}) {
      const int first = static_cast<int>(parts.nodes.size());
      parts.triangles.push_back({first, first + (turned ? 2 : 1), first + (turned ? 1 : 2)});
      for (const int c : {i, j, k}) parts.nodes.push_back(at + size * corner[c]);
    }
    shape::weld(parts, 0);
    scenes.folder.write("parts.off", off(parts));
    return scenes.message(space + within(mesh));
  };
  CHECK_THAT(said({5, -1, -1}, 3, false),
             Contains("/within/mesh/file") && Contains("crosses itself") && Contains("(25."));
  CHECK_THAT(said({-1, -1, -1}, 2, false), Contains("overlap"));
  CHECK_THAT(said({10, -1, -1}, 5, true), Contains("inside out, at (32.5 um") && Contains("\"union\""));
  CHECK(said({-1, -1, -1}, 2, true).empty());  // a hole
  CHECK(said({6, -2, -2}, 5, false).empty());  // beside it
}

TEST_CASE("meshes that are open, inside out, or do not fit their image are refused with the place") {
  const Scenes scenes;
  const std::string mesh = R"({"mesh": {"file": "vessel.off", "unit": "1 um", "at": ["0 um", "10 um", "10 um"]}})";
  auto leaky = tube(8, 40, 12, true);
  leaky.triangles.erase(leaky.triangles.begin() + 4);
  scenes.folder.write("vessel.off", off(leaky));
  CHECK_THAT(scenes.message(space + within(mesh)),
             Contains("/within/mesh/file") && Contains("the border is not closed") && Contains(" um, "));
  auto inside_out = tube(8, 40, 12, true);
  for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  scenes.folder.write("vessel.off", off(inside_out));
  CHECK_THAT(scenes.message(space + within(mesh)), Contains("inside out"));
  auto narrow = tube(8, 40, 12, true);
  for (auto& node : narrow.nodes) node.y() *= 1 - node.x() / 80;
  scenes.folder.write("vessel.off", off(narrow));
  CHECK_THAT(scenes.message(space + within(mesh)), Contains("does not fit its image one period away"));
  scenes.folder.write("vessel.off", off(tube(8, 39, 12, false)));
  CHECK_THAT(scenes.message(space + within(mesh)), Contains("the border is not closed"));
  scenes.folder.write("vessel.off", off(tube(8, 60, 12, true)));
  CHECK_THAT(scenes.message(space + R"("obstacles": [], )" + within(mesh)),
             Contains("the border is not closed") && Contains("let it end at both ends of the domain"));
  scenes.folder.write("vessel.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n2 0 0\n0 0 1\n3 0 1 2\n");
  CHECK_THAT(scenes.message(space + within(mesh)), Contains("triangle 0 has no area"));
  scenes.folder.write("vessel.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  CHECK_THAT(scenes.message(space + within(mesh)), Contains("triangle 0 has the node 7, and there are 3"));
}
