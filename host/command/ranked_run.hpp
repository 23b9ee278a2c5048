// A run by all ranks that a launcher has started together: the first one leads, the others follow.
#pragma once

#include <string>
#include <vector>

#include "files/run_directory.hpp"
#include "run/simulation.hpp"
#include "scene_options.hpp"

namespace rouleau::command {

/// All ranks, once each has planned the scene, and before anything is written: that they are about to do the same.
/// Alone nothing happens. Throws Error on the ranks that differ from the first one.
void require_same_run(const std::vector<std::string>& arguments, const PlannedScene& planned);

/// run::simulate by all ranks, or by this process where it is alone. The first rank calls it; the others, in
/// follow_first_rank, take their part. `again`: the command that goes on, should it fail.
run::Summary simulate_on_all_ranks(const SceneOptions& scene, const PlannedScene& planned,
                                   const run::RunOptions& options, files::RunDirectory& directory,
                                   const std::string& again);

/// What the other ranks do: their part of every run that the first one leads, until it is done. Returns its exit code.
int follow_first_rank(const SceneOptions& scene, const PlannedScene& planned, const run::RunOptions& options);
/// The first rank is done.
void dismiss_other_ranks(int exit_code);

}  // namespace rouleau::command
