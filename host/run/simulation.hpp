// A whole run: stages one after another, each a loop of steps with outputs and checks when they are due.
#pragma once

#include <atomic>
#include <string>
#include <variant>
#include <vector>

#include "core/domain/ranks.hpp"
#include "files/run_directory.hpp"
#include "summary.hpp"

namespace rouleau::run {

struct RunOptions {
  int threads = 1;
  long max_steps = -1;  ///< over all stages; negative: no limit
  bool quiet = false;
  bool force = false;                              ///< go on from a checkpoint in spite of differences that are safe
  const std::atomic<bool>* interrupted = nullptr;  ///< set by a signal handler: stop at the next step
  std::string message_library = {};                ///< that ranks speak over; empty: there are no others
  bool cut_at_checks = false;  ///< ranks get new blocks at every check, not only when some wait for others
};

/// In two dimensions or in three, as the scene; none: this process is alone.
using Ranks = std::variant<core::Ranks<2>, core::Ranks<3>>;

/// Runs a plan and writes into `directory`, going on from its checkpoint if it resumes; the summary has been written
/// when it returns, with the plan's report in it: an empty one will do where nobody reads that. Throws
/// Error(input_output), and Error(bad_input) where the checkpoint belongs to another run.
///
/// With ranks it is one rank's part in a run that is cut into blocks. All ranks call it with the same plan, options and
/// owners of cells (core::Solver), and come to the same end; the first one has the directory, null is given to the
/// others, who only read its checkpoint. Where one of them throws the others throw core::RankLost.
Summary simulate(const plan::Plan& plan, const plan::PlanReport& report, const RunOptions& options,
                 files::RunDirectory* directory, const Ranks& ranks = {}, const std::vector<int>& owner = {});

}  // namespace rouleau::run
