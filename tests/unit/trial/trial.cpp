// Runs in a process of their own: every way in which one can end is a result.
#include "trial/trial.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "trial/point_record.hpp"
#include "unit/study/study_folder.hpp"

namespace {

using namespace rouleau::test;
using namespace rouleau::trial;
namespace fs = std::filesystem;
using rouleau::test::couette_scene;
using rouleau::test::StudyFolder;

Trial trial_in(const StudyFolder& folder) {
  Trial trial{couette_scene(), folder / "scene.json", folder / "run"};
  trial.program = ROULEAU_PROGRAM;
  return trial;
}

/// A program in the place of rouleau, which does as the script says.
fs::path impostor(const StudyFolder& folder, const std::string& script) {
  const fs::path file = folder.write("impostor", "#!/bin/sh\n" + script + "\n");
  chmod(file.c_str(), 0700);
  return file;
}

/// More steps than any test waits for.
nlohmann::json endless_scene() {
  nlohmann::json scene = couette_scene();
  scene["stages"][0]["duration"] = "1000 s";
  return scene;
}

}  // namespace

TEST_CASE("a run that completes leaves its directory, its summary and what it cost") {
  const StudyFolder folder;
  const TrialResult result = run_trial(trial_in(folder));
  CHECK(result.end == TrialEnd::completed);
  CHECK(result.message.empty());
  CHECK(result.summary["status"] == "completed");
  CHECK(result.wall_s >= result.summary["wall_s"].get<double>());
  CHECK(result.cpu_s > 0);
  CHECK(result.peak_rss_bytes > 1'000'000);
  CHECK(fs::exists(folder / "run/frames.h5"));
  CHECK(fs::exists(folder / "run.scene.json"));
}

TEST_CASE("a run replaces the one that its directory held, and is not told by it") {
  const StudyFolder folder;
  Trial trial = trial_in(folder);
  run_trial(trial);
  trial.scene["numerics"]["tau"] = 0.2;  // at most 0.5: unstable
  const TrialResult result = run_trial(trial);
  CHECK(result.end == TrialEnd::refused);
  CHECK(result.summary.is_null());
  CHECK(result.message.find("/numerics/tau") != std::string::npos);
}

TEST_CASE("a run that passes a limit has diverged, with the summary's reason") {
  const StudyFolder folder;
  Trial trial = trial_in(folder);
  trial.scene["stages"][0]["shear_rate"] = "1e7 1/s";
  trial.scene["checks"]["every_steps"] = 1;
  const TrialResult result = run_trial(trial);
  CHECK(result.end == TrialEnd::diverged);
  CHECK(result.summary["failure"]["reason"] == "mach");
  CHECK(result.message.find("mach at step") != std::string::npos);
}

TEST_CASE("a run that takes too long is ended, and its directory is whole") {
  const StudyFolder folder;
  Trial trial = trial_in(folder);
  trial.scene = endless_scene();
  trial.time_limit_s = 3;  // begun by then on a busy machine: a signal before its first step leaves no summary
  const TrialResult result = run_trial(trial);
  CHECK(result.end == TrialEnd::timed_out);
  CHECK(result.wall_s < 20);
  CHECK(result.summary["status"] == "interrupted");
  CHECK(result.message == "not finished after 3 s, the study's time limit");
}

TEST_CASE("a run ends when whoever waits for it is interrupted") {
  const StudyFolder folder;
  Trial trial = trial_in(folder);
  trial.scene = endless_scene();
  std::atomic<bool> interrupted = false;
  trial.interrupted = &interrupted;
  std::thread signal([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    interrupted = true;
  });
  const TrialResult result = run_trial(trial);
  signal.join();
  CHECK(result.end == TrialEnd::interrupted);
  CHECK(result.wall_s < 20);
}

TEST_CASE("a run that a signal ends has crashed, in the system's words and its own") {
  const StudyFolder folder;
  Trial trial = trial_in(folder);
  trial.program = impostor(folder, "echo last words >&2; kill -SEGV $$");
  const TrialResult result = run_trial(trial);
  CHECK(result.end == TrialEnd::crashed);
  CHECK(result.message == "ended by signal 11 (Segmentation fault)\nlast words");
  CHECK(result.summary.is_null());
}

TEST_CASE("a run that hangs and hears no signal is killed") {
  const StudyFolder folder;
  Trial trial = trial_in(folder);
  trial.program = impostor(folder, "trap '' TERM; sleep 1000");
  trial.time_limit_s = 0.2;
  trial.grace_s = 0.3;
  const TrialResult result = run_trial(trial);
  CHECK(result.end == TrialEnd::timed_out);
  CHECK(result.wall_s < 10);
}

TEST_CASE("relative folders of plugins begin where the scene came from") {
  const StudyFolder folder;
  fs::create_directories(folder / "scenes/models");
  Trial trial = trial_in(folder);
  trial.scene_file = folder / "scenes/scene.json";
  trial.scene["plugin_dirs"] = {"models"};
  CHECK(run_trial(trial).end == TrialEnd::completed);
  trial.scene["plugin_dirs"] = {"nowhere"};
  const TrialResult result = run_trial(trial);
  CHECK(result.end == TrialEnd::refused);
  CHECK(result.message.find((folder / "scenes/nowhere").string() + " does not exist") != std::string::npos);
}

TEST_CASE("the key of a result depends on the files that its scene names") {
  const StudyFolder folder;
  folder.write("cell.off", "a"), folder.write("cells.csv", "b");
  nlohmann::json scene = couette_scene();
  scene["cell_types"]["a"]["shape"]["mesh"] = {{"file", "cell.off"}, {"unit", "1 um"}};
  scene["cells"] = {{{"file", "cells.csv"}}};
  const auto key = [&] { return fingerprint(scene, folder / "scene.json"); };
  const std::string first = key();
  CHECK(key() == first);
  for (const char* file : {"cell.off", "cells.csv"}) {
    folder.write(file, "changed");
    CHECK(key() != first);
    folder.write(file, file[4] == '.' ? "a" : "b");
    CHECK(key() == first);
  }
}

TEST_CASE("the lock beside the scene binds its trials") {
  const StudyFolder folder;
  folder.write("scene.lock.json", R"({"lock": 1, "plugins": []})");
  const TrialResult result = run_trial(trial_in(folder));
  CHECK(result.end == TrialEnd::refused);
  CHECK(result.message.find("is not in the lock") != std::string::npos);
}

TEST_CASE("a plan tells steps and time, and nothing where it refuses") {
  const StudyFolder folder;
  Trial trial = trial_in(folder);
  // 10 us over a step of (tau - 1/2)/3 dx^2/nu.
  CHECK(plan_trial(trial)["estimate"]["steps_at_most"] == 288);
  trial.scene["numerics"]["tau"] = 0.2;
  CHECK(plan_trial(trial).is_null());
}
