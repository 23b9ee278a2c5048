// The developed flow through a section across x of any shape, from the section's own nodes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/fluid/walls.hpp"

namespace rouleau::core {

/// Of the fluid nodes of a lattice at column x, if the section there goes on without end. Walls lie where the lattice's
/// links are cut, and velocities are exact between planes (Shortley and Weller, J. Appl. Phys. 9,
/// 334, 1938). Several channels beside each other have one pressure gradient.
struct Section {
  /// By row of the lattice, 0 in the solid: the velocity along x for each force per volume over the viscosity, and what
  /// the walls drag along. Without any wall the former is not finite.
  std::vector<double> driven, dragged;
  double mean_driven = 0, mean_dragged = 0;  ///< of the fluid nodes

  /// The velocity of a row where the mean of the fluid nodes is `mean`.
  [[nodiscard]] double velocity(std::size_t row, double mean) const {
    if (std::isinf(mean_driven)) return driven[row] == 0 ? 0 : mean;
    return dragged[row] + driven[row] * ((mean - mean_dragged) / mean_driven);
  }
};

/// `solid`: null, or the solid nodes.
template <int D>
Section section_at(const Domain<D>& domain, const SolidNodes<D>* solid, const WallVelocity& walls, int x);

/// The openings beside each other at an end along x, 0 the lower one and 1 the upper one: by row of the lattice the
/// number of the connected part of the fluid that the row's node belongs to, -1 in the solid. Nodes are connected along
/// axes, over periods, too. Parts are numbered from 0 in the order of their first rows, of which those at the lowest z,
/// and there at the lowest y, come first.
template <int D>
std::vector<int> parts_of_section(const Domain<D>& domain, int end,
                                  const std::function<bool(const std::array<int, D>& node)>& is_fluid);
/// The same of both ends. `solid`: null without solid nodes.
template <int D>
std::array<std::vector<int>, 2> parts_of_ends(const Domain<D>& domain, const SolidNodes<D>* solid);

}  // namespace rouleau::core
