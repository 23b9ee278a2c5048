// What closed surfaces cover and reach on the lattice: the viscosity inside them, and the nodes that feel them.
#pragma once

#include <vector>

#include "base/worker.hpp"
#include "core/fluid/field.hpp"
#include "core/fluid/node_mask.hpp"
#include "core/membrane/displacement_watch.hpp"
#include "core/surface/surfaces.hpp"
#include "viscosity_field.hpp"
#include "volume_fraction.hpp"

namespace rouleau::core {

/// tau = 1/2 + (tau_outside - 1/2) (r + sum over cells (ratio - r) I), or the same of inverses, kept as 1/tau: I of a node's
/// cube lies inside a cell, and r is 1, in layers the viscosity at this height over the suspending one: what is inside a cell is
/// the same wherever it swims. Where nodes have moved all that the cells cover is computed again.
template <class T>
class InteriorField {
 public:
  /// `viscosity_ratio[t]`: interior over suspending viscosity of cell type t. `viscosity_of_rows`: of the fluid around the
  /// cells, as in FluidSetting. `reach_beyond`: how far from the nodes their forces may act, spacings. `smoothed`: whether I is smoothed by
  /// (1 2 1)/4 along the axes.
  InteriorField(const Surfaces& surfaces, std::vector<double> viscosity_ratio, double relaxation_rate,
                const Domain<3>& domain, std::vector<double> viscosity_of_rows = {},
                ViscosityMean mean = ViscosityMean::arithmetic, double reach_beyond = 0, bool smoothed = true);

  /// Whether a relaxation rate that varies in space is needed; if not, the passes only mark.
  [[nodiscard]] bool varies() const { return varies_; }

  /// Pass over cells: compares positions with those of the last update. After a barrier, due() is the same for all
  /// workers.
  void measure(Worker worker, const Surfaces& surfaces) { watch_.measure(worker, surfaces); }
  [[nodiscard]] bool due() const { return watch_.exceeded(); }
  /// Pass over cells, after measure(): what the cells that have moved cover and reach.
  void cover(Worker worker, const Surfaces& surfaces);
  /// Pass over rows, when due, a barrier after cover(): sets the relaxation rate, and marks the nodes that the surfaces
  /// touch until they have moved by 1. The field must hold the rate of a fluid without cells before the first call; it is
  /// not touched unless varies().
  void update(Worker worker, const Surfaces& surfaces, Field<T, 3>& relaxation_rate, NodeMask& mask);

  /// What relaxation rate and mask were made from, for checkpoints.
  [[nodiscard]] const DisplacementWatch::Memory& memory() const { return watch_.memory(); }
  /// The same for other ranks.
  [[nodiscard]] DisplacementWatch& watch() { return watch_; }
  /// Not a pass: makes them again as they were, in place of those of a new stage. Positions are the same afterwards.
  void restore(DisplacementWatch::Memory memory, Surfaces& surfaces, Field<T, 3>& relaxation_rate, NodeMask& mask);

 private:
  /// Nodes may move this far before the next update; the marks allow for a whole spacing.
  static constexpr double displacement_limit = 0.1;

  struct Interval {
    int begin, end;  ///< of columns of the plane, not wrapped into the lattice
  };
  /// Of the rows (y, z) of a box: from first[0], first[1] on, y the faster index.
  struct Rows {
    int first[2] = {0, 0}, size[2] = {0, 0};
    std::vector<Interval> columns;
    [[nodiscard]] Interval& at(int j, int k) { return columns[static_cast<std::size_t>(size[0] * k + j)]; }
    [[nodiscard]] const Interval& at(int j, int k) const { return columns[static_cast<std::size_t>(size[0] * k + j)]; }
  };

  /// Viscosity around the cells in a row of the block, over the suspending fluid's.
  [[nodiscard]] double viscosity_of_row(int row) const {
    return viscosity_of_rows_.empty() ? 1 : viscosity_of_rows_[domain_.block.begin[1] + row % domain_.block.size(1)];
  }
  /// Whether cells of a type are another fluid than that around them, anywhere.
  [[nodiscard]] bool differs(int type) const { return ratio_[type] != 1 || !viscosity_of_rows_.empty(); }
  void find_reach(const Surfaces& surfaces, int cell);
  /// Calls function(row, j, k) for those rows (j, k) of a box that fall on rows `own` of the block.
  template <class Function>
  void for_rows(const int (&first)[2], const int (&size)[2], Range own, Function function) const;
  void set_rates(const Surfaces& surfaces, Range own, Field<T, 3>& rate);

  std::vector<double> ratio_;
  ViscosityMean mean_;
  bool smoothed_;
  int margin_;
  double plain_rate_;
  std::vector<double> viscosity_of_rows_;
  Domain<3> domain_;
  bool varies_ = false;
  DisplacementWatch watch_;
  std::vector<VolumeFraction> fraction_;  // of each cell; empty if its viscosity does not differ
  std::vector<Rows> reach_;               // of each cell: where its nodes may spread or interpolate, and what it covers
  std::vector<std::vector<Interval>> changed_;  // of each row of the block: where the rate is not the plain one
};

extern template class InteriorField<float>;
extern template class InteriorField<double>;

}  // namespace rouleau::core
