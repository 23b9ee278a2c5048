#include "report/report_compare.hpp"

#include <catch2/catch.hpp>

#include "files/file.hpp"
#include "unit/run_fixture.hpp"

using rouleau::Cause;
using rouleau::Error;
using namespace rouleau::files;
using namespace rouleau::monitor;
using namespace rouleau::report;
using namespace rouleau::run;
using namespace rouleau::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

void make_run(const std::filesystem::path& directory, const Summary& summary, const std::string& scene_text) {
  RunDirectory run(directory, small_scene(summary.title));
  for (long step = 0; step < 3; ++step) run.write(small_snapshot(step));
  run.finish(to_json(summary));
  write_file(directory / "scene.json", scene_text);
}

const Json& row(const Json& rows, const std::string& name) {
  for (const Json& one : rows)
    if (one["name"] == name) return one;
  FAIL("no row " + name);
  return rows;
}

}  // namespace

TEST_CASE("differences of values stand at their JSON pointers, with what each side has") {
  const Json a = {{"x", 1}, {"list", {1, 2, 3}}, {"same", {{"deep", "yes"}}}, {"a/b", true}, {"kind", "text"}};
  Json b = a;
  CHECK(value_differences({a, b}) == Json::array());
  b["x"] = 2;
  b["list"] = {1, 5};
  b["a/b"] = false;
  b["kind"] = {{"other", 1}};
  b["new"] = "here";
  const Json found = value_differences({a, b});
  const Json wanted = Json::array({{{"pointer", "/a~1b"}, {"values", {true, false}}},
                                   {{"pointer", "/kind"}, {"values", Json::array({"text", {{"other", 1}}})}},
                                   {{"pointer", "/list/1"}, {"values", {2, 5}}},
                                   {{"pointer", "/list/2"}, {"values", {3, nullptr}}},
                                   {{"pointer", "/x"}, {"values", {1, 2}}},
                                   {{"pointer", "/new"}, {"values", {nullptr, "here"}}}});
  CHECK(found == wanted);
}

TEST_CASE("swapped sides have the same differences the other way round") {
  const Json a = {{"x", 1}, {"gone", 3}}, b = {{"x", 2}};
  for (const Json& one : value_differences({a, b})) {
    bool found = false;
    for (const Json& other : value_differences({b, a}))
      found = found || (one["pointer"] == other["pointer"] && one["values"][0] == other["values"][1] &&
                        one["values"][1] == other["values"][0]);
    CHECK(found);
  }
}

TEST_CASE("of three values one that differs is enough, and all three stand there") {
  const Json one = {{"x", 1}, {"same", 2}}, other = {{"x", 3}, {"same", 2}};
  CHECK(value_differences({one, one, other}) == Json::array({{{"pointer", "/x"}, {"values", {1, 1, 3}}}}));
}

TEST_CASE("plugins differ by their bytes, by version, and by being there") {
  Summary a = small_summary(), b = small_summary();
  a.plugins = {{"trt", "1.0.0", "collision", "/x/libtrt.so", "aa"},
               {"morse", "1.0.0", "interaction", "/x/libmorse.so", "bb"},
               {"bending", "1.0.0", "membrane", "/x/libbending.so", "cc"}};
  b.plugins = a.plugins;
  b.plugins[0].library = "/elsewhere/libtrt.so";  // the same bytes in another place are the same plugin
  CHECK(plugin_differences({to_json(a), to_json(b)}) == Json::array());
  b.plugins[1].sha256 = "b2";
  b.plugins[2] = {"skalak", "2.0.0", "membrane", "/x/libskalak.so", "dd"};
  const Json found = plugin_differences({to_json(a), to_json(b)});
  REQUIRE(found.size() == 3);
  CHECK(found[0]["id"] == "morse");
  CHECK(found[0]["values"][0]["sha256"] == "bb");
  CHECK(found[0]["values"][1]["sha256"] == "b2");
  CHECK(found[1]["id"] == "bending");
  CHECK(found[1]["values"][1].is_null());
  CHECK(found[2]["id"] == "skalak");
  CHECK(found[2]["values"][0].is_null());
}

TEST_CASE("outcomes are compared number by number, means of the stages included") {
  Summary a = small_summary(), b = small_summary();
  b.strain = a.strain + 1;
  a.rheology = {
      {{"stage", "shear"}, {"means", {{"relative_viscosity", {{"mean", 1.25}, {"deviation", 0.1}}}, {"from_s", 1.0}}}}};
  b.rheology = {
      {{"stage", "shear"}, {"means", {{"relative_viscosity", {{"mean", 1.5}, {"deviation", 0.1}}}, {"from_s", 1.0}}}}};
  b.status = "diverged";
  b.failure =
      Failure{"mach", 12, 0.5, 1.5, {1e-6, 2e-6}, -1, 0.4, 0.3, "The flow is too fast.", "Lower density_factor."};
  const Json found = outcome_numbers({to_json(a), to_json(b)});
  CHECK(row(found, "strain")["differs"] == true);
  CHECK(row(found, "strain")["values"][1].get<double>() == Approx(a.strain + 1));
  CHECK(row(found, "mean/shear/relative_viscosity")["values"][0] == 1.25);
  CHECK(row(found, "failure")["values"][1] == "mach");
  CHECK(row(found, "failure")["values"][0].is_null());
  CHECK(row(found, "precision")["differs"] == false);
}

TEST_CASE("runs are compared from their directories alone, also a run with itself") {
  const ScratchFolder folder;
  make_run(folder.path() / "a", small_summary(), R"({"rouleau": 1, "numerics": {"tau": 1.0}})");
  make_run(folder.path() / "b", small_summary(), R"({"rouleau": 1, "numerics": {"tau": 0.8}})");
  const Json both = compare_data({folder.path() / "a", folder.path() / "b"});
  CHECK(both["runs"][0]["directory"] == (folder.path() / "a").string());
  CHECK(both["runs"][1]["step"] == Json::array({0, 1, 2}));
  CHECK(both["differences"]["scene"] == Json::array({{{"pointer", "/numerics/tau"}, {"values", {1.0, 0.8}}}}));

  const Json same = compare_data({folder.path() / "a", folder.path() / "a"});
  CHECK(same["differences"]["scene"] == Json::array());
  CHECK(same["differences"]["plugins"] == Json::array());
  for (const Json& one : same["differences"]["outcome"]) CHECK(one["differs"] == false);

  std::filesystem::remove(folder.path() / "b/scene.json");
  CHECK(compare_data({folder.path() / "a", folder.path() / "b"})["differences"]["scene"].is_null());
}

TEST_CASE("what is no run, or has not ended, cannot be compared") {
  const ScratchFolder folder;
  make_run(folder.path() / "a", small_summary(), "{}");
  const auto refusal = [&](const std::string& b) -> std::string {
    try {
      compare_data({folder.path() / "a", folder.path() / b});
    } catch (const Error& error) {
      CHECK(error.cause() == Cause::bad_input);
      return error.what();
    }
    return "";
  };
  CHECK_THAT(refusal("nowhere"), Contains("nowhere") && Contains("is no directory"));
  std::filesystem::create_directory(folder.path() / "empty");
  CHECK_THAT(refusal("empty"), Contains("empty") && Contains("has no summary.json"));
}
