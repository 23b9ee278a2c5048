#include <catch2/catch.hpp>
#include <sstream>

#include "files/file.hpp"
#include "hdf5/hdf5_rows.hpp"
#include "report/report.hpp"
#include "report/report_data.hpp"
#include "report/report_outlines.hpp"
#include "unit/run_fixture.hpp"

using rouleau::Cause;
using rouleau::Error;
namespace hdf5 = rouleau::hdf5;
using namespace rouleau::files;
using namespace rouleau::monitor;
using namespace rouleau::report;
using namespace rouleau::run;
using namespace rouleau::scene;
using namespace rouleau::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

std::filesystem::path finished_run(const std::filesystem::path& directory, const std::string& title) {
  const Scene scene = small_scene(title);
  RunDirectory run(directory, scene);
  for (long step = 0; step < 5; ++step) run.write(small_snapshot(step));
  Summary summary = small_summary();
  summary.title = title;
  run.finish(to_json(summary));
  return write_report(directory);
}

/// The data a browser would find in the page.
Json embedded(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const auto from = page.find(begin) + begin.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

}  // namespace

TEST_CASE("summary.json has every key a script may rely on") {
  const Json summary = to_json(small_summary());
  for (const char* key : {"status",
                          "steps",
                          "strain",
                          "simulated_time_s",
                          "wall_s",
                          "steps_per_s",
                          "mlups",
                          "peak_rss_bytes",
                          "threads",
                          "precision",
                          "git",
                          "scene_sha256",
                          "plugins",
                          "passes",
                          "left_out",
                          "dimensionless",
                          "limits",
                          "conservation",
                          "aggregates_final",
                          "aggregate_history",
                          "warnings",
                          "conversions",
                          "stages",
                          "title",
                          "machine"})
    CHECK(summary.contains(key));
  for (const char* key :
       {"reynolds_physical", "reynolds_simulated", "capillary", "adhesion_number", "viscosity_ratio", "mach_max"})
    CHECK(summary["dimensionless"].contains(key));
  for (const char* key : {"mass_drift", "area_drift_max", "momentum_residual"})
    CHECK(summary["conservation"].contains(key));
  CHECK_FALSE(summary.contains("failure"));
}

TEST_CASE("a page has the names of files and not the folders of its author") {
  const Json data = Json::parse(R"({"scene_file": "/home/somebody/scenes/a.json", "study_file": "studies/b.json",
    "plugins": [{"library": "/opt/somewhere/libmorse.so"}], "pointer": "/cells/0"})");
  const Json shown = embedded(page_with(R"(<script type="application/json" id="data">@ROULEAU_DATA@</script>)", data));
  CHECK(shown["scene_file"] == "a.json");
  CHECK(shown["study_file"] == "studies/b.json");
  CHECK(shown["plugins"][0]["library"] == "libmorse.so");
  CHECK(shown["pointer"] == "/cells/0");
}

TEST_CASE("what is undefined is null in summary.json") {
  Summary summary = small_summary();
  summary.mass_drift = std::nan("");
  summary.plan.limits = {
      {"depth", 0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), ""}};
  const Json written = Json::parse(to_json(summary).dump());
  CHECK(written["dimensionless"]["capillary"].is_null());
  CHECK(written["conservation"]["mass_drift"].is_null());
  CHECK(written["limits"][0]["margin"].is_null());
}

TEST_CASE("a run that --max-steps cut short is completed, and says where it was cut") {
  Summary summary = small_summary();
  summary.steps = 120;
  summary.steps_at_most = 5000;
  summary.stages = {{"rest", 20, Ending::at_rest, 0.1}, {"shear", 100, Ending::strain, 0.5}};
  CHECK(to_json(summary)["outcome"] == "completed after 120 steps");
  CHECK(to_json(summary)["steps_at_most"] == 5000);
  summary.stages[1].ended_by = Ending::max_steps;
  CHECK(to_json(summary)["status"] == "completed");
  CHECK(to_json(summary)["outcome"] == "cut short by the limit of steps at step 120 of at most 5000");
}

