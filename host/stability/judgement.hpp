// What a trial came to: healthy, a failure that the run reported, or one that it did not.
#pragma once

#include <filesystem>
#include <string>

#include "json/json.hpp"
#include "trial/trial.hpp"

namespace rouleau::stability {

/// Beyond these a run that came to its end has failed in silence.
struct HealthCriteria {
  double area_drift = 0.02;     ///< relative change of a cell's area, corrected leakage included
  double energy_growth = 0.01;  ///< at rest, over the energies there are (summary.json, energy)
  double stretch = 3;           ///< of any segment, and its inverse
  double mass_drift = 1e-4;     ///< relative
  NLOHMANN_DEFINE_TYPE_INTRUSIVE_WITH_DEFAULT(HealthCriteria, area_drift, energy_growth, stretch, mass_drift)
};

struct Judgement {
  bool healthy = false;
  std::string end;         ///< of the trial: completed, diverged ...
  nlohmann::json failure;  ///< null: none; {reason, step, message, remedy}, unknown ones null
};

/// Reason of a run that wrote what is no number: garbage, even if the run was stopped afterwards.
inline constexpr const char* no_number_written = "no_number_written";

/// A failure with nothing known but these.
nlohmann::json failure_json(const std::string& reason, const std::string& message);
/// A failure in a few words: "node_step at step 4, tangential, 6.2 segments".
std::string failure_text(const nlohmann::json& failure);

/// `directory`: of the trial's run, whose tables must hold no place or shape that is no number, and its frames nothing.
Judgement judge(const trial::TrialResult& result, const std::filesystem::path& directory,
                const HealthCriteria& criteria);

}  // namespace rouleau::stability
