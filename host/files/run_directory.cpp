#include "run_directory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>

#include "base/curve.hpp"
#include "checkpoint_file.hpp"
#include "frames.hpp"
#include "json/document.hpp"
#include "observe/cell_traffic.hpp"
#include "observe/profiles.hpp"
#include "observe/statistics.hpp"
#include "verify.hpp"

namespace rouleau::files {

namespace {

constexpr const char* profiles_file = "profiles.csv";
constexpr std::array<std::string_view, 13> run_files{profiles_file,
                                                     "aggregate_sizes.csv",
                                                     "cells.csv",
                                                     "aggregates.csv",
                                                     "series.csv",
                                                     "frames.h5",
                                                     "frames.xmf",
                                                     "summary.json",
                                                     "report.html",
                                                     "scene.json",
                                                     "checkpoint.h5",
                                                     "log.jsonl",
                                                     "checkpoint-previous.h5"};

/// Left by a run that was killed while it wrote a file.
bool is_partial(const std::string& name) { return name.starts_with('.') && name.ends_with(".partial"); }

bool written_by_a_run(const std::string& name) {
  return is_partial(name) || segment_number(name) || name == companions_folder || name == refined_folder ||
         std::find(run_files.begin(), run_files.end(), name) != run_files.end();
}

bool holds_checkpoint(const std::filesystem::path& directory) {
  return std::filesystem::exists(checkpoint_file(directory)) ||
         std::filesystem::exists(previous_checkpoint_file(directory));
}

/// A run writes its first line into the log before anything else, so that this also finds runs that were killed; one
/// that never began has nothing to lose.
bool holds_run(const std::filesystem::path& directory) {
  std::error_code missing;
  const auto log_size = std::filesystem::file_size(directory / "log.jsonl", missing);
  return (!missing && log_size > 0) || std::filesystem::exists(directory / "summary.json") ||
         holds_checkpoint(directory);
}

/// Makes the directory, and sees to it that nothing of the user's gets mixed up with the files of a new run. What
/// somebody has put beside those of a run that is there already stays where it is.
std::filesystem::path prepared(std::filesystem::path directory, FormerRun former) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  std::error_code ignored;
  if (std::filesystem::exists(directory, ignored) && !std::filesystem::is_directory(directory, ignored))
    throw Error(Cause::input_output, Place{directory.string()}, "is a file and not a directory",
                {"choose another place", {Way::elsewhere}});
  if (error) fail_file(directory, "cannot be made", error.value());
  std::filesystem::directory_iterator entries(directory, error);
  if (error) fail_file(directory, "cannot be listed", error.value());
  if (former != FormerRun::keep && holds_run(directory)) return directory;
  for (const auto& entry : entries)
    if (!written_by_a_run(entry.path().filename().string()))
      throw Error(Cause::bad_input, Place{directory.string()},
                  "holds \"" + entry.path().filename().string() + "\", which no run wrote",
                  {"choose another directory, or move that file away", {Way::elsewhere}});
  return directory;
}

template <class Choice>
void remove_files(const std::filesystem::path& directory, Choice chosen) {
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (!chosen(entry.path().filename().string())) continue;
    std::error_code error;
    if (const auto name = entry.path().filename(); name == companions_folder || name == refined_folder)
      std::filesystem::remove_all(entry.path(), error);
    else
      std::filesystem::remove(entry.path(), error);
    if (error) fail_file(entry.path(), "of a former run cannot be removed", error.value());
  }
}

