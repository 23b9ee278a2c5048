// What a campaign keeps of its runs, and when it runs them again.
#include "trial/campaign.hpp"

#include <catch2/catch.hpp>

#include "unit/study/study_folder.hpp"

namespace {

using namespace rouleau::test;
using namespace rouleau::trial;
namespace fs = std::filesystem;

const std::string fingerprint(64, 'a');

class SmallCampaign {
 public:
  SmallCampaign() {
    file_.scene = couette_scene();
    file_.scene_file = folder_ / "scene.json";
    file_.time_limit_s = 60;
  }

  CampaignFile& file() { return file_; }
  [[nodiscard]] Campaign open() const {
    return Campaign(study_kind, file_, {.directory = folder_ / "out", .quiet = true, .program = ROULEAU_PROGRAM});
  }
  /// Runs the scene and keeps it, as if it had ended so.
  [[nodiscard]] TrialEnd run_and_keep(const Campaign& campaign) const {
    const TrialResult result = campaign.run(campaign.trial_of(file_.scene, fingerprint));
    std::optional<PointRecord> record;
    campaign.keep(record, fingerprint, result);
    return result.end;
  }

 private:
  StudyFolder folder_;
  CampaignFile file_;
};

}  // namespace

TEST_CASE("a run is found again where it is kept, with its summary") {
  const SmallCampaign small;
  const Campaign campaign = small.open();
  CHECK_FALSE(campaign.find(fingerprint));
  CHECK(small.run_and_keep(campaign) == TrialEnd::completed);
  const auto record = campaign.find(fingerprint);
  REQUIRE(record);
  const fs::path directory = campaign.directory_of(fingerprint);
  CHECK(result_of(*record, directory).summary["status"] == "completed");
  CHECK(fs::exists(directory.string() + ".scene.json"));
  CHECK_FALSE(fs::exists(directory.string() + ".running"));
  CHECK_FALSE(campaign.find(std::string(64, 'b')));
}

TEST_CASE("a run that was refused keeps its message, and has no directory") {
  SmallCampaign small;
  small.file().scene["numerics"]["tau"] = 0.2;  // at most 0.5: unstable
  const Campaign campaign = small.open();
  CHECK(small.run_and_keep(campaign) == TrialEnd::refused);
  const TrialResult kept = result_of(campaign.find(fingerprint).value(), campaign.directory_of(fingerprint));
  CHECK(kept.end == TrialEnd::refused);
  CHECK(kept.message.find("/numerics/tau") != std::string::npos);
  CHECK(kept.summary.is_null());
}

TEST_CASE("a diverged run whose summary is gone must be run again") {
  SmallCampaign small;
  small.file().scene["stages"][0]["shear_rate"] = "1e7 1/s";
  small.file().scene["checks"]["every_steps"] = 1;
  const Campaign campaign = small.open();
  CHECK(small.run_and_keep(campaign) == TrialEnd::diverged);
  CHECK(campaign.find(fingerprint));
  fs::remove(campaign.directory_of(fingerprint) / "summary.json");
  CHECK_FALSE(campaign.find(fingerprint));
}

TEST_CASE("a run that did not end in time is run again only with more of it") {
  SmallCampaign small;
  small.file().scene["stages"][0]["duration"] = "1000 s";
  small.file().time_limit_s = 0.5;
  const Campaign campaign = small.open();
  CHECK(small.run_and_keep(campaign) == TrialEnd::timed_out);
  CHECK(campaign.find(fingerprint));
  small.file().time_limit_s = 0.4;
  CHECK(campaign.find(fingerprint));
  small.file().time_limit_s = 1;
  CHECK_FALSE(campaign.find(fingerprint));
}

TEST_CASE("two campaigns cannot write into one directory") {
  const SmallCampaign small;
  const Campaign first = small.open();
  CHECK_THROWS_WITH(small.open(), Catch::Contains("another study is writing into"));
}

TEST_CASE("a CSV line quotes texts, writes numbers whole, and leaves null empty") {
  CHECK(csv_line({"a, b", nullptr, 0.1, 7, true}) == "\"a, b\",,0.1,7,true\n");
}
