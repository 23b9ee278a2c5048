// The cells of a scene, placed on its lattice and checked.
#pragma once

#include <functional>
#include <type_traits>

#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "scene/lattice.hpp"

namespace rouleau::plan {

/// Membranes of a scene's cells on a lattice of the given spacing (m). Throws Error(bad_input) with the place of the
/// entry in the scene when a cell crosses itself, sticks through a wall or overlaps another cell (over periodic
/// images).
core::Membranes make_membranes(const scene::Scene& scene, double spacing);
/// The same in three dimensions; overlaps are found where one cell's node lies inside another.
core::Surfaces make_surfaces(const scene::Scene& scene, double spacing);
/// All cells of a scene of D dimensions, or one of them.
template <int D>
using Cells = std::conditional_t<D == 2, core::Membranes, core::Surfaces>;
/// Calls function(c, cell) with each cell by itself, as it would be placed and without a check: for who does not need
/// all of them at once.
template <int D>
void for_each_cell(const scene::Scene& scene, double spacing,
                   const std::function<void(std::size_t c, const Cells<D>& cell)>& function);
/// All cells on the scene's own lattice, unchecked, of which those alone take memory that are `known`; the others'
/// nodes are anywhere.
template <int D>
Cells<D> make_known_cells(const scene::Scene& scene, const std::function<bool(int cell)>& known);
/// Either, on the scene's own lattice.
template <int D>
auto make_cells(const scene::Scene& scene) {
  if constexpr (D == 2) {
    return make_membranes(scene, scene::lattice_spacing(scene));
  } else {
    return make_surfaces(scene, scene::lattice_spacing(scene));
  }
}

/// Throws what making the cells does, without room for all of them: in two dimensions so many are made at a time.
void try_cells(const scene::Scene& scene, std::size_t of_strip = 20'000);

}  // namespace rouleau::plan
