#include "energy_check.hpp"

#include <algorithm>
#include <cmath>

#include "node_checks.hpp"
#include "plan/constants.hpp"

namespace rouleau::monitor {

template <int D>
std::optional<Failure> check_energy(const observe::EnergyHistory& energy, const core::CellNodes& cells,
                                    const core::Ranks<D>& ranks, const plan::Plan& plan,
                                    const scene::StageSetting& setting) {
  const double growth = core::of_first(ranks, energy.relative_growth());
  const double limit = plan.scene->checks.energy_growth;
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
  failure.remedy = "lower " + setting.stage->density_factor_key;
  if (plan::kernel_named(plan.scene->numerics.kernel).semi_implicit_from == INFINITY)
    failure.remedy = "set numerics.kernel to \"peskin4\", or " + failure.remedy;
  else if (plan.semi_implicit)
    failure.remedy += ", so far that numerics.coupling may be \"explicit\" (the plan has the margins)";
  failure.remedy += ", or raise checks.energy_growth if this error is acceptable";
  const FoundNode fastest = farthest_node(cells, ranks);
  if (fastest.node >= 0) locate_failure<D>(failure, fastest, setting.units.length);
  return failure;
}

template std::optional<Failure> check_energy(const observe::EnergyHistory&, const core::CellNodes&,
                                             const core::Ranks<2>&, const plan::Plan&, const scene::StageSetting&);
template std::optional<Failure> check_energy(const observe::EnergyHistory&, const core::CellNodes&,
                                             const core::Ranks<3>&, const plan::Plan&, const scene::StageSetting&);

}  // namespace rouleau::monitor
