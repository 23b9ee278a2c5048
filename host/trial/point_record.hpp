// What one timed run of a point of a campaign has given, what it has cost, and the fingerprint under which it is kept.
#pragma once

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "matrix.hpp"
#include "trial.hpp"

namespace rouleau::trial {

/// A process takes some time beside its steps (reading, writing, the report), and its steps some factor of what the
/// plan expects; both are learnt from finished runs.
class RunCost {
 public:
  /// `estimated_s` is the plan's, `stepping_s` and `process_s` what a run took.
  void learn(const Point& point, double estimated_s, double stepping_s, double process_s);
  /// Expected wall time of the process of one run.
  [[nodiscard]] double expected_s(const Point& point, double estimated_s) const;

 private:
  struct Known {
    Point point;
    double estimated_s, factor, beside_s;
  };
  std::vector<Known> known_;
};

/// NaN where nothing was measured.
struct MedianRange {
  double median = std::numeric_limits<double>::quiet_NaN(), least = median, most = median;
};

inline MedianRange median_range(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return {values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]), values.front(),
          values.back()};
}

/// What one run of a point cost.
struct TimedRun {
  double wall_s = 0;     ///< stepping
  double cpu_s = 0;      ///< of the process, all threads
  double process_s = 0;  ///< wall time of the process
  nlohmann::json passes = nlohmann::json::array();
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(TimedRun, wall_s, cpu_s, process_s, passes)
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
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(PointRecord, fingerprint, machine, end, failure, runs, tables_sha256, difference,
                                 steps, peak_rss_bytes, time_limit_s)
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

/// SHA-256 of this very program's file.
std::string program_sha256();

struct UsedPlugin {
  std::string id, library_sha256, manifest_sha256;
};
/// The plugins that a scene names, by the search path of its folder, ordered by id; none is opened. One that nobody
/// offers or that is refused has empty hashes: the run will say why.
std::vector<UsedPlugin> plugins_named(const nlohmann::json& scene, const std::filesystem::path& scene_file);

/// SHA-256 over the scene (keys in order, folders of plugins left out), the lock beside its file, the program, the
/// plugins and whatever else the result depends on, as the number of threads. Throws Error(input_output).
std::string fingerprint(const nlohmann::json& scene, const std::filesystem::path& scene_file,
                        const std::vector<std::string>& further = {});

/// Its first 16 digits, which name the directory of a run.
std::string directory_name(const std::string& fingerprint);

}  // namespace rouleau::trial
