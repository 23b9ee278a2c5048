// Which cells touch and which are joined: bonds by the share of a well's energy that a pair has won.
#pragma once

#include <vector>

#include "aggregates.hpp"
#include "core/solver/any_solver.hpp"
#include "scene/scene.hpp"
#include "snapshot.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::observe {

/// Contacts as a snapshot has them, sizes of aggregates and what contacts are like on average; `length` of a spacing,
/// m.
template <int D>
void describe_contacts(const std::vector<CellContact>& contacts, const Aggregates& aggregates, double length,
                       Snapshot& snapshot);

/// Tells a snapshot, which has cells and contacts, its bonds: pairs of different cells, of types that attract each
/// other, which have won `least` of the depth of the wells between them times half of the smaller membrane; where a
/// depth is not known, those that are close. `halves`: of all ranks' cells, in any order; `unit`: their energy in J,
/// in two dimensions J/m.
void find_bonds(Snapshot& snapshot, const std::vector<core::PairEnergy>& halves, const scene::Attractions& attracting,
                double least, double unit);

/// What cells add to the stress, and their bonds if some attract each other. All ranks together.
template <int D>
void observe_interactions(core::AnySolver<D>& solver, const scene::Scene& scene, const scene::Attractions& attracting,
                          const units::LatticeUnits& units, Snapshot& snapshot);

}  // namespace rouleau::observe
