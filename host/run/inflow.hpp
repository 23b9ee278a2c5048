// Cells that come in through an inlet: when, and where each tries to appear.
#pragma once

#include <vector>

#include "core/domain/bounding_box.hpp"
#include "core/membrane/membranes.hpp"
#include "core/solver/solver_setup.hpp"
#include "core/surface/surfaces.hpp"
#include "plan/plan.hpp"
#include "scene/lattice.hpp"
#include "shape/rigid_body.hpp"

namespace rouleau::run {

/// Where cells come in, and how close to the openings they may be. They come as from a well mixed reservoir: a place is
/// drawn as often as the developed flow of the inlet brings fluid there, and any angle; again where the cell would
/// touch a wall or another cell.
template <int D>
class Inflow {
 public:
  /// The plan's scene has openings, and outlives it; `setup` of this stage.
  Inflow(const plan::Plan& plan, int stage, const core::BasicSolverSetup<D>& setup);

  /// How many cells have come in after so long, s: their volume is the hematocrit's share of all that came in.
  [[nodiscard]] int due(double time) const;
  /// Cells are wholly between these two, in spacings, when they come; a cell that has come nearer to an opening goes.
  [[nodiscard]] double lowest() const { return scene::kept_from_openings - 0.5; }
  [[nodiscard]] double highest() const { return domain_.size[0] - 0.5 - scene::kept_from_openings; }

  /// Places for cell `cell` to appear at `step`, in the order in which they are to be tried: its nodes, alone. They
  /// follow from the scene's seed, the cell and the step.
  [[nodiscard]] std::vector<core::Cells<D>> places(int cell, long step) const;
  /// Whether it keeps its distance from a cell of others.
  [[nodiscard]] bool is_apart(const core::Cells<D>& cell, const core::Cells<D>& others, int other) const;

 private:
  [[nodiscard]] core::Vec<D> way_in(const core::BoundingBox<D>& box, shape::RandomNumbers& numbers) const;
  /// Whether it keeps its distance from walls.
  [[nodiscard]] bool fits(const core::Cells<D>& cell) const;
  [[nodiscard]] bool is_apart(const core::Cells<D>& cell, const core::Cells<D>& others, int other,
                              const core::Vec<D>& move) const;

  const scene::Feed* feed_;  ///< null: no cells come in
  core::Cells<D> none_;      ///< but for the cell types
  core::Domain<D> domain_;
  core::RegionPointer<D> region_;
  int most_;  ///< cells that may come in
  scene::Vector origin_;
  double spacing_;               ///< m
  double cells_per_second_ = 0;  ///< of the feed
  std::vector<double> flux_;     ///< sum up to and with each row of the inlet
};

extern template class Inflow<2>;
extern template class Inflow<3>;

}  // namespace rouleau::run
