// Regions of the fluid between walls as a scene writes them, against exact distances, areas and volumes.
#include "shape/walls.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "plan/read_scene.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;

namespace {

constexpr double um = 1e-6, pi = std::numbers::pi;

/// A scene without cells whose domain this is, as JSON.
scene::Scene scene_with(const test::ScratchFolder& folder, const std::string& domain) {
  return plan::read_scene(folder.write("scene.json", R"({"rouleau": 1, "domain": {)" + domain + R"(},
      "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"}, "stages": [{"name": "rest", "duration": "1 ms"}]})"));
}
scene::Scene scene_with(const std::string& domain) { return scene_with(test::ScratchFolder(), domain); }

const std::string plane = R"("size": ["40 um", "20 um"], "nodes": [40, 20], )",
                  space = R"("size": ["40 um", "20 um", "20 um"], "nodes": [40, 20, 20], )",
                  closed = R"("y": {"lower": {"wall": {}}, "upper": {"wall": {}}}, )";

/// In um, at a place in um.
double distance(const scene::Scene& scene, double x, double y) {
  return scene.domain.region_in_plane->distance({x * um, y * um}).value / um;
}
double distance(const scene::Scene& scene, double x, double y, double z) {
  return scene.domain.region_in_space->distance({x * um, y * um, z * um}).value / um;
}
Approx about(double value) { return Approx(value).margin(1e-9); }

}  // namespace

TEST_CASE("a disc between plane walls leaves the rest of them, at its distance and that of its images") {
  const auto scene =
      scene_with(plane + closed + R"("obstacles": [{"sphere": {"center": ["4 um", "10 um"], "radius": "5 um"}}])");
  CHECK(distance(scene, 4, 10) == about(-5));
  CHECK(distance(scene, 14, 10) == about(5));
  CHECK(distance(scene, 39.5, 10) == about(4.5 - 5));
  CHECK(distance(scene, 30, 10) == about(14 - 5));
  CHECK(scene.domain.content() == Approx((800 - 25 * pi) * um * um).epsilon(1e-5));
  CHECK(scene.domain.region_width == Approx(20 * um).epsilon(0.01));  // from wall to wall, far from the disc
}

TEST_CASE("a cylinder along x is a tube, with ends or without", "[optimised]") {
  const std::string round =
      R"("walls": {"within": {"cylinder": {"axis": "x", "center": ["10 um", "10 um"], "radius": "8 um")";
  const auto scene = scene_with(space + round + "}}}"),
             through = scene_with(space + round + R"(, "from": "0 um", "to": "40 um"}}})"),
             ended = scene_with(space + round + R"(, "from": "10 um", "to": "30 um"}}})");
  for (const auto* tube : {&scene, &through}) {
    CHECK_FALSE(tube->domain.periodic[1]);
    CHECK_FALSE(tube->domain.periodic[2]);
    CHECK(distance(*tube, 0.5, 10, 13) == about(5));
    CHECK(distance(*tube, 39.9, 10, 0) == about(-2));
    CHECK(tube->domain.content() == Approx(64 * pi * 40 * um * um * um).epsilon(1e-4));
    CHECK(tube->domain.region_width == Approx(16 * um).epsilon(0.01));
  }
  CHECK(distance(ended, 12, 10, 13) == about(2));
  CHECK(distance(ended, 5, 10, 13) == about(-5));
  CHECK(ended.domain.content() == Approx(64 * pi * 20 * um * um * um).epsilon(1e-4));
}

TEST_CASE("a tube with an obstacle is a cylinder without it") {
  const auto scene = scene_with(space + R"("walls": {"tube": {"radius": "8 um"}},
      "obstacles": [{"sphere": {"center": ["20 um", "10 um", "10 um"], "radius": "2 um"}}])");
  CHECK_FALSE(scene.domain.tube_radius);
  CHECK(distance(scene, 5, 10, 13) == about(5));
  CHECK(distance(scene, 20, 10, 13) == about(1));
  CHECK(scene.domain.content() == Approx((64 * pi * 40 - 32 * pi / 3) * um * um * um).epsilon(1e-4));
}

TEST_CASE("a channel drawn as an outline goes on into its image, either way round") {
  const std::string
      points =
          R"(["0 um", "4 um"], ["20 um", "8 um"], ["40 um", "4 um"], ["40 um", "16 um"], ["20 um", "12 um"], ["0 um", "16 um"])",
      turned =
          R"(["0 um", "16 um"], ["20 um", "12 um"], ["40 um", "16 um"], ["40 um", "4 um"], ["20 um", "8 um"], ["0 um", "4 um"])";
  for (const std::string& outline : {points, turned}) {
    const auto scene = scene_with(plane + R"("walls": {"within": {"outline": {"points": [)" + outline + "]}}}");
    const double across = std::cos(std::atan(0.2));  // of a height above a side that rises by 4 um in 20 um
    CHECK(distance(scene, 20, 10) == about(2));      // to the corners of the throat
    CHECK(distance(scene, 1, 10) == about((10 - 4.2) * across));
    CHECK(distance(scene, 39, 10) == distance(scene, 1, 10));
    CHECK(distance(scene, 20, 6) == about(-2 * across));
    CHECK(scene.domain.content() == Approx(320 * um * um).epsilon(1e-5));
  }
}

