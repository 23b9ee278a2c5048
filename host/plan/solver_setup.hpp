// What a scene and its plan are to the solver: lattice, membranes, and the setup of each stage.
#pragma once

#include <functional>
#include <type_traits>

#include "core/membrane/membranes.hpp"
#include "core/solver/solver_setup.hpp"
#include "core/surface/surfaces.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// The lattice of a scene of D dimensions, in one block; with D = 2, of one of three, its section across z.
template <int D = 2>
core::Domain<D> lattice_domain(const scene::Scene& scene);

/// Its nodes in the walls of a tube; null: it is none.
std::shared_ptr<const core::SolidNodes<3>> solid_nodes(const scene::Scene& scene);

/// Its layers of other viscosities.
std::vector<core::Layer> lattice_layers(const scene::Scene& scene);

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
/// Either, on the scene's own lattice.
template <int D>
auto make_cells(const scene::Scene& scene) {
  if constexpr (D == 2) {
    return make_membranes(scene, lattice_spacing(scene));
  } else {
    return make_surfaces(scene, lattice_spacing(scene));
  }
}

/// Smallest distance of the cells, as placed, to the wall of the tube in lattice spacings; infinite without either.
double gap_to_tube(const scene::Scene& scene);

/// Throws what making the cells does, without room for all of them: in two dimensions so many are made at a time.
void try_cells(const scene::Scene& scene, std::size_t of_strip = 20'000);

/// All of stage `index` of a scene of D dimensions in lattice units, with instances of its active models. Throws Error(plugin_refused) for a model
/// that cannot be made.
template <int D = 2>
core::BasicSolverSetup<D> make_solver_setup(const Plan& plan, int index);

}  // namespace rouleau::plan
