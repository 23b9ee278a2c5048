// A run's directory: the only place, with the checkpoint, where the simulation writes files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "file.hpp"
#include "frame_segments.hpp"
#include "json/json.hpp"
#include "observe/profiles.hpp"
#include "observe/snapshot.hpp"
#include "scene/scene.hpp"
#include "tables.hpp"

namespace rouleau::files {

class Log {
 public:
  /// Throws Error(input_output) when it cannot be made.
  explicit Log(const std::filesystem::path& file, Kept kept = Kept::on_disk) : file_(file, kept) {}
  /// Keeps a former run's lines but for a last one that was never ended; time goes on from `elapsed` seconds.
  void go_on(double elapsed);
  /// Seconds since the log was opened, and those of the run it goes on from.
  [[nodiscard]] double elapsed() const;
  /// {"wall_s": elapsed(), "event": event, ...details}; details that are no object become
  /// "details", and a detail called wall_s or event is written as EVENT_wall_s.
  void write(const std::string& event, const nlohmann::json& details);
  void close() { file_.close(); }

 private:
  AppendFile file_;
  Stopwatch watch_;
  double before_ = 0;
};

/// Folder of a run's directory that holds the run with finer numerics which followed because the first one missed its
/// target: a whole run's directory.
inline constexpr std::string_view refined_folder = "refined";

/// The scene as used, as it stands in a run's scene.json: the user's own text unless --set changed it.
std::string scene_text(const json::Document& document);

/// `wanted` if there is nothing yet (or an empty directory), else the first of wanted-2, wanted-3, ... where that is
/// so. The directory has been made, so that of two runs started together each gets its own. Throws Error(input_output).
std::filesystem::path unused_directory(const std::filesystem::path& wanted);

/// Folder of a run's directory that holds runs which error bars are made of, until they have been made.
inline constexpr std::string_view companions_folder = "error-bar";

/// What becomes of a run that is found in the directory of a new one.
enum class FormerRun {
  keep,     ///< it is refused
  replace,  ///< its files are removed
  resume    ///< if it has a checkpoint the new run goes on from it; removed where it was killed before it wrote one
};

/// Which data files a run has.
enum class DataFiles {
  all,
  tables  ///< no frames.h5: such a run keeps no checkpoint, and nothing of it waits for the disk
};

/// What the data files held when a checkpoint was written.
struct DirectoryMark {
  Tables::Mark tables;
  FramesSaved frames;
  double log_s = 0;  ///< Log::elapsed()
};
void to_json(nlohmann::json& json, const DirectoryMark& mark);
void from_json(const nlohmann::json& json, DirectoryMark& mark);

/// Writes the run directory of docs/output.md. Every member throws Error(input_output) with path and reason.
class RunDirectory {
 public:
  /// Makes the directory (and parents). Refuses one that holds files which no run wrote, one that another run is
  /// writing into, and unless told what becomes of it one that holds a former run, finished or not.
  RunDirectory(std::filesystem::path directory, const scene::Scene& scene, FormerRun former = FormerRun::keep,
               DataFiles data = DataFiles::all);
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Whether the run that is found here goes on; then go_back() comes before anything is written.
  [[nodiscard]] bool resumes() const { return resumes_; }
  /// Whether there are data files to be written: not before go_back(), nor after finish().
  [[nodiscard]] bool is_open() const;
  /// Drops what was written after the mark. Throws Error(input_output), with all files as they were, where what was
  /// written before is not there any more.
  void go_back(const DirectoryMark& mark);
  /// What there is now, which is on the disk when this returns.
  DirectoryMark mark();

  /// Rows of cells.csv and aggregates.csv, outlines (and fields when not empty) into frames.h5.
  void write(const observe::Snapshot& snapshot);
  /// One line of log.jsonl: {"wall_s":..., "event":..., ...details}.
  void log(const std::string& event, const nlohmann::json& details = nlohmann::json::object());
  /// Closes the data files, writes frames.xmf, profiles.csv if the scene wants it and, last, summary.json. Nothing may
  /// be written after it.
  void finish(const nlohmann::json& summary, const observe::ProfileHistory& profiles = {});

  [[nodiscard]] const std::filesystem::path& path() const { return directory_; }

 private:
  struct Files;
  std::filesystem::path directory_;
  const scene::Scene& scene_;
  bool resumes_ = false;
  Kept kept_ = Kept::on_disk;
  std::unique_ptr<Files> files_;
};

}  // namespace rouleau::files
