// Whose a checkpoint is: the scene, the program and the plugins that made it, held against those of the present run;
// what a former version left out is filled in.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "files/checkpoint_file.hpp"
#include "json/json.hpp"
#include "plan/plan.hpp"
#include "run_state.hpp"

namespace rouleau::run {

/// What a checkpoint says of itself, as JSON: format, program, written (UTC), threads, precision; stage, stage_name,
/// step, time_s, strain; scene; plugins [{id, version, kind, sha256, state [{name, unit}]}].
nlohmann::json checkpoint_facts(const plan::Plan& plan, const RunState& state, int threads);

struct Difference {
  std::string what;  ///< one line: where, what the checkpoint has, what there is now
  bool harmless;     ///< the checkpoint's state means the same in both: --force may go on
};
/// What differs between the run that wrote these facts and the present one.
std::vector<Difference> differences(const nlohmann::json& facts, const plan::Plan& plan, int present_stage);

/// A checkpoint to go on from, and what was accepted for it.
struct Resumption {
  std::unique_ptr<files::CheckpointReader> checkpoint;
  std::vector<std::string> accepted;  ///< differences, with --force
  std::string damage;                 ///< why it is the previous checkpoint; empty: it is the last
};

/// Opens the directory's checkpoint; the previous one where that is damaged. Throws Error(input_output) when neither
/// can be used, Error(bad_input) where it belongs to another run and `force` is not given or not safe.
Resumption open_checkpoint(const std::filesystem::path& directory, const plan::Plan& plan, bool force);

/// Adds what they did not say to a saved RunState: of each cell the node that tells its tank treading, which follows
/// from how it was placed, which cells an output had, and columns that there were not. What is there stays as it is.
template <int D>
void complete_former_state(nlohmann::json& run, const plan::Plan& plan);
/// The same of a TrafficState that had measured flows now and then: it goes on from them, and mass from what there is.
void complete_former_traffic(nlohmann::json& run, nlohmann::json& traffic);

}  // namespace rouleau::run
