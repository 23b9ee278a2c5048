// Fingerprints, expected times, locks and targets: the small parts of a study.
#include <catch2/catch.hpp>
#include <thread>

#include "base/error.hpp"
#include "files/file.hpp"
#include "study_folder.hpp"
#include "trial/point_record.hpp"

namespace {

using rouleau::Cause;
using rouleau::Error;
using rouleau::files::FileLock;
using namespace rouleau::study;
using namespace rouleau::test;
using namespace rouleau::trial;
namespace fs = std::filesystem;
using Json = nlohmann::json;
using rouleau::test::couette_scene;
using rouleau::test::StudyFolder;

/// A plugin's folder that a test may change.
void copy_plugin(const fs::path& to) {
  fs::create_directories(to);
  fs::copy(fs::path(ROULEAU_PLUGINS) / "collision/bgk/libbgk.so", to / "libbgk.so");
  Json manifest = Json::parse(std::ifstream(fs::path(ROULEAU_SOURCE) / "plugins/collision/bgk/bgk.json"));
  manifest["id"] = "org.example.mine";
  std::ofstream(to / "mine.json") << manifest;
}

}  // namespace

TEST_CASE("a fingerprint changes with scene, threads, lock and plugin, and with nothing else") {
  const StudyFolder folder;
  const fs::path file = folder / "scene.json";
  copy_plugin(folder / "models");
  Json scene = couette_scene();
  scene["plugin_dirs"] = {"models"};
  scene["fluid"]["collision"]["model"] = "org.example.mine";
  const std::string before = fingerprint(scene, file);
  CHECK(before.size() == 64);
  CHECK(fingerprint(scene, file) == before);
  CHECK(fingerprint(Json::parse(scene.dump(4)), file) == before);
  CHECK(fingerprint(scene, file, {"threads 2"}) != before);
  Json other = scene;
  other["numerics"]["tau"] = 0.9;
  CHECK(fingerprint(other, file) != before);

  fs::rename(folder / "models", folder / "moved");
  other = scene;
  other["plugin_dirs"] = {"moved"};
  CHECK(fingerprint(other, file) == before);  // where it lies is no matter
  std::ofstream(folder / "moved/libbgk.so", std::ios::app) << "x";
  const std::string changed = fingerprint(other, file);
  CHECK(changed != before);
  folder.write("scene.lock.json", "{}");
  CHECK(fingerprint(other, file) != changed);
}

TEST_CASE("expected times begin with the plan and follow what was measured") {
  RunCost cost;
  const Point coarse_a{{0, 0}}, fine_a{{1, 0}}, fine_b{{1, 1}}, finest_a{{2, 0}};
  const double unknown = cost.expected_s(coarse_a, 10);
  CHECK(unknown >= 10);
  CHECK(unknown < 11);
  cost.learn(coarse_a, 1, 2, 2.5);  // twice the plan's estimate, and half a second beside
  CHECK(cost.expected_s(fine_b, 10) == Approx(20.5));
  cost.learn(fine_b, 10, 50, 50.5);
  CHECK(cost.expected_s(Point{{2, 1}}, 100) == Approx(500.5));  // of its own method
  CHECK(cost.expected_s(finest_a, 100) == Approx(200.5));
  cost.learn(fine_a, 10, 30, 30.5);
  CHECK(cost.expected_s(finest_a, 100) == Approx(300.5));  // of its own method's longest
}

TEST_CASE("a lock is held by one and waited for by others, who are told") {
  const StudyFolder folder;
  FileLock first(folder / "lock"), second(folder / "lock");
  CHECK(first.take());
  CHECK_FALSE(second.take());
  bool waited = false;
  std::thread release([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    first.release();
  });
  CHECK(second.wait([&] { waited = true; }, nullptr));
  release.join();
  CHECK(waited);
  const std::atomic<bool> interrupted = true;
  CHECK_FALSE(first.wait([] {}, &interrupted));
}

TEST_CASE("a directory can be locked as a file can") {
  const StudyFolder folder;
  FileLock first(folder.path()), second(folder.path());
  CHECK(first.take());
  CHECK_FALSE(second.take());
}
