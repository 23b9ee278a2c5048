#include "study_files.hpp"

#include <algorithm>
#include <cmath>

#include "analysis_json.hpp"
#include "fingerprint.hpp"
#include "output/run_directory.hpp"
#include "output/study_page.hpp"
#include "output/summary.hpp"
#include "output/tables.hpp"
#include "result_directory.hpp"
#include "run/provenance.hpp"
#include "spread.hpp"

namespace rouleau::host {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Median, range and all of what the repeats took.
json spread_json(const std::vector<double>& values) {
  const Spread spread = spread_of(values);
  return {{"median", number_or_null(spread.median)},
          {"least", number_or_null(spread.least)},
          {"most", number_or_null(spread.most)},
          {"all", values}};
}

/// Passes of the run whose time is the median, or next below it.
json median_passes(const std::vector<TimedRun>& runs) {
  if (runs.empty()) return json::array();
  std::vector<const TimedRun*> sorted;
  sorted.reserve(runs.size());
  for (const TimedRun& run : runs) sorted.push_back(&run);
  std::sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->wall_s < b->wall_s; });
  return sorted[(sorted.size() - 1) / 2]->passes;
}

json point_json(const Study& study, const MatrixPoint& point) {
  const PointRecord& record = *point.record;
  std::vector<double> wall, cpu;
  for (const TimedRun& run : record.runs) {
    wall.push_back(run.wall_s);
    cpu.push_back(run.cpu_s);
  }
  return {{"id", point.id},
          {"labels", labels_of(study.axes, point.point)},
          {"directory", "points/" + directory_name(point.fingerprint)},
          {"status", to_string(record.end)},
          {"failure", record.failure},
          {"not_deterministic", record.difference.empty() ? json(nullptr) : json(record.difference)},
          {"wall_s", spread_json(wall)},
          {"cpu_s", spread_json(cpu)},
          {"steps", record.steps},
          {"peak_rss_bytes", record.peak_rss_bytes},
          {"threads", point.threads},
          {"passes", median_passes(record.runs)},
          {"results", json::object()}};
}

std::string csv_field(const json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? csv_text(value.get<std::string>()) : value.dump();
}

std::string csv_line(const json& fields) {
  std::string line;
  for (const json& field : fields) line += (&field == &fields.front() ? "" : ",") + csv_field(field);
  return line + '\n';
}

}  // namespace

json study_json(const StudyState& state) {
  const Study& study = *state.study;
  json points = json::array(), left_out = json::array(), tried = json::array();
  for (const MatrixPoint& point : state.points) {
    points.push_back(point.record ? point_json(study, point) : json::object());
    if (!point.record)
      left_out.push_back({{"labels", labels_of(study.axes, point.point)},
                          {"why", point.left_out},
                          {"estimated_s", number_or_null(point.estimated_s)}});
  }
  json result = {{"rouleau_study_result", 1},
                 {"title", study.title},
                 {"study_file", study.file.string()},
                 {"scene_file", study.scene_file.string()},
                 {"program", program_version()},
                 {"program_sha256", program_sha256()},
                 {"machine", machine_json()},
                 {"started", state.started},
                 {"finished", state.finished.empty() ? json(nullptr) : json(state.finished)},
                 {"complete", state.complete()},
                 {"left_out", left_out},
                 {"axes", axes_json(study.axes)},
                 {"line", study.line < 0 ? json(nullptr) : json(study.axes[static_cast<std::size_t>(study.line)].name)},
                 {"default", labels_of(study.axes, study.default_point)},
                 {"points", points},
                 {"target", state.target}};
  const StudyData data = study_data(state);
  add_analysis(result, data, analyse(data));
  for (const MatrixPoint& point : state.points) {
    if (point.record) tried.push_back(result["points"][static_cast<std::size_t>(point.id)]);
  }
  result["points"] = tried;
  return result;
}

std::string study_csv(const json& study) {
  json head = {"id"};
  for (const json& axis : study["axes"]) head.push_back(axis["name"]);
  for (const char* name : {"status", "failure", "failure_step", "wall_s", "wall_least_s", "wall_most_s", "runs",
                           "cpu_s", "steps", "peak_rss_bytes", "threads"})
    head.push_back(name);
  for (const json& quantity : study["quantities"]) {
    const std::string name = quantity["name"];
    for (const char* what : {"", " error", " uncertainty"}) head.push_back(name + what);
  }
  std::string table = csv_line(head);
  for (const json& point : study["points"]) {
    json row = {point["id"]};
    for (const json& axis : study["axes"]) row.push_back(point["labels"][axis["name"].get<std::string>()]);
    const json& failure = point["failure"];
    row.push_back(point["status"]);
    row.push_back(failure.is_null() ? json() : failure["reason"]);
    row.push_back(failure.is_null() ? json() : failure["step"]);
    for (const char* which : {"median", "least", "most"}) row.push_back(point["wall_s"][which]);
    row.push_back(point["wall_s"]["all"].size());
    row.push_back(point["cpu_s"]["median"]);
    for (const char* name : {"steps", "peak_rss_bytes", "threads"}) row.push_back(point[name]);
    for (const json& quantity : study["quantities"]) {
      const json result = point["results"].value(quantity["name"].get<std::string>(), json::object());
      for (const char* what : {"value", "error", "uncertainty"}) row.push_back(result.value(what, json()));
    }
    table += csv_line(row);
  }
  return table;
}

void write_study_files(const StudyState& state, const fs::path& directory) {
  const json study = study_json(state);
  write_file(directory / "study.csv", study_csv(study));
  write_file(directory / "study.json", study.dump(2, ' ', false, json::error_handler_t::replace) + '\n');
  write_study_page(directory);
}

}  // namespace rouleau::host
