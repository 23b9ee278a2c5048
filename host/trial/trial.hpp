// One simulation in a process of its own, so that a crash, a hang or a lack of memory is a result and not the end.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::trial {

/// Exit codes of `rouleau` (fixed: users script against them).
namespace exit_code {

inline constexpr int done = 0;
inline constexpr int simulation_failed = 1;  ///< it diverged, or a check failed
inline constexpr int bad_input = 2;          ///< bad usage, or a scene that cannot be right
inline constexpr int plugin_refused = 3;     ///< a manifest or library was refused, or does not conform
inline constexpr int input_output = 4;       ///< a file could not be read or written
inline constexpr int interrupted = 130;      ///< stopped by SIGINT or SIGTERM

}  // namespace exit_code

struct Trial {
  nlohmann::json scene;
  std::filesystem::path scene_file;  ///< that the scene was made from: its folder is where relative plugin_dirs begin,
                                     ///< and the lock beside it binds
  std::filesystem::path directory;   ///< of the run; the run that it may hold is replaced
  int threads = 1;
  double time_limit_s = 3600;
  double grace_s = 20;  ///< between being asked to end and being killed: the rest of a step, a checkpoint, the report
  std::filesystem::path written_scene = {};  ///< where the complete scene is written; empty: DIRECTORY.scene.json
  long max_steps = 0;                        ///< over all stages; 0: all that the scene wants
  std::filesystem::path program = "/proc/self/exe";     ///< that is run: this very one, but in its unit tests
  const std::atomic<bool>* interrupted = nullptr;       ///< set by a signal handler: ends the trial
  std::vector<std::filesystem::path> plugin_dirs = {};  ///< searched before those of the scene
  std::filesystem::path lock = {};                      ///< empty: the one beside the scene's file, if there is one
};

enum class TrialEnd { completed, diverged, refused, timed_out, crashed, interrupted };
/// An unknown word is read as the first of these: such a trial is run again.
NLOHMANN_JSON_SERIALIZE_ENUM(TrialEnd, {{TrialEnd::interrupted, "interrupted"},
                                        {TrialEnd::completed, "completed"},
                                        {TrialEnd::diverged, "diverged"},
                                        {TrialEnd::refused, "refused"},
                                        {TrialEnd::timed_out, "timed_out"},
                                        {TrialEnd::crashed, "crashed"}})
inline std::string to_string(TrialEnd end) { return nlohmann::json(end); }

struct TrialResult {
  TrialEnd end = TrialEnd::crashed;
  nlohmann::json summary;   ///< summary.json; null when there is none
  std::string message;      ///< why it did not complete, in the program's own words where it had any; empty: it did
  double wall_s = 0;        ///< of the whole process; that of the stepping is in the summary
  double cpu_s = 0;         ///< of the whole process, all threads
  long peak_rss_bytes = 0;  ///< the summary's where there is one
};

/// Runs this very program, rouleau run, as a child. The complete scene is written beside the directory. At the time
/// limit and when interrupted the child is asked to end (it then leaves a whole run directory) and killed where it does
/// not. Throws Error(input_output) where the scene cannot be written or the program cannot be started.
TrialResult run_trial(const Trial& trial);

/// summary.json of a run's directory; null where there is none. Throws Error(bad_input) for a damaged one.
nlohmann::json read_summary(const std::filesystem::path& directory);

/// What `rouleau plan --json` says about the trial, as another child; null where it refuses. Opens no run directory.
nlohmann::json plan_trial(const Trial& trial);

}  // namespace rouleau::trial
