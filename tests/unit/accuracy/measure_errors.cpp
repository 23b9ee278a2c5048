// Companions of whole runs, each in a process of its own.
#include "accuracy/measure_errors.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "files/verify.hpp"
#include "json/document.hpp"
#include "plan/read_scene.hpp"
#include "scratch_folder.hpp"
#include "trial/trial.hpp"

using namespace rouleau;
using namespace rouleau::accuracy;

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json capsule(double strain) {
  Json scene = json::Document::read(std::string(ROULEAU_PHYSICS_SCENES) + "/capsule.json").root();
  scene["domain"]["nodes"] = {128, 64};
  scene["cell_types"]["capsule"]["segments"] = 63;
  scene["numerics"].update({{"slip_correction", true}, {"area_correction", true}, {"density_factor", 3000}});
  scene["stages"][0]["strain"] = strain;
  return scene;
}

/// A finished run, as the program leaves it.
class FinishedRun {
 public:
  explicit FinishedRun(const Json& scene) {
    trial::Trial trial{scene, folder_.path() / "scene.json", folder_.path() / "run"};
    trial.program = ROULEAU_PROGRAM;
    trial.written_scene = folder_.path() / "scene.json";
    REQUIRE(trial::run_trial(trial).end == trial::TrialEnd::completed);
    scene_.emplace(plan::read_scene(folder_.path() / "scene.json"));
  }
  [[nodiscard]] fs::path directory() const { return folder_.path() / "run"; }
  [[nodiscard]] const scene::Scene& scene() const { return *scene_; }
  [[nodiscard]] MeasureOptions options() const { return {.catalog = catalog_, .quiet = true}; }
  [[nodiscard]] Json summary() const { return trial::read_summary(directory()); }

 private:
  test::ScratchFolder folder_;
  std::optional<scene::Scene> scene_;
  plugin::Catalog catalog_{std::vector<fs::path>{ROULEAU_PLUGINS}};
};

}  // namespace

TEST_CASE("the bars of a steady capsule hold the boundary-integral solution and are of its size") {
  const FinishedRun run(capsule(8));
  CHECK(finished_run(run.directory(), run.scene()) == Finished::without_bars);
  const MeasuredErrors errors = measure_errors(run.directory(), run.scene(), run.options());
  REQUIRE(errors.missing.empty());
  const Json bars = run.summary()["error_bars"];
  // tests/reference/capsule_channel.json, Ca 0.05, viscosity ratio 1
  const double deformation = 0.2846106, angle = 30.258 * M_PI / 180, viscosity = 1 + 2.1569 * M_PI / (12.8 * 6.4);
  const auto holds = [&](const std::string& name, double reference, double widest) {
    const double value = bars.at(name).at("value"), error = bars.at(name).at("error");
    INFO(name << " " << value << " +- " << error << ", reference " << reference << ": " << bars.at(name).at("how"));
    CHECK(std::abs(value - reference) <= error);
    CHECK(error < widest * reference);
  };
  holds("deformation", deformation, 0.02);
  holds("angle_rad", angle, 0.02);
  holds("relative_viscosity", viscosity, 0.01);
  // What the run wrote is as it was, and the summary sealed again; nothing of the companions stays.
  CHECK(files::verify(run.directory()).differences.empty());
  CHECK_FALSE(fs::exists(run.directory() / files::companions_folder));
  CHECK(run.summary()["error_bar_runs"]["companions"].size() == 3);
  CHECK(finished_run(run.directory(), run.scene()) == Finished::with_bars);
}

TEST_CASE("interrupted companions leave the run as it was, and those that have ended are not run again") {
  const FinishedRun run(capsule(0.5));
  const std::string before = files::scene_text(*run.scene().document) + run.summary().dump();
  const std::atomic<bool> interrupted = true;
  MeasureOptions options = run.options();
  options.interrupted = &interrupted;
  const MeasuredErrors none = measure_errors(run.directory(), run.scene(), options);
  CHECK(none.interrupted);
  CHECK(files::scene_text(*run.scene().document) + run.summary().dump() == before);
  CHECK(finished_run(run.directory(), run.scene()) == Finished::without_bars);
  options.interrupted = nullptr;
  const MeasuredErrors errors = measure_errors(run.directory(), run.scene(), options);
  CHECK(errors.missing.empty());
  CHECK(errors.bars.size() > 5);
}

TEST_CASE("a companion that does not complete gives no bar to anything, and says why") {
  const FinishedRun run(capsule(0.5));
  const plugin::Catalog empty(std::vector<fs::path>{});
  const MeasuredErrors errors = measure_errors(run.directory(), run.scene(), {.catalog = empty, .quiet = true});
  CHECK(errors.missing.find("did not complete") != std::string::npos);
  const Json summary = run.summary();
  for (const auto& [name, bar] : summary["error_bars"].items()) {
    CHECK(bar["error"].is_null());
    CHECK(bar["how"] == errors.missing);
  }
  CHECK(summary["error_bars"].contains("deformation"));
  CHECK(files::verify(run.directory()).differences.empty());
}

TEST_CASE("companions that diverged are followed by others that take shorter steps") {
  Json scene = capsule(9);  // stiff, viscous, beside the middle
  scene["domain"]["nodes"] = {160, 80};
  scene["cells"][0]["at"] = {25.6e-6, 6.4e-6};
  Json& cell = scene["cell_types"]["capsule"];
  cell.update({{"segments", 78}, {"interior_viscosity", 6e-3}});
  cell["membrane"][0]["parameters"]["shear_modulus"] = 7.68e-6;
  cell["membrane"][1]["parameters"]["modulus"] = 1.2288e-18;
  scene["numerics"].update({{"tau", 3}, {"density_factor", 1296}, {"coupling", "auto"}});
  scene["output"]["cells"]["strain"] = 0.5;
  const FinishedRun run(scene);
  const MeasuredErrors errors = measure_errors(run.directory(), run.scene(), run.options());
  CHECK(errors.missing.empty());
  const Json companions = run.summary()["error_bar_runs"]["companions"];
  const auto ended = [&](const std::string& end) {
    return std::count_if(companions.begin(), companions.end(), [&](const Json& one) { return one["end"] == end; });
  };
  CHECK(ended("diverged") == 1);
  CHECK(companions.back()["end"] == "completed");
  CHECK(companions.back()["role"] == "inertia");
  CHECK(run.summary()["error_bars"]["deformation"]["error"] > 0);
}

TEST_CASE("nothing is added to a summary that was changed") {
  const FinishedRun run(capsule(0.5));
  const fs::path file = run.directory() / "summary.json";
  std::string text = files::read_text(file);
  text.replace(text.find("completed"), 9, "completeD");
  std::ofstream(file) << text;
  CHECK_THROWS_AS(files::amend_summary(run.directory(), {{"error_bars", Json::object()}}), Error);
  CHECK(files::read_text(file) == text);
}
