// The cells of a scene, placed on its lattice and checked.
#pragma once

#include <functional>

#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "scene/lattice.hpp"

namespace rouleau::plan {

/// The cell types of a scene of D dimensions on a lattice of this spacing, m, and no cell yet.
template <int D>
core::Cells<D> without_cells(const scene::Scene& scene, double spacing);
/// Adds a cell of one of these types, unchecked.
void add_placed(core::Membranes& membranes, const scene::CellPlacement& cell, double spacing);
void add_placed(core::Surfaces& surfaces, const scene::CellPlacement& cell, double spacing);
/// Whether a place on the lattice lies in a cell.
bool encloses(const core::Membranes& membranes, int cell, const core::Vec<2>& place);
bool encloses(const core::Surfaces& surfaces, int cell, const core::Vec<3>& place);

/// Membranes of the cells of a scene of D dimensions on a lattice of the given spacing (m). Throws Error(bad_input)
/// with the place of the entry in the scene when a cell sticks through a wall or overlaps another cell (over periodic
/// images), surfaces where a node of one lies inside the other, or when an outline crosses itself.
/// Of the cells that are there at the beginning.
template <int D>
core::Cells<D> make_cells(const scene::Scene& scene, double spacing);
/// The same on the scene's own lattice.
template <int D>
core::Cells<D> make_cells(const scene::Scene& scene) {
  return make_cells<D>(scene, scene::lattice_spacing(scene));
}
/// Calls function(c, cell) with each cell that is there at the beginning by itself, as it would be placed and without
/// a check: for who does not need all of them at once.
template <int D>
void for_each_cell(const scene::Scene& scene, double spacing,
                   const std::function<void(std::size_t c, const core::Cells<D>& cell)>& function);
/// All cells on the scene's own lattice, unchecked, of which those alone take memory that are `known`; the others'
/// nodes are anywhere.
template <int D>
core::Cells<D> make_known_cells(const scene::Scene& scene, const std::function<bool(int cell)>& known);

/// Throws what making the cells does, without room for all of them: in two dimensions so many are made at a time.
void try_cells(const scene::Scene& scene, std::size_t of_strip = 20'000);

}  // namespace rouleau::plan
