// What studies and limits files have in common: the file with its scene and matrix, points that are run and kept, and
// how a result begins.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/file.hpp"
#include "json/document.hpp"
#include "json/json.hpp"
#include "matrix.hpp"
#include "point_record.hpp"
#include "trial.hpp"

namespace rouleau::trial {

/// The two commands that run campaigns, as their messages and files name them.
struct CampaignKind {
  const char* name;                ///< of its results: NAME.json, NAME.csv, and the keys NAME_file, rouleau_NAME_result
  const char* whose;               ///< "the path begins with the WHOSE folder"
  const char* command;             ///< "no COMMAND wrote"
  const char* program;             ///< "another PROGRAM is writing"
  double time_limit_s;             ///< of one run, where the file says nothing
  const char* time_limit_example;  ///< in the message about one out of range
};
inline constexpr CampaignKind study_kind{"study", "study's", "study", "study", 3600, "10 min"};
inline constexpr CampaignKind limits_kind{"limits", "limits file's", "limits command", "program", 120, "2 min"};

struct CampaignFile {
  std::shared_ptr<const json::Document> document;
  std::string title;
  std::filesystem::path file;
  std::filesystem::path scene_file;  ///< the file itself where it holds the scene
  nlohmann::json scene;              ///< with the changes of "set"
  std::vector<Axis> axes;
  double time_limit_s = 0;  ///< of one run
};

/// Throws Error(bad_input) with the place of the first fault, in the file or in its scene, Error(input_output) for a
/// file that cannot be read.
CampaignFile read_campaign_file(const CampaignKind& kind, const std::filesystem::path& file,
                                const nlohmann::json& schema);

/// Checks a changed scene as far as that is possible without plugins. Throws Error(bad_input) with a place in a text
/// called `name`, which the user does not have.
void check_scene(const nlohmann::json& scene, const std::string& name);

struct CampaignOptions {
  std::filesystem::path directory;
  bool quiet = false;
  std::filesystem::path program = "/proc/self/exe";
  const std::atomic<bool>* interrupted = nullptr;
};

class Campaign {
 public:
  /// Makes the directory with its folder points/, or takes the one that the same command has left, and locks it. Throws
  /// Error(bad_input) for a directory with other files, or that another process has locked. `file` must outlive this.
  Campaign(const CampaignKind& kind, const CampaignFile& file, CampaignOptions options);

  /// Where the run of that fingerprint is kept, once it is whole.
  [[nodiscard]] std::filesystem::path directory_of(const std::string& fingerprint) const;
  /// A run of a changed scene, in the directory where it is kept.
  [[nodiscard]] Trial trial_of(const nlohmann::json& scene, const std::string& fingerprint) const;
  /// What is known of that fingerprint; nothing where it must be run, also where it did not end in less time than the
  /// file now allows.
  [[nodiscard]] std::optional<PointRecord> find(const std::string& fingerprint) const;
  /// Runs it in a directory of its own beside that of the trial, which is removed when it was interrupted. Throws
  /// Error(plugin_refused) when a library was built anew since the campaign began.
  [[nodiscard]] TrialResult run(Trial trial) const;
  /// Adds what run() has left to the record, and writes it. The first run, or the failed one, takes the place that it
  /// is kept at.
  void keep(std::optional<PointRecord>& record, const std::string& fingerprint, const TrialResult& result) const;
  /// Removes what run() has left.
  void discard(const std::string& fingerprint) const;

  [[nodiscard]] bool interrupted() const { return options_.interrupted != nullptr && *options_.interrupted; }
  /// A line on standard error, unless it should be quiet.
  void say(const std::string& line) const;
  /// Waits for `lock`. False when interrupted meanwhile.
  [[nodiscard]] bool wait_for(files::FileLock& lock, const std::string& waiting) const;

 private:
  /// Throws Error(plugin_refused) where a run had another library than those before it, which fingerprints speak of.
  void require_same_libraries(const nlohmann::json& summary) const;

  const CampaignKind& kind_;
  const CampaignFile& file_;
  CampaignOptions options_;
  std::optional<files::FileLock> lock_;
  mutable std::map<std::string, std::string> libraries_;  ///< SHA-256 by id
};

/// What NAME.json says of every campaign: its file, the program, the machine, when it ran. `finished`: empty while it
/// runs.
nlohmann::json result_head(const CampaignKind& kind, const CampaignFile& file, const std::string& started,
                           const std::string& finished, bool complete);
/// One line of NAME.csv: null is an empty field.
std::string csv_line(const nlohmann::json& fields);
/// Writes NAME.csv and NAME.json, each whole or not at all. Throws Error(input_output).
void write_result(const CampaignKind& kind, const std::filesystem::path& directory, const nlohmann::json& result,
                  const std::string& csv);

}  // namespace rouleau::trial