TEST_CASE("a diverged run's summary says why, where and what to change") {
  Summary summary = small_summary();
  summary.status = "diverged";
  summary.failure =
      Failure{"mach", 12, 0.5, 1.5, {1e-6, 2e-6}, -1, 0.4, 0.3, "The flow is too fast.", "Lower density_factor."};
  const Json failure = to_json(summary)["failure"];
  CHECK(failure["reason"] == "mach");
  CHECK(failure["step"] == 12);
  CHECK(failure["place_m"] == Json::array({1e-6, 2e-6}));
  CHECK(failure["cell"].is_null());
  CHECK(failure["remedy"] == "Lower density_factor.");
}

TEST_CASE("the report is one file without anything to fetch, with the run's data in it") {
  const ScratchFolder folder;
  const std::string page = read_text(finished_run(folder.path(), "two cells"));
  CHECK_THAT(page, !Contains("src=") && !Contains("@import") && !Contains("<link rel=\"stylesheet\""));
  const Json data = embedded(page);
  CHECK(data["summary"]["status"] == "completed");
  CHECK(data["step"] == Json::array({0, 1, 2, 3, 4}));
  CHECK(data["series"]["relative_viscosity"][0].is_null());
  CHECK(data["cells"]["aggregate"][0] == Json::array({0, 0}));
  CHECK(data["cells"]["min_gap_um"][0][2] == 0.5);
  CHECK(data["cells"]["min_gap_um"][1][2].is_null());
  CHECK(data["outlines"]["first"] == Json::array({0, 32, 64}));
  // 64 nodes, x and y, two bytes each, in base64
  CHECK(data["outlines"]["nodes"][0].get<std::string>().size() == (64 * 4 + 2) / 3 * 4);
  CHECK(data["outlines"]["origin_um"][0][0].get<double>() == Approx(8).margin(0.01));
}

TEST_CASE("the report has the values, the unit and a sentence for every line of every chart") {
  const ScratchFolder folder;
  finished_run(folder.path(), "two cells");
  const Json data = report_data(folder.path());
  std::map<std::string, std::string> units;
  for (const Json& chart : data["charts"]) {
    CAPTURE(chart["title"].get<std::string>());
    CHECK(units.emplace(chart["title"], chart["unit"]).second);
    for (const Json& line : chart["lines"]) {
      CHECK(data[chart["table"].get<std::string>()].contains(line["name"].get<std::string>()));
      CHECK_FALSE(line["doc"].get<std::string>().empty());
    }
  }
  CHECK(units.at("Smallest gap to another cell") == "µm");
  CHECK(units.at("Angle of the long axis") == "°");
  CHECK(units.at("Energy of the cells") == "J/m");
}

TEST_CASE("text from the scene cannot end the report's data or become markup") {
  const ScratchFolder folder;
  const std::string title = "</script><script>alert(1)</script><!-- \"'& \xff";
  const std::string page = read_text(finished_run(folder.path(), title));
  CHECK_THAT(page, !Contains("alert(1)</script>") && !Contains("<!--"));
  CHECK_THAT(embedded(page)["summary"]["title"].get<std::string>(),
             Contains("</script><script>alert(1)</script><!-- \"'&"));
}

TEST_CASE("the report says whose chart library it holds") {
  const ScratchFolder folder;
  const std::string page = read_text(finished_run(folder.path(), "two cells"));
  CHECK_THAT(page, Contains("uPlot") && Contains("Copyright (c) 2022 Leon Sorokin") && Contains("without restriction"));
  CHECK_THAT(page, !Contains("@include"));
}

TEST_CASE("the energy ledger is shown where a run has one") {
  const ScratchFolder folder;
  finished_run(folder.path(), "two cells");
  CHECK(report_data(folder.path())["series"].contains("total_energy_J_per_m"));

  // A run of a version that had no ledger, and one that had a part of it.
  std::string without, part, line;
  std::istringstream lines(read_text(folder.path() / "series.csv"));
  const auto columns_before = [](const std::string& header) {
    const std::string before = header.substr(0, header.find(",kinetic_energy_J_per_m"));
    return std::count(before.begin(), before.end(), ',') + 1;
  };
  long columns = 0;
  for (int row = -1; std::getline(lines, line); ++row) {
    if (row < 0) columns = columns_before(line);
    std::size_t end = 0;
    for (long column = 0; column < columns; ++column) end = line.find(',', end + (column > 0 ? 1 : 0));
    without += line.substr(0, end) + "\n";
    part += line.substr(0, end) +
            (row < 0 ? ",total_energy_J_per_m,wall_power_W_per_m" : ",1.5e-12," + std::to_string(row)) + "\n";
  }
  write_file(folder.path() / "series.csv", without);
  CHECK_FALSE(report_data(folder.path())["series"].contains("total_energy_J_per_m"));
  write_file(folder.path() / "series.csv", part);
  const Json series = report_data(folder.path())["series"];
  CHECK(series["total_energy_J_per_m"][4] == 1.5e-12);
  CHECK(series["wall_power_W_per_m"] == Json::array({0, 1, 2, 3, 4}));
  CHECK_FALSE(series.contains("kinetic_energy_J_per_m"));
}