TEST_CASE("an outline stands along z, all along it or between two heights") {
  const std::string square =
      R"("outline": {"points": [["10 um", "5 um"], ["30 um", "5 um"], ["30 um", "15 um"], ["10 um", "15 um"]])";
  const auto post = scene_with(space + closed + R"("obstacles": [{)" + square + "}}]"),
             block = scene_with(space + closed + R"("obstacles": [{)" + square +
                                R"(, "lower": "-1 um", "upper": "4 um"}}])");
  CHECK(distance(post, 20, 17, 1) == about(2));
  CHECK(distance(post, 33, 19, 1) == about(5));
  CHECK(post.domain.content() == Approx(600 * 20 * um * um * um).epsilon(1e-5));
  CHECK(distance(block, 20, 10, 7) == about(3));
  CHECK(distance(block, 20, 10, 17) == about(2));                                              // to its image below
  CHECK(block.domain.content() == Approx((800 * 20 - 200 * 5) * um * um * um).epsilon(1e-4));  // it has edges
}

TEST_CASE("shapes are joined: what lies in any, in each, or in the first alone") {
  const std::string left = R"({"box": {"lower": ["0 um", "5 um"], "upper": ["40 um", "15 um"]}})",
                    disc = R"({"sphere": {"center": ["20 um", "10 um"], "radius": "7 um"}})";
  const auto within = [&](const char* how) {
    return scene_with(plane + R"("walls": {"within": {")" + how + "\": [" + left + ", " + disc + "]}}");
  };
  const auto both = within("union"), common = within("intersection"), rest = within("difference");
  CHECK(distance(both, 20, 16) == about(1));
  CHECK(distance(common, 20, 14) == about(1));
  CHECK(distance(rest, 5, 8) == about(3));
  CHECK(distance(rest, 12, 10) == about(1));
  CHECK(distance(rest, 0, 14) == about(1));  // the box goes on along x
  const double segment = 49 * std::acos(5.0 / 7) - 5 * std::sqrt(24.0), lens = 49 * pi - 2 * segment;
  CHECK(both.domain.content() == Approx((400 + 2 * segment) * um * um).epsilon(1e-5));
  CHECK(common.domain.content() == Approx(lens * um * um).epsilon(1e-5));
  CHECK(rest.domain.content() == Approx((400 - lens) * um * um).epsilon(1e-5));
}

TEST_CASE("obstacles that lie wholly outside of the domain are found, near it or far away") {
  const auto outside = [](const std::string& center, const std::string& radius) {
    return scene_with(plane + closed +
                      R"("obstacles": [{"sphere": {"center": ["20 um", "0 um"], "radius": "3 um"}}, {"sphere":
        {"center": ["20 um", ")" +
                      center + R"("], "radius": ")" + radius + R"("}}])")
        .domain.obstacles_outside;
  };
  CHECK(outside("50 um", "1 um") == std::vector<std::string>{"/domain/obstacles/1"});
  CHECK(outside("25.1 um", "5 um") == std::vector<std::string>{"/domain/obstacles/1"});
  CHECK(outside("25.1 um", "5.2 um").empty());
  CHECK(outside("10.1 um", "0.3 um").empty());
}

TEST_CASE("walls that leave no fluid, or none at all, are refused, and what does not fit its image") {
  const auto message = [](const std::string& domain) -> std::string {
    try {
      static_cast<void>(scene_with(domain));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK_THAT(message(plane + R"("walls": {"within": {"sphere": {"center": ["20 um", "-30 um"], "radius": "5 um"}}})"),
             Contains("leave no fluid"));
  CHECK_THAT(
      message(
          plane +
          R"("y": "periodic", "walls": {"within": {"box": {"lower": ["0 um", "0 um"], "upper": ["40 um", "20 um"]}}})"),
      Contains("leave no wall"));
  CHECK_THAT(
      message(
          plane + closed +
          R"("obstacles": [{"outline": {"points": [["0 um", "0 um"], ["40 um", "0 um"], ["40 um", "5 um"], ["0 um", "6 um"]]}},
      {"sphere": {"center": ["200 um", "5 um"], "radius": "3 um"}}])"),
      Contains("/domain/obstacles/0/outline") && Contains("does not fit its image one period away") &&
          Contains("(40 um, 5 um)") && Contains("/domain/obstacles/1") &&
          Contains("it reaches from 197 um to 203 um along x"));
}
