#include "study_files.hpp"

#include <algorithm>
#include <cmath>

#include "analysis_json.hpp"
#include "json/number_or_null.hpp"
#include "report/result_page.hpp"
#include "trial/campaign.hpp"
#include "trial/fingerprint.hpp"
#include "trial/median_range.hpp"

namespace rouleau::study {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Median, range and all of what the repeats took.
Json median_range_json(const std::vector<double>& values) {
  const trial::MedianRange range = trial::median_range(values);
  return {{"median", json::number_or_null(range.median)},
          {"least", json::number_or_null(range.least)},
          {"most", json::number_or_null(range.most)},
          {"all", values}};
}

/// Passes of the run whose time is the median, or next below it.
Json median_passes(const std::vector<trial::TimedRun>& runs) {
  if (runs.empty()) return Json::array();
  std::vector<const trial::TimedRun*> sorted;
  sorted.reserve(runs.size());
  for (const trial::TimedRun& run : runs) sorted.push_back(&run);
  std::sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->wall_s < b->wall_s; });
  return sorted[(sorted.size() - 1) / 2]->passes;
}

Json point_json(const Study& study, const MatrixPoint& point) {
  const trial::PointRecord& record = *point.record;
  std::vector<double> wall, cpu;
  for (const trial::TimedRun& run : record.runs) {
    wall.push_back(run.wall_s);
    cpu.push_back(run.cpu_s);
  }
  return {{"id", point.id},
          {"labels", trial::labels_of(study.axes, point.point)},
          {"directory", "points/" + trial::directory_name(point.fingerprint)},
          {"status", trial::to_string(record.end)},
          {"failure", record.failure},
          {"not_deterministic", record.difference.empty() ? Json(nullptr) : Json(record.difference)},
          {"wall_s", median_range_json(wall)},
          {"cpu_s", median_range_json(cpu)},
          {"steps", record.steps},
          {"peak_rss_bytes", record.peak_rss_bytes},
          {"threads", point.threads},
          {"passes", median_passes(record.runs)},
          {"results", Json::object()}};
}

}  // namespace

Json study_json(const StudyState& state) {
  const Study& study = *state.study;
  Json points = Json::array(), left_out = Json::array(), tried = Json::array();
  for (const MatrixPoint& point : state.points) {
    points.push_back(point.record ? point_json(study, point) : Json::object());
    if (!point.record)
      left_out.push_back({{"labels", trial::labels_of(study.axes, point.point)},
                          {"why", point.left_out},
                          {"estimated_s", json::number_or_null(point.estimated_s)}});
  }
  Json result = trial::result_head(trial::study_kind, study, state.started, state.finished, state.complete());
  result.update({{"left_out", left_out},
                 {"line", study.line < 0 ? Json(nullptr) : Json(study.axes[study.line].name)},
                 {"default", trial::labels_of(study.axes, study.default_point)},
                 {"points", points}});
  const StudyData data = study_data(state);
  add_analysis(result, data, analyse(data));
  for (const MatrixPoint& point : state.points) {
    if (point.record) tried.push_back(result["points"][point.id]);
  }
  result["points"] = tried;
  return result;
}

std::string study_csv(const Json& study) {
  Json head = {"id"};
  for (const Json& axis : study["axes"]) head.push_back(axis["name"]);
  for (const char* name : {"status", "failure", "failure_step", "wall_s", "wall_least_s", "wall_most_s", "runs",
                           "cpu_s", "steps", "peak_rss_bytes", "threads"})
    head.push_back(name);
  for (const Json& quantity : study["quantities"]) {
    const std::string name = quantity["name"];
    for (const char* what : {"", " error", " uncertainty"}) head.push_back(name + what);
  }
  std::string table = trial::csv_line(head);
  for (const Json& point : study["points"]) {
    Json row = {point["id"]};
    for (const Json& axis : study["axes"]) row.push_back(point["labels"][axis["name"].get<std::string>()]);
    const Json& failure = point["failure"];
    row.push_back(point["status"]);
    row.push_back(failure.is_null() ? Json() : failure["reason"]);
    row.push_back(failure.is_null() ? Json() : failure["step"]);
    for (const char* which : {"median", "least", "most"}) row.push_back(point["wall_s"][which]);
    row.push_back(point["wall_s"]["all"].size());
    row.push_back(point["cpu_s"]["median"]);
    for (const char* name : {"steps", "peak_rss_bytes", "threads"}) row.push_back(point[name]);
    for (const Json& quantity : study["quantities"]) {
      const Json result = point["results"].value(quantity["name"].get<std::string>(), Json::object());
      for (const char* what : {"value", "error", "uncertainty"}) row.push_back(result.value(what, Json()));
    }
    table += trial::csv_line(row);
  }
  return table;
}

void write_study_files(const StudyState& state, const fs::path& directory) {
  const Json study = study_json(state);
  trial::write_result(trial::study_kind, directory, study, study_csv(study));
  report::write_study_page(directory);
}

}  // namespace rouleau::study
