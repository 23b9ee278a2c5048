#include "analysis_json.hpp"

#include <algorithm>
#include <cmath>

#include "json/shown.hpp"
#include "report/report.hpp"
#include "run/summary.hpp"
#include "trial/campaign.hpp"
#include "trial/point_record.hpp"

namespace rouleau::study {

namespace {

using Json = nlohmann::json;

Json said(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json labels_json(const StudyData& study, const std::vector<int>& setting) {
  Json labels = Json::object();
  for (std::size_t i = 0; i < setting.size(); ++i)
    if (setting[i] >= 0) labels[study.axes[i].name] = study.axes[i].labels[setting[i]];
  return labels;
}

Json reference_json(const ResolvedReference& reference) {
  return {{"kind", name_of(reference.kind)},
          {"value", json::number_or_null(reference.value)},
          {"uncertainty", json::number_or_null(reference.uncertainty)},
          {"order", json::number_or_null(reference.order)},
          {"source", said(reference.source)},
          {"points", reference.points},
          {"why_not", said(reference.why_not)}};
}

Json quantity_json(const StudyData& study, const Quantity& quantity, const QuantityAnalysis& analysis) {
  Json methods = Json::array();
  for (const MethodLimit& method : analysis.by_method) {
    const Extrapolation& e = method.extrapolation;
    methods.push_back({{"method", labels_json(study, method.setting)},
                       {"order", json::number_or_null(e.order)},
                       {"limit", json::number_or_null(e.limit)},
                       {"uncertainty", json::number_or_null(e.uncertainty)},
                       {"points", method.used},
                       {"why_not", said(e.remark)}});
  }
  return {{"name", quantity.name},           {"kind", name_of(quantity.kind)},
          {"unit", quantity.unit},           {"error", quantity.error == ErrorKind::relative ? "relative" : "absolute"},
          {"target", quantity.target},       {"reference", reference_json(analysis.reference)},
          {"by_method", std::move(methods)}, {"disagreement", said(analysis.disagreement)}};
}

Json sensitivities_json(const StudyData& study, const std::vector<Sensitivity>& sensitivities) {
  Json result = Json::array();
  for (const Sensitivity& sensitivity : sensitivities) {
    std::vector<int> fixed = study.points[sensitivity.from].setting;
    const auto label = [&](std::size_t point) {
      return study.axes[sensitivity.axis].labels[study.points[point].setting[sensitivity.axis]];
    };
    fixed[sensitivity.axis] = -1;
    result.push_back({{"axis", study.axes[sensitivity.axis].name},
                      {"from", label(sensitivity.from)},
                      {"to", label(sensitivity.to)},
                      {"fixed", labels_json(study, fixed)},
                      {"error_factor", sensitivity.error_factor},
                      {"time_factor", sensitivity.time_factor},
                      {"gain", json::number_or_null(sensitivity.gain)},
                      {"free", std::isinf(sensitivity.gain)}});
  }
  return result;
}

namespace fs = std::filesystem;

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

StudyAxis axis_data(const trial::Axis& axis) {
  StudyAxis data{axis.name, {}, {}, true};
  for (const trial::Setting& setting : axis.settings) {
    data.labels.push_back(setting.label);
    data.ordered = data.ordered && std::isfinite(setting.position);
    // Radii or heights in spacings: only ratios matter.
    if (axis.refines) data.spacing.push_back(1 / setting.position);
  }
  return data;
}

}  // namespace

void add_analysis(Json& result, const StudyData& study, const std::vector<QuantityAnalysis>& analyses) {
  Json quantities = Json::array(), fronts = Json::object(), sensitivities = Json::object(), sentences = Json::array();
  for (std::size_t q = 0; q < analyses.size(); ++q) {
    const Quantity& quantity = study.quantities[q];
    quantities.push_back(quantity_json(study, quantity, analyses[q]));
    fronts[quantity.name] = analyses[q].front;
    sensitivities[quantity.name] = sensitivities_json(study, analyses[q].sensitivities);
    for (const StudySentence& sentence : analyses[q].sentences) {
      sentences.push_back({{"quantity", quantity.name},
                           {"text", sentence.text},
                           {"target", json::number_or_null(sentence.target)},
                           {"point", sentence.point ? Json(*sentence.point) : Json()}});
    }
    for (std::size_t i = 0; i < study.points.size(); ++i) {
      const PointError& error = analyses[q].errors[i];
      result["points"][i]["results"][quantity.name] = {{"value", json::number_or_null(error.value)},
                                                       {"error", json::number_or_null(error.error)},
                                                       {"deviation", json::number_or_null(error.deviation)},
                                                       {"uncertainty", json::number_or_null(error.uncertainty)},
                                                       {"why_not", said(error.why_not)}};
    }
  }
  result["quantities"] = std::move(quantities);
  result["fronts"] = std::move(fronts);
  result["knobs"] = std::move(sensitivities);
  result["sentences"] = std::move(sentences);
}

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
  for (const MatrixPoint& point : state.points)
    if (point.record) tried.push_back(result["points"][point.id]);
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

bool StudyState::complete() const {
  return std::all_of(points.begin(), points.end(), [](const MatrixPoint& point) { return point.left_out.empty(); });
}

void measure_point(const Study& study, MatrixPoint& point, const std::filesystem::path& directory) {
  point.results.clear();
  for (const Quantity& quantity : study.quantities)
    if (point.record->end == trial::TrialEnd::completed)
      point.results.push_back(measure(quantity, directory));
    else
      point.results.push_back({NAN, 0, "the run did not complete: " + trial::to_string(point.record->end)});
}

StudyData study_data(const StudyState& state) {
  const Study& study = *state.study;
  StudyData data;
  for (const trial::Axis& axis : study.axes) data.axes.push_back(axis_data(axis));
  data.line = study.line;
  data.default_setting = study.default_point.setting;
  data.quantities = study.quantities;
  for (const MatrixPoint& point : state.points) {
    std::vector<double> times;
    if (point.record && point.record->end == trial::TrialEnd::completed)
      for (const trial::TimedRun& run : point.record->runs) times.push_back(run.wall_s);
    const trial::MedianRange wall = trial::median_range(times);
    data.points.push_back({point.point.setting, wall.median, point.results, {wall.least, wall.most}});
  }
  return data;
}

}  // namespace rouleau::study
