// What is kept of a point of a campaign beside its run, so that the same command goes on where it was ended.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "trial.hpp"

namespace rouleau::trial {

/// What one run of a point cost.
struct TimedRun {
  double wall_s = 0;     ///< stepping
  double cpu_s = 0;      ///< of the process, all threads
  double process_s = 0;  ///< wall time of the process
  nlohmann::json passes = nlohmann::json::array();
};

struct PointRecord {
  std::string fingerprint, machine;
  TrialEnd end = TrialEnd::completed;
  nlohmann::json failure;      ///< {reason, step, message, remedy}; null: none
  std::vector<TimedRun> runs;  ///< of a failed point: the one that failed
  std::string tables_sha256;   ///< of the first run's tables
  std::string difference;      ///< how a repeat's tables differ from the first run's; empty: not at all
  nlohmann::json steps;        ///< null: not known
  long peak_rss_bytes = 0;     ///< largest of all runs
  double time_limit_s = 0;     ///< that the runs had
};

/// The record of that fingerprint in a campaign's folder points/, where it and the run that it describes are whole.
std::optional<PointRecord> read_record(const std::filesystem::path& points, const std::string& fingerprint);
/// Whole or not at all. Throws Error(input_output).
void write_record(const std::filesystem::path& points, const PointRecord& record);

/// Adds a run to a record; the first one decides what the others' tables are compared with.
void add_run(PointRecord& record, const TrialResult& result, const std::filesystem::path& directory);

/// What the last run came to, with the summary in the directory where it is kept; its costs are left out.
TrialResult result_of(const PointRecord& record, const std::filesystem::path& directory);

/// SHA-256 over the run's tables (*.csv) and their names.
std::string tables_sha256(const std::filesystem::path& directory);

}  // namespace rouleau::trial
