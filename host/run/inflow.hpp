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
/// touch a wall or another cell. Such places end near a third of the area (random sequential adsorption); a cell that
/// finds none slides in from the inlet along the open axis, until it comes near others.
template <int D>
class Inflow {
 public:
  /// The plan's scene has openings, and outlives it; `setup` of this stage.
  Inflow(const plan::Plan& plan, int stage, const core::BasicSolverSetup<D>& setup);

  /// How many cells should have come in after so long, s, or, behind an inlet with a pressure, with so much of all, m3
  /// or m2: their volume is the hematocrit's share of all that came in.
  [[nodiscard]] int due(double time, double come_in) const;
  /// Whether what comes in has to be measured.
  [[nodiscard]] bool measures() const { return cells_per_content_ > 0 && cells_per_second_ == 0; }
  /// Cells are wholly between these two, in spacings, when they come; a cell that has come nearer to an opening goes.
  [[nodiscard]] double lowest() const { return scene::kept_from_openings - 0.5; }
  [[nodiscard]] double highest() const { return domain_.size[axis_] - 0.5 - scene::kept_from_openings; }
  [[nodiscard]] int axis() const { return axis_; }  ///< the open one

  /// Places for the cell that comes in as number `cell`, in the order in which they are to be tried: its nodes, alone.
  /// They follow from the scene's seed, the cell, and for how long it has been due, in parts of the time in which one
  /// cell comes in: the same on any lattice, but for the spacings that are kept.
  [[nodiscard]] std::vector<core::Cells<D>> places(int cell, double time, double come_in) const;
  /// How far a cell can move along it, at most so far, before it comes too near a cell of others; -1: it is too near.
  [[nodiscard]] double way(const core::Cells<D>& cell, const core::Cells<D>& others, int other, double most) const;
  /// As far back, toward the inlet, as it may come in, and how far it could go from there.
  double draw_back(core::Cells<D>& cell) const;
  static void move(core::Cells<D>& cell, const core::Vec<D>& by);
  /// Whether it keeps its distance from walls.
  [[nodiscard]] bool fits(const core::Cells<D>& cell) const;

 private:
  /// The cells that should have come in, parts of them, too.
  [[nodiscard]] double expected(double time, double come_in) const;
  [[nodiscard]] core::Vec<D> way_in(const core::BoundingBox<D>& box, shape::RandomNumbers& numbers) const;
  [[nodiscard]] double way_beside(const core::Cells<D>& cell, const core::Cells<D>& others, int other,
                                  const core::Vec<D>& move, double most) const;

  const scene::Feed* feed_;  ///< null: no cells come in
  core::Cells<D> none_;      ///< but for the cell types
  core::Domain<D> domain_;
  int axis_;
  core::RegionPointer<D> region_;
  int most_;  ///< cells that may come in
  scene::Vector origin_;
  double spacing_;                ///< m
  double cells_per_content_ = 0;  ///< of the feed, 1/m3 or 1/m2
  double cells_per_second_ = 0;   ///< likewise, where the inlet has a velocity
  std::vector<double> flux_;      ///< sum up to and with each node of the inlet
};

}  // namespace rouleau::run
