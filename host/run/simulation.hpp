// A whole run: stages one after another, each a loop of steps with outputs and checks when they are due.
#pragma once

#include <atomic>

#include "files/run_directory.hpp"
#include "plan/plan.hpp"
#include "summary.hpp"

namespace rouleau::run {

struct RunOptions {
  int threads = 1;
  long max_steps = -1;  ///< over all stages; negative: no limit
  bool quiet = false;
  bool force = false;                              ///< go on from a checkpoint in spite of differences that are safe
  const std::atomic<bool>* interrupted = nullptr;  ///< set by a signal handler: stop at the next step
};

/// Runs a plan and writes into `directory`, going on from its checkpoint if it resumes; the summary has been written
/// when it returns. Throws Error(input_output), and Error(bad_input) where the checkpoint belongs to another run.
Summary simulate(const plan::Plan& plan, const RunOptions& options, files::RunDirectory& directory);

}  // namespace rouleau::run
