#include "point_record.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "fingerprint.hpp"

namespace rouleau::trial {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path record_file(const fs::path& points, const std::string& fingerprint) {
  return points / (directory_name(fingerprint) + ".json");
}

Json failure_of(const TrialResult& result) {
  if (result.end == TrialEnd::completed) return nullptr;
  if (result.end == TrialEnd::diverged && result.summary.is_object() && result.summary.contains("failure")) {
    const Json& failure = result.summary["failure"];
    return {{"reason", failure["reason"]},
            {"step", failure["step"]},
            {"message", failure["message"]},
            {"remedy", failure["remedy"]}};
  }
  const Json steps = result.summary.is_object() ? result.summary.value("steps", Json()) : Json();
  return {{"reason", to_string(result.end)}, {"step", steps}, {"message", result.message}, {"remedy", nullptr}};
}

TimedRun run_of(const TrialResult& result) {
  TimedRun run{result.wall_s, result.cpu_s, result.wall_s, Json::array()};
  if (!result.summary.is_object()) return run;
  run.wall_s = result.summary.value("wall_s", result.wall_s);
  for (const Json& pass : result.summary.value("passes", Json::array())) {
    run.passes.push_back({{"name", pass["name"]}, {"wall_s", pass["wall_s"]}});
  }
  return run;
}

}  // namespace

std::string tables_sha256(const fs::path& directory) {
  std::set<fs::path> tables;
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (entry.path().extension() == ".csv") tables.insert(entry.path());
  }
  std::string all;
  for (const fs::path& table : tables) all += table.filename().string() + ' ' + sha256(table) + '\n';
  return sha256_of(all);
}

void add_run(PointRecord& record, const TrialResult& result, const fs::path& directory) {
  record.end = result.end;
  record.failure = failure_of(result);
  record.peak_rss_bytes = std::max(record.peak_rss_bytes, result.peak_rss_bytes);
  if (result.summary.is_object()) record.steps = result.summary.value("steps", Json());
  record.runs.push_back(run_of(result));
  if (result.end != TrialEnd::completed) return;
  const std::string hash = tables_sha256(directory);
  if (record.tables_sha256.empty()) record.tables_sha256 = hash;
  if (hash != record.tables_sha256)
    record.difference =
        "run " + std::to_string(record.runs.size()) + " wrote other tables than run 1 of the same scene";
}

TrialResult result_of(const PointRecord& record, const fs::path& directory) {
  TrialResult result;
  result.end = record.end;
  result.summary = read_summary(directory);
  if (record.failure.is_object() && record.failure["message"].is_string()) result.message = record.failure["message"];
  return result;
}

void write_record(const fs::path& points, const PointRecord& record) {
  Json runs = Json::array();
  for (const TimedRun& run : record.runs) {
    runs.push_back(
        {{"wall_s", run.wall_s}, {"cpu_s", run.cpu_s}, {"process_s", run.process_s}, {"passes", run.passes}});
  }
  const Json whole = {{"fingerprint", record.fingerprint},
                      {"machine", record.machine},
                      {"end", to_string(record.end)},
                      {"failure", record.failure},
                      {"runs", runs},
                      {"tables_sha256", record.tables_sha256},
                      {"difference", record.difference},
                      {"steps", record.steps},
                      {"peak_rss_bytes", record.peak_rss_bytes},
                      {"time_limit_s", record.time_limit_s}};
  files::write_file(record_file(points, record.fingerprint),
                    whole.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

std::optional<PointRecord> read_record(const fs::path& points, const std::string& fingerprint) {
  const fs::path file = record_file(points, fingerprint);
  if (!fs::exists(file)) return std::nullopt;
  const Json whole = Json::parse(files::read_text(file), nullptr, false);
  try {
    PointRecord record;
    record.fingerprint = whole.at("fingerprint");
    record.machine = whole.at("machine");
    record.end = trial_end_named(whole.at("end")).value_or(TrialEnd::interrupted);
    if (record.end == TrialEnd::interrupted) return std::nullopt;
    record.failure = whole.at("failure");
    for (const Json& run : whole.at("runs")) {
      record.runs.push_back({run.at("wall_s"), run.at("cpu_s"), run.at("process_s"), run.at("passes")});
    }
    record.tables_sha256 = whole.at("tables_sha256");
    record.difference = whole.at("difference");
    record.steps = whole.at("steps");
    record.peak_rss_bytes = whole.at("peak_rss_bytes");
    record.time_limit_s = whole.at("time_limit_s");
    const bool run_is_there = fs::exists(points / directory_name(fingerprint) / "summary.json");
    const bool must_be_there = record.end == TrialEnd::completed || record.end == TrialEnd::diverged;
    if (record.fingerprint != fingerprint || (must_be_there && !run_is_there)) return std::nullopt;
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;  // damaged: the point is run again
  }
}

}  // namespace rouleau::trial
