// The energy ledger: what energy a suspension holds, what it loses and what is put in, at an output time.
#pragma once

#include <string>
#include <vector>

#include "core/solver/any_solver.hpp"
#include "json/json.hpp"
#include "snapshot.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::observe {

// All ranks call these together, and get the same.

/// Energy of membranes and interactions, lattice units. The forces of the present positions have been computed.
struct CellEnergy {
  double sum = 0, magnitude = 0;  ///< of elastic, bending and interaction energy: their sum, that of their magnitudes
  std::string unknown;            ///< why the sum is not known; empty: it is
};
template <int D>
CellEnergy cell_energy(core::AnySolver<D>& solver);

/// State before the next step of `solver`, whose forces have been computed and whose fluid is settled; `fluid`:
/// measured of it; `forces`: on walls across y, if there are any.
template <int D>
EnergySnapshot observe_energy(core::AnySolver<D>& solver, const core::Energetics<D>& fluid,
                              const core::WallForces<D>& forces, const units::LatticeUnits& units);
template <int D>
EnergySnapshot observe_energy(core::AnySolver<D>& solver, const units::LatticeUnits& units) {
  return observe_energy(solver, solver.fluid().energetics(), solver.wall_forces(), units);
}

/// Follows the total energy through the stages at rest, where it may only fall.
class EnergyHistory {
 public:
  /// `driven`: walls or a force put energy in. `floor`: J/m, added to the
  /// energies that growth is compared with, so that rounding is no growth where there is next to none.
  void follow(const Snapshot& snapshot, bool driven, double floor = 0);
  /// Growth in the present stage over the largest sum of the energies' magnitudes, floor included; 0 where it is driven
  /// or its energy is not known.
  [[nodiscard]] double relative_growth() const;
  /// summary.json's "energy".
  [[nodiscard]] nlohmann::json summary() const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(EnergyHistory, at_rest_, stage_, follows_, unknown_)

 private:
  struct Stage {
    std::string name;
    double least = 0;        ///< J/m, total so far
    double growth = 0;       ///< J/m, largest rise above what was the least before
    double growth_time = 0;  ///< s, when it was largest
    double magnitude = 0;    ///< J/m, largest sum of the energies' magnitudes
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Stage, name, least, growth, growth_time, magnitude)
  };
  std::vector<Stage> at_rest_;
  int stage_ = -1;        ///< of the last entry
  bool follows_ = false;  ///< the present stage is the last entry
  std::string unknown_;
};

}  // namespace rouleau::observe