/// A row for each stage and bin: the means of observe::statistics; where it finds none, those over the second half of
/// the stage with errors that are no numbers.
std::string profiles_csv(const observe::ProfileHistory& history, const scene::Scene& scene) {
  using Instant = observe::ProfileHistory::Instant;
  std::string text = "stage,position_m";
  for (const std::string name : {"velocity", "hematocrit"}) {
    const std::string unit = name == "velocity" ? "_m_per_s" : "";
    text += "," + name + unit + "," + name + "_standard_error" + unit + "," + name + "_from_s," + name + "_verdict";
  }
  text += "\n";
  for (const auto& [stage, instants] : history.stages()) {
    Column time;
    for (const Instant& instant : instants) time.push_back(instant.time);
    for (int bin = 0; bin < scene.output.profiles->bins; ++bin) {
      text += csv_text(stage) + "," + to_text(observe::place_of_bin(scene, bin));
      for (const auto profile : {&Instant::velocity, &Instant::hematocrit}) {
        Column values;
        for (const Instant& instant : instants) values.push_back((instant.*profile)[static_cast<std::size_t>(bin)]);
        const observe::Statistics known = observe::statistics(time, values);
        const double late = time.size() > 1 ? mean_from(time, values, (time.front() + time.back()) / 2) : values.back();
        for (const double value : {known.steady() ? known.mean : late, known.standard_error, known.from})
          (text += ",") += to_text(value);
        (text += ",") += csv_text(known.verdict);
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace

void to_json(nlohmann::json& json, const DirectoryMark& mark) {
  nlohmann::json tables = nlohmann::json::array();
  for (const FileMark& table : mark.tables) tables.push_back({{"bytes", table.bytes}, {"checksum", table.checksum}});
  json = {{"tables", tables}, {"frames", mark.frames}, {"log_s", mark.log_s}};
}

void from_json(const nlohmann::json& json, DirectoryMark& mark) {
  for (std::size_t k = 0; k < mark.tables.size(); ++k) {
    const auto& table = json.at("tables").at(k);
    mark.tables[k] = {table.at("bytes"), table.at("checksum")};
  }
  json.at("frames").get_to(mark.frames);
  json.at("log_s").get_to(mark.log_s);
}

std::string scene_text(const json::Document& document) {
  const auto text = nlohmann::json::parse(document.text(), nullptr, false);
  return text == document.root() ? document.text() : document.root().dump(2) + "\n";
}

std::filesystem::path unused_directory(const std::filesystem::path& wanted) {
  std::error_code error;
  if (wanted.has_parent_path()) std::filesystem::create_directories(wanted.parent_path(), error);
  if (error) fail_file(wanted.parent_path(), "cannot be made", error.value());
  for (long number = 1;; ++number) {
    auto directory = wanted;
    if (number > 1) directory += "-" + std::to_string(number);
    if (std::filesystem::create_directory(directory, error)) return directory;
    const bool taken = std::filesystem::exists(std::filesystem::symlink_status(directory));
    if (!taken) fail_file(directory, "cannot be made", error ? error.value() : EIO);
    std::error_code ignored;
    if (std::filesystem::is_directory(directory, ignored) && std::filesystem::is_empty(directory, ignored))
      return directory;
  }
}

struct RunDirectory::Files {
  explicit Files(const std::filesystem::path& directory) : lock(directory) {
    if (!lock.take())
      throw Error(Cause::bad_input, Place{directory.string()}, "another run is writing into this directory",
                  {"wait for it, or choose another one", {Way::elsewhere}});
  }
  FileLock lock;  ///< of the directory itself
  std::optional<Log> log;
  std::optional<Tables> tables;
  std::optional<FrameWriter> frames;
};

RunDirectory::RunDirectory(std::filesystem::path directory, const scene::Scene& scene, FormerRun former, DataFiles data)
    : directory_(prepared(std::move(directory), former)), scene_(scene) {
  // The lock before anything is removed: another run may be writing here.
  files_ = std::make_unique<Files>(directory_);
  if (former == FormerRun::keep && holds_run(directory_)) {
    throw Error(
        Cause::bad_input, Place{directory_.string()}, "holds a run already, which would be lost",
        {"choose another directory, go on with that run, or replace it", {Way::elsewhere, Way::resume, Way::anew}});
  }
  if (former == FormerRun::resume) {
    resumes_ = holds_checkpoint(directory_);
    if (resumes_) {
      files_->log.emplace(directory_ / "log.jsonl");
      return;
    }
    if (std::filesystem::exists(directory_ / "summary.json")) {
      throw Error(Cause::bad_input, Place{directory_.string()},
                  "holds a run that has ended and left no checkpoint to go on from", {"replace it", {Way::anew}});
    }
  }
  remove_files(directory_, written_by_a_run);
  if (data == DataFiles::tables) kept_ = Kept::for_now;
  files_->log.emplace(directory_ / "log.jsonl", kept_);
  files_->tables.emplace(directory_, observe::kind_of(scene), kept_);
  if (data == DataFiles::all) files_->frames.emplace(directory_ / "frames.h5", scene);
  if (scene.document) write_file(directory_ / "scene.json", scene_text(*scene.document), kept_);
}

bool RunDirectory::is_open() const { return files_ && files_->tables; }

void RunDirectory::go_back(const DirectoryMark& mark) {
  Tables::require(directory_, mark.tables);
  files_->frames.emplace(directory_ / "frames.h5", scene_, mark.frames);
  remove_files(directory_, [](const std::string& name) {
    return is_partial(name) || name == profiles_file || name == "summary.json" || name == "report.html" ||
           name == "frames.xmf";
  });
  files_->tables.emplace(directory_, observe::kind_of(scene_), mark.tables);
  files_->log->go_on(mark.log_s);
  if (scene_.document) write_file(directory_ / "scene.json", scene_text(*scene_.document));
}

DirectoryMark RunDirectory::mark() { return {files_->tables->mark(), files_->frames->seal(), files_->log->elapsed()}; }

RunDirectory::~RunDirectory() = default;

void RunDirectory::write(const observe::Snapshot& snapshot) {
  if (!files_) throw std::logic_error("RunDirectory::write after finish");
  files_->tables->write(snapshot);
  if (files_->frames) files_->frames->write(snapshot);
}

void RunDirectory::log(const std::string& event, const nlohmann::json& details) {
  if (!files_) throw std::logic_error("RunDirectory::log after finish");
  files_->log->write(event, details);
}

void RunDirectory::finish(const nlohmann::json& summary, const observe::ProfileHistory& profiles) {
  if (!files_) throw std::logic_error("RunDirectory::finish called twice");
  const auto files = std::move(files_);
  files->tables->close();
  std::vector<std::string> names;
  if (files->frames) {
    files->frames->close();
    write_file(directory_ / "frames.xmf", files->frames->xdmf());
    names = files->frames->names();
  }
  files->log->close();
  if (scene_.output.profiles) write_file(directory_ / profiles_file, profiles_csv(profiles, scene_), kept_);
  for (const std::string_view name : run_files) {
    const bool made_of_others = name == "summary.json" || name == "report.html" || name == "checkpoint-previous.h5";
    const bool named = name == "frames.h5";
    if (!made_of_others && !named && std::filesystem::exists(directory_ / name)) names.emplace_back(name);
  }
  // Last: who finds a summary finds everything else complete.
  write_file(directory_ / "summary.json", sealed_summary(summary, directory_, names), kept_);
}

void Log::go_on(double elapsed) {
  file_.end_line();
  before_ = elapsed;
}

double Log::elapsed() const { return before_ + watch_.seconds(); }

void Log::write(const std::string& event, const nlohmann::json& details) {
  nlohmann::ordered_json line{{"wall_s", std::round(elapsed() * 1e6) * 1e-6}, {"event", event}};
  if (details.is_object())
    // A detail named like a part of every line must not stand in its place: when something happened is never lost.
    for (const auto& [key, value] : details.items()) line[line.contains(key) ? event + "_" + key : key] = value;
  else if (!details.is_null())
    line["details"] = details;
  // A path or a loader's message may hold bytes that are no UTF-8; that must not end a run.
  file_.write(line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  file_.flush();
}

}  // namespace rouleau::files
