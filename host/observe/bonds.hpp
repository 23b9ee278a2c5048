// Which cells are joined: bonds by the share of a well's energy that a pair has won.
#pragma once

#include <vector>

#include "core/contact/interactions.hpp"
#include "scene/scene.hpp"
#include "snapshot.hpp"

namespace rouleau::observe {

/// Tells a snapshot, which has cells and contacts, its bonds: pairs of different cells, of types that attract each other,
/// which have won `least` of the depth of the wells between them times half of the smaller membrane; where a depth is
/// not known, those that are close. `halves`: of all ranks' cells, in any order; `unit`: their energy in J, in two
/// dimensions J/m.
void find_bonds(Snapshot& snapshot, const std::vector<core::PairEnergy>& halves, const scene::Attractions& attracting,
                double least, double unit);

}  // namespace rouleau::observe
