// What reading a whole scene adds to what is written: cells at random stand where their entry does.
#include "plan/read_scene.hpp"

#include <catch2/catch.hpp>

#include "json/document.hpp"
#include "scratch_folder.hpp"
#include "shape/random_cells.hpp"
#include "unit/png.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;

namespace {

const std::string scene_file = std::string(ROULEAU_SCENES) + "/four-cells-shear.json";
const std::vector<std::string> mixed_cells{R"(/cells=[{"type": "rbc", "at": ["5 um", "6 um"]},
    {"type": "rbc", "random": {"hematocrit": 0.1, "seed": 1, "gap": "0.3 um"}},
    {"type": "rbc", "at": ["15 um", "6 um"]}, {"type": "rbc", "random": {"count": 2, "seed": 2}}])"};

}  // namespace

TEST_CASE("cells at random stand in the order of their entries, by hand placed ones keep their places") {
  const scene::Scene scene = plan::read_unpacked_scene(scene_file, mixed_cells).scene;
  REQUIRE(scene.packings.size() == 2);
  const int by_share = scene.packings[0].count;
  CHECK(by_share > 0);
  CHECK(scene.packings[0].first == 1);
  CHECK(scene.packings[1].first == by_share + 2);
  CHECK(scene.packings[1].count == 2);
  REQUIRE(scene.cells.size() == static_cast<std::size_t>(by_share) + 4);
  for (std::size_t i = 0; i < scene.cells.size(); ++i) {
    const auto n = static_cast<std::size_t>(by_share);
    CHECK(scene.cells[i].pointer == (i == 0 ? "/cells/0" : i <= n ? "/cells/1" : i == n + 1 ? "/cells/2" : "/cells/3"));
  }
  CHECK(scene.packings[0].reached == Approx(0.1).epsilon(0.5 / by_share));

  scene::Scene packed = scene;
  shape::pack_cells(packed);
  const scene::Scene whole = plan::read_scene(scene_file, mixed_cells);
  for (std::size_t i = 0; i < scene.cells.size(); ++i) {
    const bool by_hand = i == 0 || i == static_cast<std::size_t>(by_share) + 1;
    CHECK((packed.cells[i].center == scene.cells[i].center) == by_hand);
    CHECK(whole.cells[i].center == packed.cells[i].center);
    CHECK(whole.cells[i].angle == packed.cells[i].angle);
  }
}

TEST_CASE("cells at random count where cells or membrane nodes are too many") {
  const auto cells = [](const std::string& count) {
    return R"(/cells=[{"type": "rbc", "at": ["5 um", "6 um"]}, )"
           R"({"type": "rbc", "random": {"gap": "1 nm", "seed": 1, "count": )" +
           count + "}}]";
  };
  CHECK_THROWS_WITH(
      plan::read_unpacked_scene(scene_file, {cells("10000000"), "/cell_types/rbc/shape/biconcave/radius=1 nm"}),
      Contains("with these there would be 10000001 cells; at most 10000000 can be computed"));
  CHECK_THROWS_WITH(plan::read_unpacked_scene(scene_file, {cells("20001"), "/cell_types/rbc/segments=100000",
                                                           "/cell_types/rbc/shape/biconcave/radius=1 nm"}),
                    Contains("the cells have 2000200000 membrane nodes together"));
}

TEST_CASE("a mesh is part of the scene that names it") {
  const test::ScratchFolder folder;
  const std::string octahedron =
      "OFF\n6 8 12\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n"
      "3 3 1 5\n3 0 3 5\n";
  const std::string file = folder.write("cell.off", octahedron).string();
  const std::string in_space = std::string(ROULEAU_SCENES) + "/../tests/physics/scenes/plain-capsule-3d.json";
  const std::string mesh =
      R"(/cell_types/capsule={"membrane": [], "shape": {"mesh": {"unit": "3 um", "file": ")" + file;
  const auto read = [&](const std::string& further) {
    return plan::read_scene(in_space, {mesh + '"' + further + "}}}"})
        .document->root()
        .at("/cell_types/capsule/shape/mesh"_json_pointer);
  };
  const auto written = read("");
  CHECK(written.at("file") == file);
  const std::string hash = written.at("sha256");
  CHECK_NOTHROW(read(R"(, "sha256": ")" + hash + '"'));
  folder.write("cell.off", octahedron + "# changed\n");
  CHECK_THROWS_WITH(read(R"(, "sha256": ")" + hash + '"'),
                    Contains("shape/mesh/sha256") && Contains("has another hash"));
  CHECK(read("").at("sha256") != hash);
  std::filesystem::resize_file(file, std::uintmax_t{20} << 30U);
  CHECK_THROWS_WITH(read(""), Contains("cell.off") && Contains("more than 4096 MiB"));
}

