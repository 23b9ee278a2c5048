#include "report/report.hpp"

#include <catch2/catch.hpp>

#include "files/file.hpp"
#include "unit/run_fixture.hpp"

using rouleau::Cause;
using rouleau::Error;
using namespace rouleau::files;
using namespace rouleau::report;
using namespace rouleau::scene;
using namespace rouleau::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

Json data_of_page(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const auto from = page.find(begin) + begin.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

Json study_result(const std::string& title) {
  return {{"rouleau_study_result", 1}, {"title", title}, {"points", Json::array()}, {"quantities", Json::array()}};
}

Json limits_result(const std::string& title) {
  return {{"rouleau_limits_result", 1}, {"title", title}, {"edges", Json::array()}};
}

std::string page_refusal(const std::filesystem::path& directory) {
  try {
    write_pages(directory);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return error.what();
  }
  FAIL("no error");
  return {};
}

}  // namespace

TEST_CASE("study.html and limits.html are files without anything to fetch, with the whole result in them") {
  const ScratchFolder folder;
  Json study = study_result("shear");
  study["points"] = {{{"id", 0}, {"results", {{"deformation", {{"value", nullptr}, {"why_not", "it crashed"}}}}}}};
  write_file(folder.path() / "study.json", study.dump());
  write_file(folder.path() / "limits.json", limits_result("stiffness").dump());
  CHECK(write_study_page(folder.path()) == folder.path() / "study.html");
  CHECK(write_limits_page(folder.path()) == folder.path() / "limits.html");
  CHECK(data_of_page(read_text(folder.path() / "study.html")) == study);
  CHECK(data_of_page(read_text(folder.path() / "limits.html")) == limits_result("stiffness"));
  for (const char* name : {"study.html", "limits.html"}) {
    const std::string page = read_text(folder.path() / name);
    CHECK_THAT(page, !Contains("src=") && !Contains("@import") && !Contains("<link rel=\"stylesheet\""));
    CHECK_THAT(page, !Contains("@include") && !Contains("@ROULEAU_DATA@"));
  }
}

TEST_CASE("text from a study or limits cannot end the page's data or become markup") {
  const ScratchFolder folder;
  const std::string title = "</script><script>alert(1)</script><!-- \"'&";
  write_file(folder.path() / "study.json", study_result(title).dump());
  write_file(folder.path() / "limits.json", limits_result(title).dump());
  for (const auto& file : write_pages(folder.path())) {
    const std::string page = read_text(file);
    CHECK_THAT(page, !Contains("alert(1)</script>") && !Contains("<!--"));
    CHECK(data_of_page(page)["title"] == title);
  }
}

TEST_CASE("the pages that are made are those of what a directory holds") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  {
    RunDirectory run(folder.path(), scene);
    run.write(small_snapshot(0));
    run.finish(to_json(small_summary()));
  }
  using Files = std::vector<std::filesystem::path>;
  CHECK(write_pages(folder.path()) == Files{folder.path() / "report.html"});
  write_file(folder.path() / "study.json", study_result("").dump());
  CHECK(write_pages(folder.path()) == Files{folder.path() / "study.html", folder.path() / "report.html"});
  std::filesystem::remove(folder.path() / "summary.json");
  std::filesystem::remove(folder.path() / "series.csv");
  CHECK(write_pages(folder.path()) == Files{folder.path() / "study.html"});
}

TEST_CASE("a directory without a result, and a file that is none, are bad input") {
  const ScratchFolder folder;
  CHECK_THAT(page_refusal(folder.path()), Contains("the directory of no run, study or limits") &&
                                              Contains("summary.json") && Contains("series.csv") &&
                                              Contains("study.json") && Contains("limits.json"));
  write_file(folder.path() / "study.json", "[1]");
  CHECK_THAT(page_refusal(folder.path()), Contains("study.json:1:1") && Contains("is no study result") &&
                                              Contains("\"rouleau_study_result\"") &&
                                              Contains("make the directory anew"));
  // The study that was run, rather than what came of it
  write_file(folder.path() / "study.json", R"({"rouleau_study": 1, "scene": "a.json"})");
  CHECK_THAT(page_refusal(folder.path()), Contains("is no study result"));
  write_file(folder.path() / "study.json", R"({"rouleau_study_result": 2})");
  CHECK_THAT(page_refusal(folder.path()), Contains("study.json:1:") && Contains("/rouleau_study_result") &&
                                              Contains("is 2") && Contains("version 1"));
  write_file(folder.path() / "study.json", R"({"rouleau_study_result": 1, "points": )");
  CHECK_THAT(page_refusal(folder.path()), Contains("study.json:1:"));
  std::filesystem::remove(folder.path() / "study.json");
  write_file(folder.path() / "limits.json", study_result("").dump());
  CHECK_THAT(page_refusal(folder.path()), Contains("limits.json:1:1") && Contains("is no limits result"));
}
