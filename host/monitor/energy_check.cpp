#include "energy_check.hpp"

#include <algorithm>

#include "core/membrane/motion.hpp"
#include "node_checks.hpp"

namespace rouleau::monitor {

std::optional<Failure> check_energy(const observe::EnergyHistory& energy, const core::CellNodes& membranes,
                                    const plan::Plan& plan, const plan::StageSetting& setting) {
  const double growth = energy.relative_growth(), limit = plan.scene->checks.energy_growth;
  if (growth <= limit) return std::nullopt;
  const bool bonds =
      std::any_of(plan.interactions.begin(), plan.interactions.end(),
                  [](const plan::PlannedModel& model) { return model.active() && !model.manifest->state.empty(); });
  if (bonds) return std::nullopt;
  Failure failure;
  failure.reason = "energy_growth";
  failure.value = growth;
  failure.limit = limit;
  failure.message =
      "cells and fluid at rest have gained energy (as a share of what there is), which they can only lose";
  failure.remedy = "lower " + setting.stage->density_factor_key +
                   ", or take numerics.coupling \"explicit\" within its limits (the plan has "
                   "the margins), or raise checks.energy_growth if this error is acceptable";
  const int fastest = core::farthest_node(membranes).node;
  if (fastest >= 0) locate_failure(failure, membranes, fastest, setting.units.length);
  return failure;
}

}  // namespace rouleau::monitor
