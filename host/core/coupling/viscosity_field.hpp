// Viscosity inside the cells: marks the interior on the lattice and sets the relaxation rate there.
#pragma once

#include <array>
#include <vector>

#include "base/worker.hpp"
#include "cell_fraction.hpp"
#include "core/fluid/field.hpp"
#include "core/fluid/node_mask.hpp"
#include "core/membrane/displacement_watch.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// How viscosities inside and outside are averaged where a membrane cuts what belongs to a node, I of which lies
/// inside: arithmetic: mu_row + sum over cells (mu_inside - mu_row) I; harmonic: the same of 1/mu. mu_row is that of
/// the fluid at this height, which is the suspending fluid's but in layers: what is inside a cell is the same wherever
/// it swims.
enum class ViscosityMean { arithmetic, harmonic };

/// tau = 1/2 + (tau_outside - 1/2) mu / mu_outside, kept as 1/tau; outside: of the suspending fluid.
/// Only what cells cover that have moved, or covered before they did, is computed again.
template <class T, int D>
class ViscosityField {
 public:
  /// `viscosity_ratio[t]`: interior over suspending viscosity of cell type t. `reach_beyond`: how far from a node its
  /// force may act besides the kernel's own reach, spacings. `viscosity_of_rows`: of the fluid around the cells, as in
  /// FluidSetting. `smoothed`: whether I is smoothed by (1 2 1)/4 along the axes.
  ViscosityField(const Cells<D>& cells, std::vector<double> viscosity_ratio, ViscosityMean mean, double reach_beyond,
                 double relaxation_rate, const Domain<D>& domain, std::vector<double> viscosity_of_rows = {},
                 bool smoothed = true);

  /// Whether a relaxation rate that varies in space is needed; if not, the passes only mark.
  [[nodiscard]] bool varies() const { return varies_; }

  /// Pass over cells: compares positions with those of the last update. After a barrier, due() is the same for all
  /// workers.
  void measure(Worker worker, const Cells<D>& cells) { watch_.measure(worker, cells); }
  [[nodiscard]] bool due() const { return watch_.exceeded(); }

  /// Pass over cells, when due: what the cells that have moved cover and reach.
  void cover(Worker worker, const Cells<D>& cells);
  /// Pass over rows, when due, a barrier after cover(): sets the relaxation rate in and around the cells that have
  /// moved, restores it where they were, and marks the nodes that the membranes touch until they have moved by 1.
  /// The field must hold the rates of a fluid without cells before the first call; it is not touched unless varies().
  void update(Worker worker, const Cells<D>& cells, Field<T, D>& relaxation_rate, NodeMask& mask);

  /// What relaxation rate and mask were made from, for checkpoints.
  [[nodiscard]] const DisplacementWatch::Memory& memory() const { return watch_.memory(); }
  /// The same for other ranks.
  [[nodiscard]] DisplacementWatch& watch() { return watch_; }
  /// Not a pass: makes them again as they were, in place of those of a new stage. Positions are the same afterwards.
  void restore(DisplacementWatch::Memory memory, Cells<D>& cells, Field<T, D>& relaxation_rate, NodeMask& mask);

 private:
  struct Interval {
    int begin, end;
  };
  /// Intervals of the plane's, or space's, rows along x in a box, not wrapped into the lattice: y is the faster index.
  struct Rows {
    std::array<int, D - 1> first{}, size{};  ///< along y (and z)
    std::vector<Interval> columns;
  };
  struct Reach {
    CellFraction<D> fraction;      // empty if the cell's viscosity does not differ
    Rows covered, covered_before;  // where the fraction is not zero, and was at the update before
    Rows reached;                  // where its nodes may spread or interpolate, and what it covers
  };

  /// Calls function(row, columns, place) for those of the rows, counted by `place`, that are rows `own` of the block.
  template <class Function>
  void for_rows(const Rows& rows, Range own, Function function) const;
  /// Calls function(x, begin, end) for pieces [begin, end) of a row that lie side by side in the block, from its column
  /// x on.
  template <class Function>
  void for_pieces(Interval columns, Function function) const;
  /// Viscosity around the cells in a row of the block, over the suspending fluid's.
  [[nodiscard]] double viscosity_of_row(int row) const {
    return viscosity_of_rows_.empty() ? 1 : viscosity_of_rows_[domain_.block.begin[1] + row % domain_.block.size(1)];
  }
  /// Whether cells of a type are another fluid than that around them, anywhere.
  [[nodiscard]] bool differs(int type) const { return ratio_[type] != 1 || !viscosity_of_rows_.empty(); }
  void find_covered(const CellFraction<D>& fraction, Rows& covered) const;
  void find_reached(const Cells<D>& cells, int cell, Reach& reach) const;
  void collect_changes(const Cells<D>& cells, Range own);
  void set_rates(const Cells<D>& cells, Range own, Field<T, D>& rate);

  std::vector<double> ratio_;
  ViscosityMean mean_;
  bool smoothed_;
  int margin_;  // nodes, for what reaches beyond the kernel
  double plain_rate_;
  std::vector<double> viscosity_of_rows_;
  Domain<D> domain_;
  bool varies_ = false;
  DisplacementWatch watch_;
  std::vector<Reach> reach_;                    // of each cell
  std::vector<std::vector<Interval>> changed_;  // of each row of the block: disjoint, where rates are computed again
};

extern template class ViscosityField<float, 2>;
extern template class ViscosityField<double, 2>;
extern template class ViscosityField<float, 3>;
extern template class ViscosityField<double, 3>;

}  // namespace rouleau::core
