// Runs the companions of a finished run and adds the error bars that they give to its summary.json.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "error_bars.hpp"

namespace rouleau::accuracy {

struct MeasureOptions {
  std::filesystem::path scene_file;                ///< that the run's scene was made from (trial::Trial)
  std::vector<std::filesystem::path> plugin_dirs;  ///< searched before those of the scene
  std::filesystem::path lock;                      ///< empty: the one beside the scene's file, if there is one
  int threads = 1;
  bool quiet = false;
  std::filesystem::path program = "/proc/self/exe";
  const std::atomic<bool>* interrupted = nullptr;  ///< set by a signal handler
};

struct MeasuredErrors {
  std::vector<ErrorBar> bars;
  double wall_s = 0, share = 0;  ///< of the companions; over the run's
  std::string missing;           ///< why there are no bars; empty: there are
  bool interrupted = false;      ///< then summary.json is as it was, and the companions that have ended are kept
};

/// Whether the directory holds a run of this scene that has come to its end, and whether it has error bars.
enum class Finished { no, without_bars, with_bars };
Finished finished_run(const std::filesystem::path& directory, const scene::Scene& scene);

/// `scene` is that of the run in the directory, which has completed. Summary.json gets
///   error_bars        {name: {value, error, how}}
///   error_bar_runs    {wall_s, share_of_run, missing, companions [{role, differs, end, wall_s, message}]}
///   numerics_choice   if not null, measured_error and measured_of: the largest relative error of what is told first
/// Throws Error(input_output), and Error(bad_input) where another process works in the directory.
MeasuredErrors measure_errors(const std::filesystem::path& directory, const scene::Scene& scene,
                              const MeasureOptions& options);

}  // namespace rouleau::accuracy
