// Whether a suspension at rest has gained energy, which it can only lose.
#pragma once

#include <optional>

#include "core/domain/ranks.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "failure.hpp"
#include "observe/energy.hpp"
#include "plan/plan.hpp"

namespace rouleau::monitor {

/// The failure, at the fastest node, if energy in the present stage has grown by more than checks.energy_growth. Not
/// looked at where an interaction has a state: bonds that form bring energy of their own. All ranks ask together, and
/// get the same; the first one knows the energy.
template <int D>
std::optional<Failure> check_energy(const observe::EnergyHistory& energy, const core::CellNodes& cells,
                                    const core::Ranks<D>& ranks, const plan::Plan& plan,
                                    const scene::StageSetting& setting);

}  // namespace rouleau::monitor
