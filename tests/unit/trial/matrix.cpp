// The matrix of a study: settings, labels, positions, the scenes they make, and what is refused.
#include "trial/matrix.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/scene.hpp"
#include "unit/study/study_folder.hpp"

namespace {

using rouleau::Cause;
using rouleau::Error;
using namespace rouleau::json;
using namespace rouleau::test;
using namespace rouleau::trial;
using Json = nlohmann::json;
using rouleau::test::capsule_scene;
using rouleau::test::couette_scene;

std::vector<Axis> axes_of(const std::string& matrix, const Json& scene) {
  return read_axes(Document::parse(R"({"matrix": )" + matrix + "}", "study.json"), "/matrix", scene);
}

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> all;
  for (const Setting& setting : axis.settings) all.push_back(setting.label);
  return all;
}

std::string refusal(const std::string& matrix, const Json& scene = couette_scene()) {
  try {
    axes_of(matrix, scene);
    return "accepted";
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return error.what();
  }
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("refining multiplies nodes and segments, and its labels are radii in lattice spacings") {
  const auto axes = axes_of(R"([{"name": "resolution", "refine": [0.5, 1, 3]}])", capsule_scene());
  REQUIRE(axes.size() == 1);
  CHECK(axes[0].refines);
  CHECK(labels(axes[0]) == Words{"1", "2", "6"});
  CHECK(axes[0].settings[2].position == Approx(6).epsilon(1e-12));
  const Json fine = scene_of(capsule_scene(), axes, Point{{2}});
  CHECK(fine["domain"]["nodes"] == Json({24, 48}));
  CHECK(fine["cell_types"]["capsule"]["segments"] == 39);
  CHECK(scene_of(capsule_scene(), axes, Point{{0}})["cell_types"]["capsule"]["segments"] == 7);  // 6.5 rounded
  CHECK(scene_of(capsule_scene(), axes, Point{{1}}) == capsule_scene());
}

namespace {

/// That scene with a sphere, in three dimensions.
Json sphere_scene() {
  Json scene = capsule_scene();
  scene["domain"]["size"] = {"4 um", "8 um", "4 um"};
  scene["domain"]["nodes"] = {8, 16, 8};
  scene["cell_types"]["capsule"] = {{"shape", {{"sphere", {{"radius", "1 um"}}}}}, {"triangles", 320}};
  scene["cells"][0]["at"] = {"2 um", "4 um", "2 um"};
  return scene;
}

std::vector<Json> counts(const Json& scene, const std::string& axis, const std::string& key) {
  const auto axes = axes_of("[" + axis + "]", scene);
  std::vector<Json> all;
  for (int i = 0; i < static_cast<int>(axes[0].settings.size()); ++i) {
    const Json changed = scene_of(scene, axes, Point{{i}});
    all.push_back({changed["domain"]["nodes"], changed["cell_types"]["capsule"].value(key, 0)});
  }
  return all;
}

}  // namespace

TEST_CASE("in three dimensions refining multiplies nodes, and triangles by the square") {
  const std::string axis = R"({"name": "radius", "refine": [0.5, 1, 1.5]})";
  CHECK(labels(axes_of("[" + axis + "]", sphere_scene())[0]) == Words{"1", "2", "3"});
  CHECK(counts(sphere_scene(), axis, "triangles") ==
        std::vector<Json>{{{4, 8, 4}, 80}, {{8, 16, 8}, 320}, {{12, 24, 12}, 720}});
  Json open = sphere_scene();  // nodes of the surface then lie a spacing apart, whatever that is
  open["cell_types"]["capsule"].erase("triangles");
  CHECK(counts(open, axis, "triangles") == std::vector<Json>{{{4, 8, 4}, 0}, {{8, 16, 8}, 0}, {{12, 24, 12}, 0}});
  Json longish = open;
  longish["cell_types"]["capsule"]["shape"] = {{"ellipsoid", {{"semi_axes", {"1 um", "0.5 um", "2 um"}}}}};
  CHECK(labels(axes_of("[" + axis + "]", longish)[0]) == Words{"2", "4", "6"});
}

TEST_CASE("the lattice alone or the membranes alone are refined in both dimensions") {
  const std::string lattice = R"({"name": "a", "refine": [0.5, 2], "of": "lattice"})";
  const std::string membranes = R"({"name": "a", "refine": [0.5, 2], "of": "membranes"})";
  CHECK(counts(capsule_scene(), lattice, "segments") == std::vector<Json>{{{4, 8}, 13}, {{16, 32}, 13}});
  CHECK(counts(capsule_scene(), membranes, "segments") == std::vector<Json>{{{8, 16}, 7}, {{8, 16}, 26}});
  CHECK(counts(sphere_scene(), lattice, "triangles") == std::vector<Json>{{{4, 8, 4}, 320}, {{16, 32, 16}, 320}});
  CHECK(counts(sphere_scene(), membranes, "triangles") == std::vector<Json>{{{8, 16, 8}, 80}, {{8, 16, 8}, 1280}});
  const Axis alone = axes_of("[" + membranes + "]", sphere_scene())[0];
  CHECK(labels(alone) == Words{"80", "1280"});
  CHECK_FALSE(alone.refines);  // what it tends to is not the truth, but the lattice's answer
  CHECK(axes_of("[" + lattice + "]", sphere_scene())[0].refines);
}

TEST_CASE("what cannot be refined as the axis wants is refused with what can be done") {
  Json open = sphere_scene(), mesh = sphere_scene();
  open["cell_types"]["capsule"].erase("triangles");
  mesh["cell_types"]["capsule"] = {{"shape", {{"mesh", {{"file", "cell.obj"}}}}}};
  const std::string both = R"([{"name": "a", "refine": [1, 2]}])";
  for (const char* of : {"lattice", "membranes"})
    CHECK(refusal(R"([{"name": "a", "refine": [1], "of": ")" + std::string(of) + "\"}]", open)
              .find("follow the lattice") != std::string::npos);
  CHECK(refusal(both, mesh).find("a mesh from a file, which cannot be divided") != std::string::npos);
  CHECK(refusal(R"([{"name": "a", "refine": [1], "of": "membranes"}])").find("the scene has no cells") !=
        std::string::npos);
  CHECK(labels(axes_of(R"([{"name": "a", "refine": [1, 2], "of": "lattice"}])", mesh)[0]) == Words{"16", "32"});
  CHECK(refusal(R"([{"name": "r", "refine": [1.3]}])", sphere_scene()).find("a multiple of 1/8") != std::string::npos);
}