TEST_CASE("pictures of walls are part of the scene that names them, one and a list of them") {
  const test::ScratchFolder folder;
  const auto light = [](double, double y) { return y > 3 ? 1.0 : 0.0; };
  const auto file = [&](const std::string& name) { return folder.write(name, test::png(10, 10, light)).string(); };
  const std::string a = file("a.png"), b = file("b.png");
  const auto read = [&](const std::string& files, const std::string& further) {
    const auto scene = folder.write("scene.json", R"({"rouleau": 1, "domain": {"size": ["10 um", "10 um", "8 um"],
        "nodes": [20, 20, 16], "walls": {"within": {"image": {"pixel": "1 um", "file": )" +
                                                      files + further + R"(}}}},
        "fluid": {"density": "1 g/cm3", "viscosity": "1 cP"}, "stages": [{"name": "rest", "duration": "1 ms"}]})");
    return plan::read_scene(scene).document->root().at("/domain/walls/within/image"_json_pointer);
  };
  const auto one = read("\"a.png\"", "");
  CHECK(one.at("file") == a);
  const std::string hash = one.at("sha256");
  const auto stack = read(R"(["a.png", "b.png"])", R"(, "spacing": "4 um")");
  CHECK(stack.at("file") == nlohmann::json({a, b}));
  CHECK(stack.at("sha256") == nlohmann::json({hash, hash}));
  const std::string hashes = R"(, "spacing": "4 um", "sha256": [")" + hash + R"(", ")" + hash + "\"]";
  CHECK_NOTHROW(read(R"(["a.png", "b.png"])", hashes));
  folder.write("b.png", test::png(10, 10, [](double, double y) { return y > 4 ? 1.0 : 0.0; }));
  CHECK_THROWS_WITH(read(R"(["a.png", "b.png"])", hashes),
                    Contains("image/sha256") && Contains("b.png") && Contains("has another hash"));
  CHECK_THROWS_WITH(read("\"a.png\"", R"(, "sha256": [")" + hash + R"(", ")" + hash + "\"]"),
                    Contains("more hashes than files"));
}

TEST_CASE("a scene with cells from a file says where the file is and what was in it, and refuses another one") {
  const test::ScratchFolder folder;
  const std::string file = folder.write("cells.csv", "x_um,y_um,angle_deg\n10,12,90\n30,12,0\n").string();
  const std::string all = R"(/cells={"file": ")" + file + "\"}", entry = R"(/cells/-={"file": ")" + file + "\"}";
  const scene::Scene scene = plan::read_scene(scene_file, {all});
  REQUIRE(scene.cells.size() == 2);
  CHECK(scene.cells[1].center.x() == Approx(30e-6));
  CHECK(scene.cells[1].line == 3);
  const auto& written = scene.document->root().at("cells");
  CHECK(written.at("file") == file);
  const std::string hash = written.at("sha256");
  CHECK(hash.size() == 64);

  const std::vector<std::string> both{R"(/cells=[{"type": "rbc", "at": ["20 um", "12 um"]}])", entry};
  const scene::Scene mixed = plan::read_scene(scene_file, both);
  REQUIRE(mixed.cells.size() == 3);
  CHECK(mixed.cells[2].pointer == "/cells/1");
  CHECK(mixed.document->root().at("cells").at(1).at("sha256") == hash);

  CHECK_NOTHROW(plan::read_scene(scene_file, {all, "/cells/sha256=\"" + hash + '"'}));
  folder.write("cells.csv", "x_um,y_um,angle_deg\n10,12,90\n30,12,1\n");
  CHECK_THROWS_WITH(plan::read_scene(scene_file, {all, "/cells/sha256=\"" + hash + '"'}),
                    Contains("/cells/sha256") && Contains("has another hash"));
  CHECK(plan::read_scene(scene_file, {all}).document->root().at("cells").at("sha256") != hash);
  folder.write("cells.csv", "x_um,y_um\n10,12\n10,twelve\n");
  CHECK_THROWS_WITH(plan::read_scene(scene_file, {all}),
                    Contains("cells.csv:3:4") && Contains("\"twelve\" is no number"));
}
