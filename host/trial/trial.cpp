#include "trial.hpp"

#include <sys/types.h>

#include <csignal>
#include <cstring>

#include "base/error.hpp"
#include "base/process.hpp"
#include "base/text.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "json/document.hpp"
#include "plugin/lock.hpp"
#include "scene/named_files.hpp"

namespace rouleau::trial {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_words = 1U << 16U;

/// The file itself: the child's own /proc/self would be another. What a new program at its place measures would go
/// under the old one's hash, so that there is nothing for it but to stop.
fs::path program_of(const Trial& trial) {
  if (!fs::is_symlink(trial.program)) return trial.program;
  const std::string file = fs::read_symlink(trial.program).string(), gone = " (deleted)";  // what Linux adds
  if (!file.ends_with(gone)) return file;
  throw Error(Cause::input_output,
              "the program " + file.substr(0, file.size() - gone.size()) + " was replaced or removed meanwhile",
              {"call the same command again (what the old program measured is then measured anew)"});
}

fs::path scene_file_of(const Trial& trial) {
  if (!trial.written_scene.empty()) return trial.written_scene;
  return (trial.directory / "").lexically_normal().parent_path().string() + ".scene.json";
}

/// The scene as it means the same beside the trial's directory as it did beside its own file.
nlohmann::json moved_scene(const Trial& trial) {
  nlohmann::json scene = trial.scene;
  const fs::path folder = fs::absolute(trial.scene_file).parent_path();
  for (const std::string& entry : scene::entries_with_files(scene)) {
    scene::each_text(scene.at(nlohmann::json::json_pointer(entry + "/file")), [&](nlohmann::json& file) {
      file = (folder / file.get<std::string>()).lexically_normal().string();
    });
  }
  if (!scene.is_object() || !scene.contains("plugin_dirs") || !scene["plugin_dirs"].is_array()) return scene;
  for (auto& entry : scene["plugin_dirs"])
    if (entry.is_string()) entry = (folder / entry.get<std::string>()).lexically_normal().string();
  return scene;
}

void write_scene(const Trial& trial) {
  const fs::path file = scene_file_of(trial);
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  files::write_file(file, moved_scene(trial).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
}

/// The command and its scene, with the lock that lies beside the file that the scene was made from.
std::vector<std::string> scene_arguments(const std::string& command, const Trial& trial) {
  std::vector<std::string> arguments{command, scene_file_of(trial).string()};
  const fs::path lock = trial.lock.empty() ? plugin::lock_beside(trial.scene_file) : trial.lock;
  std::error_code ignored;
  if (!trial.lock.empty() || fs::exists(fs::symlink_status(lock, ignored)))
    arguments.insert(arguments.end(), {"--lock", lock.string()});
  for (const fs::path& folder : trial.plugin_dirs) arguments.insert(arguments.end(), {"--plugin-dir", folder.string()});
  return arguments;
}

TrialEnd end_of(const ProcessEnd& process) {
  if (process.stopped) return TrialEnd::interrupted;
  if (process.timed_out) return TrialEnd::timed_out;
  if (process.signal != 0) return TrialEnd::crashed;
  const int code = process.exit_code;
  if (code == exit_code::done) return TrialEnd::completed;
  if (code == exit_code::simulation_failed) return TrialEnd::diverged;
  if (code == exit_code::bad_input || code == exit_code::plugin_refused) return TrialEnd::refused;
  return code == exit_code::interrupted ? TrialEnd::interrupted : TrialEnd::crashed;  // by somebody else's signal
}

std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

std::string message_of(TrialEnd end, const ProcessEnd& process, double time_limit_s) {
  if (end == TrialEnd::completed) return {};
  if (end == TrialEnd::interrupted) return "interrupted";
  if (end == TrialEnd::timed_out) return "not finished after " + number(time_limit_s) + " s, the study's time limit";
  std::string words = trimmed(process.output);
  if (end != TrialEnd::crashed) return words;
  const std::string how = process.signal != 0 ? "ended by signal " + std::to_string(process.signal) + " (" +
                                                    ::strsignal(process.signal) + ')'
                                              : "ended with exit code " + std::to_string(process.exit_code);
  return words.empty() ? how : how + "\n" + words;
}

}  // namespace

TrialResult run_trial(const Trial& trial) {
  write_scene(trial);
  // A child that ends before it comes to the directory must not be given the summary of the run before it.
  std::error_code ignored;
  fs::remove(trial.directory / "summary.json", ignored);
  std::vector<std::string> arguments = scene_arguments("run", trial);
  arguments.insert(arguments.end(), {"--out", trial.directory.string(), "--overwrite", "--quiet", "--no-error-bar",
                                     "--threads", std::to_string(trial.threads)});
  if (trial.max_steps > 0) arguments.insert(arguments.end(), {"--max-steps", std::to_string(trial.max_steps)});
  const ProcessEnd process = run_process(
      program_of(trial), arguments, ProcessLimits{trial.time_limit_s, trial.grace_s, trial.interrupted, longest_words});

  TrialResult result;
  result.end = end_of(process);
  result.message = message_of(result.end, process, trial.time_limit_s);
  result.summary = read_summary(trial.directory);
  result.wall_s = process.wall_s;
  result.cpu_s = process.cpu_s;
  result.peak_rss_bytes = result.summary.is_object() ? result.summary.value("peak_rss_bytes", process.peak_rss_bytes)
                                                     : process.peak_rss_bytes;
  return result;
}

nlohmann::json read_summary(const fs::path& directory) {
  const fs::path file = directory / "summary.json";
  return fs::exists(file) ? json::Document::read(file).root() : nlohmann::json();
}

nlohmann::json plan_trial(const Trial& trial) {
  write_scene(trial);
  std::vector<std::string> arguments = scene_arguments("plan", trial);
  arguments.emplace_back("--json");
  const ProcessEnd process = run_process(
      program_of(trial), arguments, ProcessLimits{trial.time_limit_s, trial.grace_s, trial.interrupted, 1U << 24U});
  if (end_of(process) != TrialEnd::completed) return {};
  // Warnings come before the object on the same pipe; what is no JSON after all is no plan.
  const std::size_t begin = process.output.find("{\n");
  if (begin == std::string::npos) return {};
  const auto plan = nlohmann::json::parse(process.output.substr(begin), nullptr, false);
  return plan.is_discarded() ? nlohmann::json() : plan;
}

}  // namespace rouleau::trial
