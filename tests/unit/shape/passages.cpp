// What the lattice makes of the fluid between walls of any shape.
#include "shape/passages.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "plan/read_scene.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;

namespace {

constexpr double um = 1e-6;

scene::Passages passages(const std::string& domain) {
  const test::ScratchFolder folder;
  const auto file = folder.write("scene.json", R"({"rouleau": 1, "domain": {)" + domain + R"(},
      "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"}, "stages": [{"name": "rest", "duration": "1 ms"}]})");
  return *plan::read_scene(file).domain.passages;
}

const std::string plane = R"("size": ["40 um", "20 um"], "nodes": [160, 80], )",
                  space = R"("size": ["20 um", "10 um", "10 um"], "nodes": [80, 40, 40], )",
                  closed = R"("y": {"lower": {"wall": {}}, "upper": {"wall": {}}}, )";

std::string disc(double x, double y, double radius) {
  return R"({"sphere": {"center": [)" + std::to_string(x) + "e-6, " + std::to_string(y) + R"(e-6], "radius": )" +
         std::to_string(radius) + "e-6}}";
}

}  // namespace

TEST_CASE("the narrowest passage is found between discs, across a period, and before a plane wall") {
  const auto two = passages(plane + closed + R"("obstacles": [)" + disc(20, 5, 4) + ", " + disc(20, 15, 4) + "]");
  CHECK(two.narrowest == Approx(4).epsilon(0.01));  // to the walls, 1 um
  const auto row = passages(plane + R"("y": "periodic", "obstacles": [)" + disc(20, 3, 9) + "]");
  CHECK(row.narrowest == Approx(8).epsilon(0.01));
  CHECK(row.narrowest_at.x() == Approx(20 * um).margin(0.5 * um));
  CHECK(row.narrowest_at.y() == Approx(13 * um).margin(0.5 * um));
  const auto none = passages(plane + R"("y": "periodic", "obstacles": [)" + disc(20, 10, 1) + "]");
  CHECK(none.narrowest > 16);
}

TEST_CASE("the width of a channel at an angle is that from wall to wall") {
  // From one corner of the domain to the opposite one, which are one place a period away.
  const auto tilted = passages(plane + R"("y": "periodic", "walls": {"within": {"outline": {"points":
      [["0 um", "-3 um"], ["40 um", "17 um"], ["40 um", "23 um"], ["0 um", "3 um"]]}}})");
  CHECK(tilted.narrowest == Approx(24 * std::cos(std::atan(0.5))).epsilon(0.01));
  CHECK(tilted.through);
  CHECK(tilted.apart == 0);
}

TEST_CASE("between openings a way leads from end to end, and need not come again") {
  const std::string open = R"("x": {"lower": {"inlet": {"mean_velocity": "1 mm/s"}},
                                    "upper": {"outlet": {"pressure": "0 Pa"}}}, )";
  const std::string ways =
      R"("walls": {"within": {"union": [{"box": {"lower": ["0 um", "2 um"], "upper": ["20 um", "8 um"]}},
      {"box": {"lower": ["14 um", "2 um"], "upper": ["20 um", "18 um"]}},
      {"box": {"lower": ["14 um", "13 um"], "upper": ["40 um", "18 um"]}}]}})";
  const auto stairs = passages(plane + open + ways);
  CHECK(stairs.through);
  CHECK(!passages(plane + ways).through);
  CHECK(stairs.open[0] == Approx(6 * um));
  CHECK(stairs.open[1] == Approx(5 * um));
  CHECK(stairs.least_open == Approx(5 * um));
}

TEST_CASE("a drawn channel that ends at openings goes on beyond them, its ends no walls") {
  const test::ScratchFolder folder;
  const auto file = folder.write("scene.json", R"({"rouleau": 1, "domain": {)" + plane + R"(
      "x": {"lower": {"inlet": {"mean_velocity": "1 mm/s"}}, "upper": {"outlet": {"pressure": "0 Pa"}}},
      "walls": {"within": {"outline": {"points":
          [["0 um", "2 um"], ["40 um", "4 um"], ["40 um", "16 um"], ["0 um", "18 um"]]}}}},
      "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"}, "stages": [{"name": "flow", "duration": "1 ms"}]})");
  const scene::Scene scene = plan::read_scene(file);
  const auto& region = *scene.domain.region_in_plane;
  const double slope = std::atan(0.05);
  for (const double x : {5.0, 20.0, 35.0})
    CHECK(region.distance({x * um, 10 * um}).value == Approx((8 - 0.05 * x) * std::cos(slope) * um));
  for (const double y : {10.0, 2.5})
    CHECK(region.distance({-3 * um, y * um}).value == Approx(region.distance({3 * um, y * um}).value));
  CHECK(scene.domain.content() == Approx(40 * um * 14 * um));
}

TEST_CASE("corners, and wedges between walls that touch, are no passages") {
  const auto touching = passages(plane + closed + R"("obstacles": [)" + disc(20, 3, 3.2) + "]");
  CHECK(touching.narrowest == Approx(4 * 13.8).epsilon(0.01));
  const auto wedge = passages(
      plane + R"("walls": {"within": {"union": [{"box": {"lower": ["0 um", "0 um"], "upper": ["40 um", "10 um"]}},
      {"outline": {"points": [["10 um", "9 um"], ["14 um", "9 um"], ["12 um", "19 um"]]}}]}})");
  CHECK(wedge.narrowest == Approx(40).epsilon(0.01));
}

