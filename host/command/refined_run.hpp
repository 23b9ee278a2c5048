// The run with finer numerics that follows where "numerics": "auto" has measured that it missed its target.
#pragma once

#include <filesystem>
#include <string>

#include "accuracy/measure_errors.hpp"
#include "command/process/interruption.hpp"
#include "run/simulation.hpp"
#include "scene_options.hpp"

namespace rouleau::command {

/// What the first run leaves to the refined one.
struct FirstRun {
  const SceneOptions& scene;
  const plan::ReadScene& read;
  std::filesystem::path folder;
  double estimated_s;  ///< plan::Estimate::wall_s
  run::RunOptions options;
  accuracy::MeasureOptions measure;
  std::string again;  ///< the command that goes on, should it be ended
};

/// What `rouleau run` says before a run whose numerics are chosen: what it may take. Empty: nothing.
std::string say_what_auto_may_take(const plan::NumericsChoice& choice, double estimated_s, const TimeLimit& limit);

/// Whether the errors of the run in the folder have been measured, and miss the target.
bool missed_its_target(const std::filesystem::path& folder, const plan::NumericsChoice& choice);

/// Where the measured errors of the run in the folder miss the target, chooses numerics for a smaller one and runs the
/// scene in files::refined_folder of it, with error bars; says so, or why not. The first run stays as it is. A refined
/// run that has ended there is left alone, one that was interrupted is gone on with. Returns the exit code.
int refine_if_missed(const FirstRun& first, const TimeLimit& limit);

}  // namespace rouleau::command
