// Shapes of walls as they are written.
#include <catch2/catch.hpp>
#include <cmath>

#include "json/document.hpp"
#include "scene/read_scene.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using namespace rouleau::scene;
using Catch::Matchers::Contains;

namespace {

constexpr double um = 1e-6;

Scene read(const std::string& domain) {
  const test::ScratchFolder folder;
  folder.write("vessel.stl", "");
  folder.write("a.png", "");
  folder.write("b.png", "");
  const auto file = folder.write("scene.json", R"({"rouleau": 1, "domain": {)" + domain + R"(},
      "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"}, "stages": [{"name": "rest", "duration": "1 ms"}]})");
  return read_scene(std::make_shared<const json::Document>(read_document(file)));
}

const std::string plane = R"("size": ["40 um", "20 um"], "nodes": [40, 20], )",
                  space = R"("size": ["40 um", "20 um", "20 um"], "nodes": [40, 20, 20], )";

WallShape within(const std::string& domain, const std::string& shape) {
  return *read(domain + R"("walls": {"within": )" + shape + "}").domain.within;
}
std::string message_of(const std::string& domain, const std::string& shape) {
  try {
    static_cast<void>(within(domain, shape));
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("shapes of walls come out in SI units, what has no end with an infinite one") {
  const auto box =
      std::get<WallShape::Box>(within(plane, R"({"box": {"lower": ["1 um", "2 um"], "upper": ["3 um", "4 um"]}})").is);
  CHECK(box.upper.y() == Approx(4 * um));
  const auto cylinder = std::get<WallShape::Cylinder>(
      within(space, R"({"cylinder": {"axis": "y", "center": ["5 um", "6 um"], "radius": "1 mm", "from": "2 um"}})").is);
  CHECK(cylinder.axis == 1);
  CHECK(cylinder.center[1] == Approx(6 * um));
  CHECK(cylinder.radius == Approx(1e-3));  // longer than the box
  CHECK(cylinder.from == Approx(2 * um));
  CHECK(std::isinf(cylinder.to));
  const auto mesh = std::get<WallShape::Mesh>(
      within(space, R"({"mesh": {"file": "vessel.stl", "unit": "1 mm", "axis": [2, 0, 0]}})").is);
  CHECK(mesh.unit == Approx(1e-3));
  CHECK(mesh.axis->x() == 1);
  CHECK(mesh.at == Vector());
}

TEST_CASE("an outline runs counter-clockwise however it was written, and its last point may be the first again") {
  const auto outline = std::get<WallShape::Outline>(
      within(
          plane,
          R"({"outline": {"points": [["0 um", "0 um"], ["0 um", "9 um"], ["9 um", "9 um"], ["9 um", "0 um"], ["0 um", "0 um"]]}})")
          .is);
  REQUIRE(outline.points.size() == 4);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = outline.points[i], &b = outline.points[(i + 1) % 4];
    area += (a[0] * b[1] - a[1] * b[0]) / 2;
  }
  CHECK(area == Approx(81 * um * um));
}

TEST_CASE("what fluid is of a picture does not depend on what the picture is taken for") {
  const auto light_of = [](const WallShape& shape) { return std::get<WallShape::Image>(shape.is).light; };
  const std::string picture = R"({"image": {"file": "a.png", "pixel": "1 um"}})",
                    dark = R"({"image": {"file": "a.png", "pixel": "1 um", "fluid": "dark"}})";
  CHECK(light_of(within(plane, picture)));
  CHECK_FALSE(light_of(within(plane, dark)));
  const auto joined =
      std::get<WallShape::Joined>(within(plane, "{\"difference\": [" + picture + ", " + picture + "]}").is);
  CHECK(light_of(joined.parts[0]));
  CHECK_FALSE(light_of(joined.parts[1]));
  const Scene scene = read(plane + R"("y": "periodic", "obstacles": [)" + picture + ", {\"difference\": [" + picture +
                           ", " + picture + "]}]");
  CHECK_FALSE(light_of(scene.domain.obstacles[0]));
  CHECK(light_of(std::get<WallShape::Joined>(scene.domain.obstacles[1].is).parts[1]));
}

TEST_CASE("within closes y and z where these are not written periodic; obstacles leave them as they are") {
  const std::string disc = R"({"sphere": {"center": ["9 um", "9 um", "9 um"], "radius": "5 um"}})";
  CHECK(read(space + R"("walls": {"within": )" + disc + "}").domain.periodic == std::array{true, false, false});
  CHECK(read(space + R"("z": "periodic", "walls": {"within": )" + disc + "}").domain.periodic ==
        std::array{true, false, true});
  CHECK(read(space + R"("y": "periodic", "obstacles": [)" + disc + "]").domain.periodic ==
        std::array{true, true, true});
  CHECK_THROWS_WITH(read(space + R"("obstacles": [)" + disc + "]"), Contains("\"y\" is missing"));
}

TEST_CASE("what is no shape of a wall is refused with its place, and with what is allowed") {
  const auto points = [](const std::string& text) { return R"({"outline": {"points": [)" + text + "]}}"; };
  CHECK_THAT(message_of(plane, R"({"box": {"lower": ["1 um", "2 um"], "upper": ["3 um", "2 um"]}})"),
             Contains("/domain/walls/within/box/upper/1") && Contains("it ends at 2 um and begins at 2 um"));
  CHECK_THAT(message_of(plane, R"({"sphere": {"center": ["1 um", "2 um"], "radius": "-3 um"}})"),
             Contains("radius") && Contains("is not positive"));
  CHECK_THAT(message_of(plane, R"({"sphere": {"center": ["1 um", "2 um", "3 um"], "radius": "3 um"}})"),
             Contains("there is no z in two dimensions"));
  CHECK_THAT(message_of(plane, R"({"cylinder": {"axis": "x", "center": ["1 um", "2 um"], "radius": "3 um"}})"),
             Contains("take \"sphere\""));
  CHECK_THAT(message_of(plane, R"({"mesh": {"file": "vessel.stl", "unit": "1 um"}})"),
             Contains("a mesh has three dimensions"));
  CHECK_THAT(message_of(plane, R"({"image": {"file": ["a.png"], "pixel": "1 um"}})"),
             Contains("a stack of pictures has three dimensions"));
  CHECK_THAT(message_of(space, R"({"image": {"file": ["a.png", "b.png"], "pixel": "1 um"}})"),
             Contains("give \"spacing\""));
  CHECK_THAT(message_of(space, R"({"image": {"file": "c.png", "pixel": "1 um"}})"), Contains("\"c.png\" is no file"));
  CHECK_THAT(message_of(plane, R"({"ball": {}})"), Contains("ball"));
  CHECK_THAT(message_of(plane, R"({"sphere": {"center": ["1 um", "2 um"], "radius": "3 um"}, "box": {}})"),
             Contains("cannot stand beside"));
  CHECK_THAT(message_of(plane, points(R"(["0 um", "0 um"], ["9 um", "9 um"], ["9 um", "0 um"], ["0 um", "9 um"])")),
             Contains("crosses or touches itself") && Contains("from point 0 (0 um, 0 um) to point 1 (9 um, 9 um)") &&
                 Contains("point 2 (9 um, 0 um)"));
  CHECK_THAT(message_of(plane, points(R"(["0 um", "0 um"], ["9 um", "0 um"], ["4 um", "0 um"], ["4 um", "9 um"])")),
             Contains("touches itself"));
  CHECK_THAT(message_of(plane, points(R"(["0 um", "0 um"], ["9 um", "0 um"], ["9 um", "0 um"], ["4 um", "9 um"])")),
             Contains("this point and the next are the same"));
  CHECK_THAT(
      message_of(plane,
                 R"({"outline": {"points": [["0 um", "0 um"], ["9 um", "0 um"], ["4 um", "9 um"]], "upper": "1 um"}})"),
      Contains("there is no z"));
  std::string deep = R"({"sphere": {"center": ["1 um", "2 um"], "radius": "3 um"}})";
  for (int i = 0; i < 19; ++i) deep = "{\"union\": [" + deep + "]}";
  CHECK(message_of(plane, deep).empty());
  CHECK_THAT(message_of(plane, "{\"union\": [" + deep + "]}"), Contains("more than 20 levels deep"));
  for (int i = 0; i < 70; ++i) deep = "{\"union\": [" + deep + "]}";
  CHECK_THAT(message_of(plane, deep), Contains("more than 20 levels deep"));
}
