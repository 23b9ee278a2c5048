// Whether a suspension at rest has gained energy, which it can only lose.
#pragma once

#include <optional>

#include "cell/membranes.hpp"
#include "energy.hpp"
#include "output/summary.hpp"
#include "plan.hpp"

namespace rouleau::host {

/// The failure, at the fastest node, if energy in the present stage has grown by more than checks.energy_growth. Not
/// looked at where an interaction has a state: bonds that form bring energy of their own. `spacing` in m.
std::optional<Failure> check_energy(const EnergyHistory& energy, const Membranes& membranes, const Plan& plan,
                                    double spacing);

}  // namespace rouleau::host
