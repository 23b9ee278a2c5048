// What a quantity tends to as the lattice is refined, from runs on three or more grids: limit, order, uncertainty.
//
// Richardson extrapolation of f(h) = f0 + C h^p with p solved for, grids of any ratio; the uncertainty after
// P. J. Roache (grid convergence index, safety factor 1.25 or 3) and L. Eca and M. Hoekstra (J. Comput. Phys. 262,
// 2014: several error models, the worst of them counts), widened by what other models and triples of grids say.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace rouleau::study {

/// A value found on one grid. `spacing` is positive and in any unit: only ratios matter.
struct GridValue {
  double spacing;
  double value;            ///< NaN: the run has none; the grid is left out
  double uncertainty = 0;  ///< of the value itself, whatever the grid (say, the time between outputs)
};

enum class Convergence {
  asymptotic,   ///< monotone, with an order in [0.5, 4]
  unchanging,   ///< the values are equal to round-off, or to their own uncertainty
  slow,         ///< monotone, order below 0.5
  fast,         ///< monotone, order above 4
  oscillating,  ///< the finest three values go up and down
  diverging,    ///< the finest differ more than their spacings let a convergent series differ
  unknown,      ///< fewer than three grids have a value
};

/// The limit and where it comes from. Everything is NaN while the convergence is unknown.
struct Extrapolation {
  Convergence convergence = Convergence::unknown;
  double limit;        ///< f0
  double uncertainty;  ///< the limit lies within +- this of f0 in at least 95 % of smooth series (tests/unit/study)
  double order;        ///< p; NaN where there is none to see
  double coefficient;  ///< C, in values per spacing^p; p is 1 where no order is to be seen
  std::string remark;  ///< empty where the grids are in the asymptotic range; else why not, for the user
  std::vector<std::size_t> used;  ///< indices of the grids, finest first
};

/// Order p at which the differences of three values, finest first, fit C h^p. Infinite when the finer two are equal
/// and the coarser two not; NaN when the values oscillate, are all equal, or diverge (no positive order fits).
double observed_order(const std::array<GridValue, 3>& grids);

/// Grids in any order; of several with the same spacing the first counts. With more than three, the order and limit
/// are those of the least-squares fit to the finest four, each weighed by 1/spacing^2.
Extrapolation extrapolate(const std::vector<GridValue>& grids);

}  // namespace rouleau::study
