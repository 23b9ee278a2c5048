// Small studies from file to study.json: which points are run, what is kept, and that it fits its schema.
#include "study/study_run.hpp"

#include <catch2/catch.hpp>

#include "files/file.hpp"
#include "json/schema.hpp"
#include "study/analysis_json.hpp"
#include "study_folder.hpp"

namespace {

using namespace rouleau::files;
using namespace rouleau::json;
using namespace rouleau::study;
using namespace rouleau::test;
namespace fs = std::filesystem;
using Json = nlohmann::json;
using rouleau::test::couette_scene;
using rouleau::test::StudyFolder;

class SmallStudy {
 public:
  explicit SmallStudy(const std::string& matrix, const Json& scene = couette_scene()) {
    setenv("ROULEAU_TIMING_LOCK", (folder_ / "timing.lock").c_str(), 1);
    const Json study = {{"rouleau_study", 1},
                        {"scene", scene},
                        {"matrix", Json::parse(matrix)},
                        {"quantities", Json::parse(R"([{"name": "velocity", "kind": "velocity_l2", "flow": "couette",
                                                        "steady": false}])")},
                        {"repeats", 1},
                        {"warm_up", false}};
    study_ = read_study(folder_.write("study.json", study.dump(2)));
    options_.directory = folder_ / "out";
    options_.program = ROULEAU_PROGRAM;
    options_.quiet = true;
  }

  Study& study() { return study_; }
  StudyOptions& options() { return options_; }
  /// study.json after a run to the end, which fits the schema.
  Json run() {
    CHECK(StudyRun(study_, options_).run());
    const Document document = Document::read(options_.directory / "study.json");
    CHECK_NOTHROW(validate(document, study_result_schema()));
    return document.root();
  }

 private:
  StudyFolder folder_;
  Study study_;
  StudyOptions options_;
};

constexpr const char* grids = R"([{"name": "rows", "refine": [1, 2, 4]}, {"name": "tau", "pointer": "/numerics/tau",
                                  "values": [0.8, 1.5]}])";

/// At a tenth of the time that momentum takes to cross the gap, H^2/nu = 53 us.
Json start_up() {
  Json scene = couette_scene();
  scene["stages"][0]["duration"] = scene["output"]["fields"]["seconds"] = "5.3333 us";
  return scene;
}

}  // namespace

TEST_CASE("every shipped study can be read, and all its points are scenes") {
  int in_space = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(ROULEAU_REFERENCE) / "../../studies")) {
    if (!entry.is_regular_file()) continue;
    INFO(entry.path());
    const Study study = read_study(entry.path());
    for (const auto& point : rouleau::trial::cross(study.axes))
      REQUIRE_NOTHROW(rouleau::trial::check_scene(rouleau::trial::scene_of(study.scene, study.axes, point), "a point"));
    in_space += study.scene["domain"]["nodes"].size() == 3 ? 1 : 0;
  }
  CHECK(in_space >= 5);
}

TEST_CASE("a study of Couette flow finds second order, and every point has its place in study.json") {
  SmallStudy study(grids, start_up());
  const Json result = study.run();
  REQUIRE(result["points"].size() == 6);
  for (int id = 0; id < 6; ++id) CHECK(result["points"][static_cast<std::size_t>(id)]["id"] == id);
  REQUIRE(result["quantities"][0]["by_method"].size() == 2);
  // The method's own order; at 16 to 64 rows the next term still shows.
  for (const Json& method : result["quantities"][0]["by_method"]) {
    CHECK(method["order"].get<double>() == Approx(2).margin(0.15));
  }
  CHECK(result["complete"] == true);
}

TEST_CASE("a study without axes is its scene alone") {
  SmallStudy study("[]", start_up());
  const Json result = study.run();
  REQUIRE(result["points"].size() == 1);
  CHECK(result["points"][0]["labels"] == Json::object());
  CHECK(result["line"].is_null());
}

TEST_CASE("failed points fit the schema, too") {
  SmallStudy study(R"([{"name": "tau", "pointer": "/numerics/tau", "values": [1, 0.2]}])");
  const Json result = study.run();
  CHECK(result["points"][1]["status"] == "refused");
  CHECK(result["points"][1]["results"]["velocity"]["value"].is_null());
  CHECK(result["points"][1]["results"]["velocity"]["why_not"].is_string());
}

TEST_CASE("a repeat whose tables differ is told of") {
  SmallStudy study(R"([{"name": "tau", "pointer": "/numerics/tau", "values": [1]}])");
  const Json first = study.run();
  CHECK(first["points"][0]["not_deterministic"].is_null());
  // As if the first run had written something else.
  for (const auto& entry : fs::directory_iterator(study.options().directory / "points")) {
    if (entry.path().extension() != ".json" || entry.path().stem().has_extension()) continue;
    Json record = Json::parse(read_text(entry.path()));
    record["tables_sha256"] = std::string(64, '0');
    std::ofstream(entry.path()) << record;
  }
  study.study().repeats = 2;
  const Json second = study.run();
  CHECK(second["points"][0]["not_deterministic"] == "run 2 wrote other tables than run 1 of the same scene");
  CHECK(second["points"][0]["wall_s"]["all"].size() == 2);
}

TEST_CASE("points with the same scene are run once") {
  SmallStudy study(R"([{"name": "a", "settings": {"one": {}, "two": {"/numerics/tau": 1.0}}}])");
  const Json result = study.run();
  CHECK(result["points"][0]["directory"] == result["points"][1]["directory"]);
  CHECK(result["points"][0]["wall_s"] == result["points"][1]["wall_s"]);
}

TEST_CASE("a damaged record is no result: the point is run again") {
  SmallStudy study(R"([{"name": "tau", "pointer": "/numerics/tau", "values": [1]}])");
  study.run();
  for (const auto& entry : fs::directory_iterator(study.options().directory / "points")) {
    if (entry.path().extension() == ".json") std::ofstream(entry.path()) << "{\"fingerprint\": ";
  }
  CHECK(study.run()["points"][0]["status"] == "completed");
}

TEST_CASE("tables hold what a spreadsheet reads: quotes where a label has a comma") {
  SmallStudy study(R"([{"name": "both", "pointers": ["/numerics/tau", "/fluid/inertia"], "values": [[1, true]]}])");
  study.run();
  const std::string table = read_text(study.options().directory / "study.csv");
  CHECK(table.find("id,both,status,") == 0);
  CHECK(table.find("\n0,\"1, true\",completed,") != std::string::npos);
}
