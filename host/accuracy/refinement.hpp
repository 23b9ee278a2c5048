// What a run that missed its target teaches the choice of the next one's numerics.
#pragma once

#include <optional>

#include "error_bars.hpp"
#include "json/json.hpp"
#include "plan/numerics_choice.hpp"

namespace rouleau::accuracy {

/// The target for numerics that are chosen again: as much smaller than what was expected as what was measured is larger
/// than the target, and a fifth less, for a run that expects to meet its target exactly would miss it half of the time.
/// 0 where the outputs alone leave more open than the target allows.
double refined_target(const plan::NumericsChoice& choice, const Worst& worst);

/// What a summary's choice of numerics keeps of the worst error, and what comes back; nothing where it has none.
void add_measured(nlohmann::json& choice, const std::optional<Worst>& worst);
std::optional<Worst> measured(const nlohmann::json& choice);

}  // namespace rouleau::accuracy
