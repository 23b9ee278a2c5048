// Runs the companions of a finished run and adds the error bars that they give to its summary.json.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "error_bars.hpp"
#include "json/json.hpp"
#include "plan/numerics_choice.hpp"
#include "plugin/catalog.hpp"

namespace rouleau::accuracy {

struct MeasureOptions {
  const plugin::Catalog& catalog;  ///< of the run's scene: companions name the same models
  int threads = 1;
  bool quiet = false;
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
///   numerics_choice   if not null, what add_measured keeps of the largest relative error of what is told first
/// Companions run here, one after another, and write tables alone into the directory's companions_folder, which goes
/// when all is measured. Throws Error(input_output), and Error(bad_input) where another process works in the directory.
MeasuredErrors measure_errors(const std::filesystem::path& directory, const scene::Scene& scene,
                              const MeasureOptions& options);

/// The target for numerics that are chosen again: as much smaller than what was expected as what was measured is larger
/// than the target, and a fifth less, for a run that expects to meet its target exactly would miss it half of the time.
/// 0 where the outputs alone leave more open than the target allows.
double refined_target(const plan::NumericsChoice& choice, const Worst& worst);

/// What a summary's choice of numerics keeps of the worst error, and what comes back; nothing where it has none.
void add_measured(nlohmann::json& choice, const std::optional<Worst>& worst);
std::optional<Worst> measured(const nlohmann::json& choice);

}  // namespace rouleau::accuracy