TEST_CASE("without cells the labels of refining are the nodes across") {
  CHECK(labels(axes_of(R"([{"name": "rows", "refine": [1, 100]}])", couette_scene())[0]) == Words{"16", "1600"});
}

TEST_CASE("refining to a broken number of nodes is refused with a factor that works") {
  const std::string words = refusal(R"([{"name": "rows", "refine": [1, 1.3]}])");
  CHECK(words.substr(0, words.find('\n')) == "study.json:1:44 /matrix/0/refine/1");
  CHECK(words.find("a factor of 1.3 makes 10.4 of the scene's 8 nodes") != std::string::npos);
  CHECK(words.find("a multiple of 1/8, for example 1.25") != std::string::npos);
}

TEST_CASE("a scene whose numerics are open cannot be refined, nor one with cells of no type") {
  const std::string axis = R"([{"name": "r", "refine": [1, 2]}])";
  Json open = capsule_scene(), untyped = capsule_scene();
  open["domain"].erase("nodes");
  untyped["cells"][0]["type"] = "no such type";
  for (const Json& scene : {open, untyped}) {
    CHECK(refusal(axis, scene)
              .find("the scene cannot be refined: that wants domain.nodes, in two dimensions the segments") !=
          std::string::npos);
  }
}

TEST_CASE("values are labelled by themselves, and their positions are in SI") {
  const auto axes = axes_of(R"([
    {"name": "tau", "pointer": "/numerics/tau", "values": [0.8, 1, 2]},
    {"name": "rate", "pointer": "/stages/0/shear_rate", "values": ["100 1/s", "2 1/ms"]},
    {"name": "collision", "pointer": "/fluid/collision", "values": [{"model": "trt"}, {"model": "bgk"}]},
    {"name": "inertia", "pointer": "/fluid/inertia", "values": [true, false]}])",
                            couette_scene());
  CHECK(labels(axes[0]) == Words{"0.8", "1", "2"});
  CHECK(axes[0].settings[2].position == 2);
  CHECK(labels(axes[1]) == Words{"100 1/s", "2 1/ms"});
  CHECK(axes[1].settings[1].position == Approx(2000).epsilon(1e-12));
  CHECK(labels(axes[2]) == Words{"trt", "bgk"});
  CHECK(std::isnan(axes[2].settings[0].position));
  CHECK(labels(axes[3]) == Words{"true", "false"});
  CHECK(labels(axes_of(R"([{"name": "t", "pointer": "/numerics/tau", "values": [1, 2], "labels": ["a", "b"]}])",
                       couette_scene())[0]) == Words{"a", "b"});
}

