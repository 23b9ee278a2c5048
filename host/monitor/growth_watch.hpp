// Remembers how the fastest membrane moved each time it became twice as fast: how a failure began.
#pragma once

#include <vector>

#include "core/domain/ranks.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "json/json.hpp"

namespace rouleau::monitor {

/// The fastest cell in the step in which a new speed was reached.
struct Excursion {
  long step = 0;  ///< of the run
  int cell = 0;
  double speed = 0;                                  ///< largest of its nodes, spacings a step
  std::vector<double> x, y, velocity_x, velocity_y;  ///< of its nodes
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Excursion, step, cell, speed, x, y, velocity_x, velocity_y)
};

/// An unstable membrane grows by orders of magnitude before a check stops it, and is crumpled by then. What it looked
/// like when it began is seen where its speed first passes twice the least of the last checks. Costs a comparison a
/// step: the largest steps are known anyway.
class GrowthWatch {
 public:
  /// Largest step of a node beyond which note() is to be called, lattice spacings.
  [[nodiscard]] double level() const { return level_; }
  /// The largest step has passed the level, which rises to twice that step. All ranks together, and all note the same.
  template <int D = 2>
  void note(long step, const core::CellNodes& cells, const core::Ranks<D>& ranks = {});
  /// At every regular check: what lies ten of them back is forgotten.
  void check(long step, const core::CellNodes& membranes);
  /// A stage begins: with another time step speeds are others.
  void start_stage() { *this = GrowthWatch(); }
  /// Oldest first.
  [[nodiscard]] const std::vector<Excursion>& excursions() const { return excursions_; }
  [[nodiscard]] bool fits(const core::CellNodes& membranes) const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(GrowthWatch, level_, speeds_, steps_, excursions_)

 private:
  static constexpr double least_level = 0.01;  ///< slower motion needs no note
  static constexpr std::size_t checks_kept = 10;
  double level_ = least_level;
  std::vector<double> speeds_;  ///< at the last checks, oldest first
  std::vector<long> steps_;     ///< of these checks
  std::vector<Excursion> excursions_;
};

}  // namespace rouleau::monitor