TEST_CASE("a run that was killed has a report too") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  {
    RunDirectory run(folder.path(), scene);
    run.write(small_snapshot(0));
    run.write(small_snapshot(1));
  }
  std::filesystem::resize_file(folder.path() / "cells.csv",
                               std::filesystem::file_size(folder.path() / "cells.csv") - 10);
  const Json data = embedded(read_text(write_report(folder.path())));
  CHECK(data["summary"].is_null());
  CHECK(data["step"] == Json::array({0}));
}

TEST_CASE("a run that was killed after a checkpoint shows the frames of all its segments") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  {
    RunDirectory run(folder.path(), scene);
    for (long step = 0; step < 5; ++step) {
      run.write(small_snapshot(step, step == 3));
      if (step == 1) run.mark();
    }
    run.mark();
  }
  REQUIRE(std::filesystem::exists(folder.path() / "frames-0002.h5"));
  const Json data = report_data(folder.path());
  CHECK(data["step"] == Json::array({0, 1, 2, 3, 4}));
  CHECK(data["outlines"]["nodes"].size() == 5);
  CHECK(data["fields"]["outputs"] == Json::array({3}));
  write_file(folder.path() / "frames-0002.h5", "half");
  CHECK(report_data(folder.path())["step"] == Json::array({0, 1}));
}

TEST_CASE("the report of a run whose cells come and leave has each while it is there") {
  const ScratchFolder folder;
  {
    RunDirectory run(folder.path(), open_scene());
    for (std::size_t output = 0; output < cells_of_open_run.size(); ++output)
      run.write(snapshot_of(static_cast<long>(output), cells_of_open_run[output]));
    run.finish(to_json(small_summary()));
  }
  const Json data = report_data(folder.path());
  CHECK(data["step"] == Json::array({0, 1, 2, 3, 4, 5}));
  CHECK(data["shown"]["damage"].empty());
  CHECK(data["series"]["cells_inside"] == Json::array({2, 2, 1, 0, 1, 3}));
  const Json& cells = data["cells"];
  CHECK(cells["ids"] == Json::array({0, 1, 2, 3, 4}));
  CHECK(cells["types"] == Json::array({"type 0", "type 1", "type 0", "type 1", "type 0"}));
  CHECK(cells["from"] == Json::array({0, 0, 1, 4, 5}));
  CHECK(cells["deformation"] ==
        Json::array({{0, 0}, Json::array({0.1}), {0.2, 0.2, nullptr, nullptr, 0.2}, {0.3, 0.3}, Json::array({0.4})}));
  CHECK(cells["aggregate"][0] == Json::array({0, 1}));
  CHECK(cells["aggregate"][1] == Json::array({0, nullptr, 2}));
  CHECK(cells["aggregate"][3] == Json::array());
  CHECK(cells["aggregate"][5] == Json::array({nullptr, nullptr, 2, 2, 4}));
  // They move 1 um in 0.1 s; a cell that is there once has no speed.
  CHECK(cells["speed_um_per_s"][0] == Json::array({10, 10}));
  CHECK(cells["speed_um_per_s"][4] == Json::array({nullptr}));
  const Json& outlines = data["outlines"];
  CHECK(outlines["cells"] == cells["ids"]);
  CHECK(outlines["first"] == Json::array({0, 32, 64, 96, 128, 160}));
  CHECK(outlines["there"] ==
        Json::array({{0, 1}, {0, 2}, Json::array({2}), Json::array(), Json::array({3}), {2, 3, 4}}));
  CHECK(outlines["nodes"][3] == "");
  CHECK(outlines["origin_um"][1].size() == 4);
  CHECK(outlines["origin_um"][1][2].get<double>() == Approx(2 + 6 + 1).margin(0.01));
  // A run that goes on may lack the last rows of cells.csv: what is there whole is shown.
  std::filesystem::remove(folder.path() / "summary.json");
  std::filesystem::resize_file(folder.path() / "cells.csv",
                               std::filesystem::file_size(folder.path() / "cells.csv") - 10);
  CHECK(report_data(folder.path())["step"] == Json::array({0, 1, 2, 3, 4}));
}