TEST_CASE("zipped pointers change together, and named settings keep the order of the text") {
  const auto axes = axes_of(R"([
    {"name": "both", "pointers": ["/numerics/tau", "/fluid/inertia"], "values": [[0.8, true], [1, false]]},
    {"name": "scheme", "settings": {"plain": {}, "corrected": {"/numerics/slip_correction": true},
                                    "all": {"/numerics/slip_correction": true, "/numerics/area_correction": true}}}])",
                            couette_scene());
  CHECK(labels(axes[0]) == Words{"0.8, true", "1, false"});
  CHECK(labels(axes[1]) == Words{"plain", "corrected", "all"});
  const Json scene = scene_of(couette_scene(), axes, Point{{0, 2}});
  CHECK(scene["numerics"] == Json({{"tau", 0.8}, {"slip_correction", true}, {"area_correction", true}}));
  CHECK(scene["fluid"]["inertia"] == true);
}

TEST_CASE("axes are crossed, the last one changing first, and a later axis prevails") {
  const auto axes = axes_of(R"([{"name": "a", "pointer": "/numerics/tau", "values": [1, 2]},
                                {"name": "b", "pointer": "/numerics/tau", "values": [3, 4, 5]}])",
                            couette_scene());
  const auto points = cross(axes);
  REQUIRE(points.size() == 6);
  CHECK(points[1].setting == std::vector<int>{0, 1});
  CHECK(points[5].setting == std::vector<int>{1, 2});
  CHECK(scene_of(couette_scene(), axes, points[5])["numerics"]["tau"] == 5);
  CHECK(labels_of(axes, points[5]) == Json({{"a", "2"}, {"b", "5"}}));
  CHECK(name_of(axes, points[5]) == "a 2, b 5");
  CHECK(cross({}).size() == 1);
}

TEST_CASE("an axis of threads changes no scene") {
  const auto axes = axes_of(R"([{"name": "threads", "threads": [1, 2]}])", couette_scene());
  CHECK(threads_of(axes, Point{{1}}, 7) == 2);
  CHECK(threads_of({}, Point{}, 7) == 7);
  CHECK(scene_of(couette_scene(), axes, Point{{1}}) == couette_scene());
}

TEST_CASE("a matrix that cannot be meant is refused at its place") {
  CHECK(refusal(R"([{"name": "s", "pointer": "/stages/1/strain", "values": [1]}])")
            .find("/matrix/0/pointer\n  of the scene: /stages is a list of 1; \"1\" is no place in it") !=
        std::string::npos);
  CHECK(refusal(R"([{"name": "s", "pointers": ["/a", "/b"], "values": [[1, 2], [3]]}])")
            .find("/matrix/0/values/1\n  1 values for 2 pointers") != std::string::npos);
  CHECK(refusal(R"([{"name": "s", "pointer": "/numerics/tau", "values": [1, 1.0]}])")
            .find("two settings of this axis are called \"1\"") != std::string::npos);
  CHECK(refusal(R"([{"name": "s", "threads": [1]}, {"name": "s", "threads": [2]}])")
            .find("/matrix/1/name\n  two axes are called \"s\"") != std::string::npos);
  CHECK(refusal(R"([{"name": "s", "threads": [1, 2], "labels": ["one"]}])").find("1 labels for 2 settings") !=
        std::string::npos);
  CHECK(refusal(R"([{"name": "s", "settings": {"a": {"tau": 1}}}])").find("\"tau\" is no JSON pointer") !=
        std::string::npos);
  std::string numbers = "1";
  for (int i = 2; i <= 101; ++i) numbers += ", " + std::to_string(i);
  const std::string many = R"("values": [)" + numbers + "]}";
  CHECK(refusal(R"([{"name": "s", "pointer": "/numerics/tau", )" + many +
                R"(, {"name": "t", "pointer": "/numerics/density_factor", )" + many + "]")
            .find("/matrix/1\n  with this axis the matrix has 10201 points; at most 10000 can be run") !=
        std::string::npos);
  CHECK(refusal(R"([{"name": "s", "settings": {"a": {"/title/b": 1}}}])").find("/matrix/0/settings/a/~1title~1b\n") !=
        std::string::npos);
}
