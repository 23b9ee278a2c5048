// Viscosity inside the cells: marks the interior on the lattice and sets the relaxation rate there.
#pragma once

#include <vector>

#include "coverage.hpp"
#include "displacement.hpp"
#include "fluid/activity.hpp"
#include "fluid/field.hpp"
#include "membranes.hpp"
#include "worker.hpp"

namespace rouleau::host {

/// tau = 1/2 + (tau_outside - 1/2) (1 + sum over cells (ratio - 1) I), kept as 1/tau (arithmetic mean of viscosities).
template <class T>
class Indicator {
 public:
  /// `viscosity_ratio[t]`: interior over suspending viscosity of cell type t. `ny` also if not periodic.
  Indicator(const Membranes& membranes, std::vector<double> viscosity_ratio, double relaxation_rate, int nx, int ny,
            bool periodic_y);

  /// Whether a relaxation rate that varies in space is needed; if not, update() only marks.
  [[nodiscard]] bool varies() const { return varies_; }

  /// Pass: compares positions with those of the last update. After a barrier, due() is the same for all workers.
  void measure(Worker worker, const Membranes& membranes) { watch_.measure(worker, membranes); }
  [[nodiscard]] bool due() const { return watch_.exceeded(); }

  /// Pass (the first worker does it all): sets the relaxation rate in and around the cells, restores it where they
  /// were, and marks the nodes that the membranes touch until they have moved by 1. The field is allocated and filled
  /// with the plain rate at the first update if varies().
  void update(Worker worker, const Membranes& membranes, Field<T>& relaxation_rate, Activity& activity);

 private:
  struct Interval {
    int begin, end;
  };
  /// Lattice row that a row of the plane falls on; -1: beyond a wall.
  [[nodiscard]] int lattice_row(int y) const;
  void touch(const Coverage& coverage);
  void add(const Coverage& coverage, double excess, Field<T>& sum) const;
  void mark(const Membranes& membranes, std::size_t cell, Activity& activity);
  void set_rates(const Membranes& membranes, Field<T>& rate);
  template <class Function>
  void for_touched(Field<T>& field, Function function) const;

  std::vector<double> ratio_;
  double plain_rate_;
  int nx_, ny_;
  bool periodic_y_, varies_ = false, filled_ = false;
  DisplacementWatch watch_;
  std::vector<Coverage> coverage_;              // of each cell
  std::vector<std::vector<Interval>> touched_;  // of each lattice row: disjoint, where the last update wrote
  std::vector<double> scratch_;
  std::vector<Interval> columns_, reach_;  // of the rows around one cell
};

extern template class Indicator<float>;
extern template class Indicator<double>;

}  // namespace rouleau::host
