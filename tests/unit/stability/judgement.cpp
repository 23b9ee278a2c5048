#include "stability/judgement.hpp"

#include <unistd.h>
#include <catch2/catch.hpp>
#include <fstream>

#include "hdf5/hdf5_file.hpp"
#include "stability/limits_run.hpp"

namespace hdf5 = rouleau::hdf5;
using namespace rouleau::files;
using namespace rouleau::stability;
using namespace rouleau::trial;
using Json = nlohmann::json;

namespace {

/// A run's directory as far as judgements look into it.
struct RunToJudge {
  std::filesystem::path folder;
  TrialResult result;

  RunToJudge() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rouleau-XXXXXX").string();
    folder = ::mkdtemp(pattern.data());
    cells("0.5");
    result.end = TrialEnd::completed;
    result.summary = {
        {"status", "completed"},
        {"conservation", {{"area_drift_max", 1e-4}, {"area_leakage_max", nullptr}, {"mass_drift", 1e-12}}},
        {"energy", {{"largest_growth_at_rest_relative", 0}}},
        {"stretch", {{"min", 0.9}, {"max", 1.1}}}};
  }
  ~RunToJudge() { std::filesystem::remove_all(folder); }
  RunToJudge(const RunToJudge&) = delete;
  RunToJudge& operator=(const RunToJudge&) = delete;

  void cells(const std::string& last) const {
    std::ofstream(folder / "cells.csv")
        << "step,cell,x_m,angle_rad,deformation\n0,0,1e-6,nan,0.1\n0,1,1e-6,nan,0.2\n9,0,1e-6,nan," << last
        << "\n9,1,1e-6,nan,0.7\n";
  }
  [[nodiscard]] Judgement judged() const { return judge(result, folder, HealthCriteria()); }
  [[nodiscard]] std::string reason() const { return judged().failure.is_null() ? "" : judged().failure["reason"]; }
};

}  // namespace

TEST_CASE("a run that kept everything is sound", "[judgement]") {
  const RunToJudge run;
  CHECK(run.judged().healthy);
  CHECK(run.judged().failure.is_null());
}

TEST_CASE("a run that ends in silence with something lost has failed", "[judgement]") {
  struct Case {
    const char* pointer;
    double value;
    const char* reason;
  };
  const auto [pointer, value, expected] = GENERATE(
      Case{"/conservation/area_drift_max", 0.03, "area_loss"},
      Case{"/conservation/area_leakage_max", 0.03, "area_loss"}, Case{"/conservation/mass_drift", 0.01, "mass_loss"},
      Case{"/energy/largest_growth_at_rest_relative", 0.1, "energy_growth"}, Case{"/stretch/max", 3.5, "uneven_nodes"},
      Case{"/stretch/min", 0.2, "uneven_nodes"});
  RunToJudge run;
  run.result.summary[Json::json_pointer(pointer)] = value;
  CHECK(run.reason() == expected);
  CHECK_FALSE(run.judged().healthy);
  CHECK(run.judged().end == "completed");
}

TEST_CASE("a shape that is no number has been written, an angle may be none", "[judgement]") {
  const RunToJudge run;
  run.cells("nan");
  CHECK(run.reason() == "no_number_written");
  CHECK(run.judged().failure["message"].get<std::string>().find("deformation in row 3") != std::string::npos);
}

TEST_CASE("in three dimensions a cell has a volume, and no area of a plane", "[judgement]") {
  RunToJudge run;
  const auto cells = [&](const std::string& volume) {
    std::ofstream(run.folder / "cells.csv") << "step,cell,x_m,z_m,area_m2,perimeter_m,deformation,volume_m3\n"
                                            << "0,0,1e-6,1e-6,,,0.1," << volume << '\n';
  };
  cells("1e-16");
  CHECK(run.reason() == "no_number_written");  // of two dimensions it would be
  run.result.summary["dimensions"] = 3;
  CHECK(run.judged().healthy);
  cells("nan");
  CHECK(run.reason() == "no_number_written");
  cells("1e-16");
  run.result.summary["conservation"]["area_drift_max"] = 0.03;
  CHECK(run.judged().failure["message"].get<std::string>().find("its volume") != std::string::npos);
}

TEST_CASE("what is no number in a frame has been written, also where the run was then stopped", "[judgement]") {
  RunToJudge run;
  const auto frame = [&](double last) {
    hdf5::File file(run.folder / "frames.h5", hdf5::File::Mode::create);
    for (const char* group : {"/frames", "/frames/000000", "/frames/000000/fields"}) file.make_group(group);
    file.write("/frames/000000/fields/density", std::vector<double>{1, 2, last}, "kg/m3");
    file.close();
  };
  frame(3);
  CHECK(run.judged().healthy);
  frame(std::nan(""));
  run.result.end = GENERATE(TrialEnd::completed, TrialEnd::diverged);
  run.result.summary["failure"] = {{"reason", "mach"}, {"step", 17}};
  CHECK(run.reason() == "no_number_written");
  CHECK(run.judged().failure["message"] ==
        "/frames/000000/fields/density of frames.h5 holds a value that is no number");
}

TEST_CASE("what the run tells of its failure is passed on", "[judgement]") {
  RunToJudge run;
  run.result.end = TrialEnd::diverged;
  run.result.summary["failure"] = {
      {"reason", "node_step"}, {"step", 17}, {"message", "too fast"}, {"remedy", "slower"}};
  CHECK(run.judged().failure == run.result.summary["failure"]);
}

TEST_CASE("a hang, a crash and a refusal are failures with the words there are", "[judgement]") {
  const TrialEnd end = GENERATE(TrialEnd::timed_out, TrialEnd::crashed, TrialEnd::refused);
  RunToJudge run;
  run.result.end = end;
  run.result.summary = nullptr;
  run.result.message = "words";
  CHECK(run.reason() == to_string(end));
  CHECK(run.judged().failure["message"] == "words");
}
