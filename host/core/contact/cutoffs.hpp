// Within what distances cells are looked for.
#pragma once

#include <vector>

#include "contact_law.hpp"
#include "core/membrane/cell_nodes.hpp"

namespace rouleau::core {

/// Largest distance at which cells of two types interact, symmetric; 0: they do not.
class Cutoffs {
 public:
  explicit Cutoffs(int types) : types_(types), cutoff_(static_cast<std::size_t>(types) * types, 0.0) {}
  void raise(int a, int b, double cutoff);
  [[nodiscard]] double largest() const;
  [[nodiscard]] double operator()(int a, int b) const { return cutoff_[static_cast<std::size_t>(a) * types_ + b]; }

 private:
  int types_;
  std::vector<double> cutoff_;
};

/// Skin for lists that are made now, by the speed at which nodes move.
double suitable_skin(const CellNodes& cells);
/// Cells do not act on each other from further away, with lists that are as old as they may be; 0: they do not at all.
double contact_reach(const std::vector<Interaction>& interactions);
/// The largest cutoff for each pair of types.
Cutoffs pair_cutoffs(const CellNodes& cells, const std::vector<Interaction>& interactions);
/// The largest within a cell of each type; none: no cell touches itself. Throws std::invalid_argument for potentials
/// that remember or read a velocity.
std::vector<double> self_cutoffs(std::size_t types, const std::vector<SelfInteraction>& within_cells);

}  // namespace rouleau::core
