// Checks of membrane nodes, and how ranks agree on which of their failures the run fails with.
#pragma once

#include <array>
#include <optional>

#include "core/domain/ranks.hpp"
#include "core/solver/any_solver.hpp"
#include "failure.hpp"
#include "scene/scene.hpp"
#include "scene/stage_scales.hpp"

namespace rouleau::monitor {

/// The failure that one rank would have found first: the one with the least `order`, numbers compared one after
/// another. On all ranks, which ask together; none: no rank has found any. No two ranks' failures have the same order.
template <int D>
std::optional<Failure> first_failure(const core::Ranks<D>& ranks, std::optional<Failure> mine,
                                     std::array<double, 2> order);

/// What to do when a run has blown up for no narrower reason.
inline std::string blown_up_remedy(const scene::Stage& stage) {
  return "lower " + stage.density_factor_key +
         " (it divides every lattice stiffness and speed), or see the margins in the scene's plan";
}

/// A node, and where it was before its last step. Lattice units.
struct FoundNode {
  double step = 0;              ///< how far it moved; NaN: its velocity is no number
  int node = -1, cell = -1;     ///< -1: there is none
  std::array<double, 3> place;  ///< z is 0 in two dimensions
};

/// The node of any rank's cells that moved furthest in the last step. All ranks ask together, and get the same.
template <int D>
FoundNode farthest_node(const core::CellNodes& cells, const core::Ranks<D>& ranks);

/// Sets cell and place of a failure to those of a node. `spacing` in m.
template <int D>
void locate_failure(Failure& failure, const FoundNode& node, double spacing);

/// The first check that the last step failed, without its time: a node that moved further than `limit` lattice
/// spacings, is nowhere, or has left the domain. All ranks ask together, and get the same.
template <int D>
std::optional<Failure> check_nodes(const core::AnySolver<D>& solver, double limit, const scene::StageSetting& setting);

}  // namespace rouleau::monitor
