// Whether a suspension at rest has gained energy, which it can only lose.
#pragma once

#include <optional>

#include "core/membrane/cell_nodes.hpp"
#include "failure.hpp"
#include "observe/energy.hpp"
#include "plan/plan.hpp"

namespace rouleau::monitor {

/// The failure, at the fastest node, if energy in the present stage has grown by more than checks.energy_growth. Not
/// looked at where an interaction has a state: bonds that form bring energy of their own.
std::optional<Failure> check_energy(const observe::EnergyHistory& energy, const core::CellNodes& membranes,
                                    const plan::Plan& plan, const plan::StageSetting& setting);

}  // namespace rouleau::monitor