TEST_CASE("shapes that touch flush, but for rounding, leave no passage, and a hair's breadth is one") {
  const auto beside = [](const std::string& right) {
    return passages(R"("size": ["60 um", "20 um"], "nodes": [120, 40], )" + closed + R"("obstacles": [
      {"box": {"lower": ["30 um", "0 um"], "upper": ["34.1 um", "8.2 um"]}},
      {"box": {"lower": [")" +
                    right + R"(", "0 um"], "upper": ["38.2 um", "8.2 um"]}}])")
        .narrowest;
  };
  CHECK(beside("34.1 um") == Approx(23.6).epsilon(0.01));
  CHECK(beside("34.10001 um") == Approx(23.6).epsilon(0.01));
  CHECK_THROWS_WITH(beside("34.11 um"), Contains("a passage is 0.02 lattice spacings"));
}

TEST_CASE(
    "a wall between two nodes of the fluid is told, where it holds none; tips of wedges and thick walls are not") {
  const auto unseen = [](const std::string& obstacle) {
    const test::ScratchFolder folder;
    const auto file =
        folder.write("scene.json", R"({"rouleau": 1, "domain": {)" + plane + closed + R"("obstacles": [)" + obstacle +
                                       R"(]}, "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"},
        "stages": [{"name": "rest", "duration": "1 ms"}]})");
    return plan::read_scene(file).domain.passages->unseen;
  };
  const auto box = [](double left, double lower, double right, double upper) {
    const auto place = [](double x, double y) {
      return "[" + std::to_string(x) + "e-6, " + std::to_string(y) + "e-6]";
    };
    return R"({"box": {"lower": )" + place(left, lower) + R"(, "upper": )" + place(right, upper) + "}}";
  };
  const auto dam = unseen(box(10.13, 0, 10.32, 20));
  CHECK(dam.thickness == Approx(0.76));
  CHECK(dam.at.x() == Approx(10.225 * um));
  CHECK(unseen(box(0, 9.9, 40, 10.05)).thickness == Approx(0.6));
  CHECK(unseen(box(10, 9.9, 20, 10.05)).thickness == Approx(0.6));
  CHECK(unseen(box(10.13, 0, 10.52, 20)).thickness == 0);
  CHECK(unseen(box(10.13, 0, 10.23, 9) + ", " + box(10.23, 0, 10.53, 9)).thickness == 0);
  const std::string from = R"({"outline": {"points": [["10 um", "10 um"], ["20 um", ")", to = R"(20 um", "11 um"]]}})";
  CHECK(unseen(from + R"(9 um"], [")" + to).thickness == 0);      // 11 degrees
  CHECK(unseen(from + R"(10.9 um"], [")" + to).thickness > 0.2);  // half a degree
}

TEST_CASE("a tube's width is its diameter, and a ball in it leaves the ring around it") {
  const std::string tube = R"({"cylinder": {"axis": "x", "center": ["5 um", "5 um"], "radius": "4.5 um"}})";
  CHECK(passages(space + R"("walls": {"within": )" + tube + "}").narrowest == Approx(36).epsilon(0.01));
  const auto ring = passages(space + R"("walls": {"within": )" + tube +
                             R"(}, "obstacles": [{"sphere": {"center": ["7 um", "5 um", "5 um"], "radius": "3 um"}}])");
  CHECK(ring.narrowest == Approx(6).epsilon(0.02));
  CHECK(ring.open[0] == Approx(20.25 * std::numbers::pi * um * um).epsilon(0.02));
}

TEST_CASE("pools that no way leads to are counted, and whether a way leads through a period") {
  const auto pools = passages(
      plane + R"("walls": {"within": {"union": [{"box": {"lower": ["0 um", "0 um"], "upper": ["40 um", "10 um"]}},
      {"box": {"lower": ["4 um", "12 um"], "upper": ["9 um", "17 um"]}}]}})");
  CHECK(pools.through);
  CHECK(pools.apart == 400);
  CHECK(pools.apart_at.y() == Approx(12.125 * um));
  const auto blocked =
      passages(plane + closed + R"("obstacles": [{"box": {"lower": ["4 um", "0 um"], "upper": ["9 um", "20 um"]}}])");
  CHECK_FALSE(blocked.through);
  CHECK(blocked.apart == 0);
  // Two walls with gaps at different heights, and a stair that comes back to itself without going on.
  const auto winding =
      passages(plane + closed + R"("obstacles": [{"box": {"lower": ["4 um", "0 um"], "upper": ["9 um", "14 um"]}},
      {"box": {"lower": ["24 um", "6 um"], "upper": ["29 um", "20 um"]}}])");
  CHECK(winding.through);
  const auto loop = passages(
      plane + R"("walls": {"within": {"difference": [{"box": {"lower": ["5 um", "3 um"], "upper": ["35 um", "17 um"]}},
      {"box": {"lower": ["12 um", "8 um"], "upper": ["28 um", "12 um"]}}]}})");
  CHECK_FALSE(loop.through);
  CHECK(loop.apart == 0);
  const auto across = passages(
      plane + R"("y": "periodic", "obstacles": [{"box": {"lower": ["4 um", "0 um"], "upper": ["9 um", "20 um"]}}])");
  CHECK_FALSE(across.through);  // it goes on along y alone
}
