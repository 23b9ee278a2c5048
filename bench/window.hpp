// What surrounds one block of a scene: enough of the lattice and of the cells for all that its rank hears of.
#pragma once

#include <array>
#include <vector>

#include "core/domain/decomposition.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/solver/solver_setup.hpp"
#include "plan/placed_cells.hpp"
#include "plan/plan.hpp"

namespace rouleau::bench {

/// A part of a scene's lattice, a small scene of its own: the block of one rank, those around it as far as they lie
/// within, and the cells as they are placed. It ends where the lattice does, or further away than the block's rank
/// hears of a cell; there the lattice goes on periodically, or is closed by a wall that moves with the fluid. No cell
/// lies over such an end.
template <int D>
struct Window {
  core::Decomposition<D> blocks;    ///< of the window
  int rank;                         ///< whose block is the scene's
  bool merged;                      ///< there would be very many others: one for each side, edge and corner
  core::Cells<D> cells;             ///< in their order
  core::BasicSolverSetup<D> setup;  ///< of the first stage; the domain is the window in one piece
  /// Largest speed of the fluid at a cell of the scene. All ranks make their lists of what is near anew when any cell
  /// has gone some way, so that one cell of the window, far from the block, is moved to and fro at this speed; -1:
  /// those of the window are as fast.
  double fastest = 0;
  int runner = -1;

  /// Velocity of the fluid along x at a height of the window, and its slope: the first stage's developed flow without
  /// cells; between no walls across y it is at rest.
  struct Flow {
    core::ChannelFlow of_scene;
    double bottom = 0;  ///< where the window begins
    [[nodiscard]] double velocity(double y) const { return of_scene.velocity(y + bottom); }
    [[nodiscard]] double slope(double y) const { return of_scene.slope(y + bottom); }
  } flow;
};

template <int D>
Window<D> window_around(const plan::Plan& plan, const core::Decomposition<D>& blocks, int rank);

}  // namespace rouleau::bench
