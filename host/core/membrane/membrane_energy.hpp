// What energy membranes hold and lose.
#pragma once

#include <string>
#include <vector>

#include "core/domain/ranks.hpp"

namespace rouleau::core {

/// Energies stored in the membranes, in lattice units.
struct MembraneEnergy {
  double tension = 0;  ///< laws of segments
  double bending = 0;  ///< laws of nodes
  double cell = 0;     ///< laws of whole cells
  /// Power that tensions by the rate of stretch take out of the motion, at the present velocities; and energy that laws
  /// with a state lose in a step without motion.
  double dissipation = 0;
  std::string unknown;  ///< a law that acts but tells no energy; empty: none
  [[nodiscard]] double total() const { return tension + bending + cell; }
};

/// Adds up cells, each by its owner: the same bits whoever that is.
class MembraneEnergySum {
 public:
  void add(int cell, const MembraneEnergy& energy) {
    const double parts[] = {energy.tension, energy.bending, energy.cell, energy.dissipation};
    for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k].add(parts[k]);
    if (!energy.unknown.empty()) unknown_ = energy.unknown, unknown_of_ = cell;
  }
  /// Of all ranks' cells, which must ask together.
  template <int D>
  MembraneEnergy of_all(const Ranks<D>& ranks) {
    add_up(ranks, sums_);
    struct Unknown {
      int cell, rank;
    };
    const int own = ranks.several() ? ranks.transport->rank() : 0;
    const Unknown last = best_of_all(ranks, Unknown{unknown_of_, own},
                                     [](const Unknown& a, const Unknown& b) { return a.cell > b.cell; });
    if (last.cell >= 0) unknown_ = text_of_rank(ranks, last.rank, unknown_);
    return {sums_[0].value(), sums_[1].value(), sums_[2].value(), sums_[3].value(), unknown_};
  }

 private:
  std::vector<ExactSum> sums_ = std::vector<ExactSum>(4);  // in the order of MembraneEnergy
  std::string unknown_;                                    // of the last cell with such a law
  int unknown_of_ = -1;
};

}  // namespace rouleau::core