TEST_CASE("a report without frames says why, and one without cells or outputs is still a report") {
  const ScratchFolder folder;
  finished_run(folder.path() / "a", "a");
  write_file(folder.path() / "a/frames.h5", "damaged");
  const Json data = report_data(folder.path() / "a");
  CHECK(data["outlines"].is_null());
  CHECK_THAT(data["shown"]["note"].get<std::string>(), Contains("frames.h5"));
  CHECK(data["step"].size() == 5);

  const Scene scene = small_scene();
  RunDirectory run(folder.path() / "b", scene);
  auto fluid_only = small_snapshot(0, true);
  fluid_only.cells.clear();
  fluid_only.contacts.clear();
  fluid_only.membranes = {};
  run.write(fluid_only);
  run.finish(to_json(small_summary()));
  CHECK(report_data(folder.path() / "b")["cells"].is_null());
  RunDirectory(folder.path() / "c", scene).finish(to_json(small_summary()));
  CHECK(report_data(folder.path() / "c")["step"].empty());
}

TEST_CASE("a report does without what is too large to be read, and says so") {
  const ScratchFolder folder;
  const auto run = folder.path() / "run";
  finished_run(run, "many cells");
  SECTION("of cells.csv") {
    std::filesystem::resize_file(run / "cells.csv", 1'100'000'000);
    const Json data = report_data(run);
    CHECK_THAT(data["shown"]["note"].get<std::string>(),
               Contains("cells.csv has 1100 MB, and a page is made of up to 1000"));
    CHECK(data["cells"].is_null());
    CHECK(data["outlines"].is_null());
    CHECK(data["step"].size() == 5);
    CHECK_FALSE(data["series"].empty());
  }
  SECTION("of a frame") {
    std::filesystem::remove(run / "frames.h5");
    {
      hdf5::File file(run / "frames.h5", hdf5::File::Mode::create);
      file.attribute("/", "size_m", std::vector<double>{20e-6, 10e-6});
      file.attribute("/", "periodic_y", 0L);
      for (const char* group : {"/frames", "/frames/000000", "/frames/000000/membranes"}) file.make_group(group);
      static_cast<void>(file.begin("/frames/000000/membranes/points", {20'000'001, 2}, false, H5T_IEEE_F64LE,
                                   H5T_NATIVE_DOUBLE, "m"));
    }
    const Json data = report_data(run);
    CHECK_THAT(data["shown"]["note"].get<std::string>(), Contains("a frame has 20000001 nodes of membranes"));
    CHECK(data["outlines"].is_null());
    CHECK_FALSE(data["cells"].is_null());
  }
}

TEST_CASE("a directory that is no run's is bad input") {
  const ScratchFolder folder;
  try {
    write_report(folder.path());
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    CHECK_THAT(error.what(), Contains("summary.json"));
  }
}

TEST_CASE("a long run is thinned to outputs that include its ends and every change of the aggregates") {
  std::vector<double> count(5000, 4);
  std::fill(count.begin() + 3333, count.end(), 2);
  const auto shown = shown_outputs(count, 400);
  CHECK(shown.size() <= 402);
  CHECK(shown.front() == 0);
  CHECK(shown.back() == 4999);
  CHECK(std::find(shown.begin(), shown.end(), 3332) != shown.end());
  CHECK(std::find(shown.begin(), shown.end(), 3333) != shown.end());
  CHECK(shown_outputs({1, 1, 1}, 400) == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("base64 is RFC 4648's") {
  const auto encoded = [](const std::string& text) { return base64({text.begin(), text.end()}); };
  CHECK(encoded("").empty());
  CHECK(encoded("f") == "Zg==");
  CHECK(encoded("fo") == "Zm8=");
  CHECK(encoded("foobar") == "Zm9vYmFy");
}
