// Places rigid cells at random without overlap: the `random` form of a scene's cells.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace rouleau::shape {

/// Where a packing came to a standstill.
struct PackingShortfall {
  std::size_t packing;  ///< index: the first whose cells found no room
  double hematocrit;    ///< of its region, by those of its cells and parts of cells that found room
};

/// Told now and then, while cells are packed: what share of what all of them shall enclose has found room.
using PackingWatch = std::function<void(double share)>;

/// Cells of this type that fill a share `hematocrit` of the packing's region, to the nearest whole number; of cells
/// that are tiny in a large region more than any integer holds.
double cells_for(double hematocrit, const scene::CellType& type, const scene::RandomPacking& packing,
                 const scene::Domain& domain);
/// Share of the packing's region, of the fluid's area or volume in it, that its cells fill. In a tube a region is a
/// piece of it.
double hematocrit_of(const scene::RandomPacking& packing, const scene::CellType& type, const scene::Domain& domain);

/// Gives a centre and an angle, in three dimensions an axis, too, to the cells of all packings, [first, first + count)
/// of `cells`, in their shape at rest. All other cells are obstacles. No cell may be longer, and no gap wider, than the
/// domain is from corner to corner: the periodic images that come near a cell would be countless. Outlines and surfaces
/// keep the larger gap of the two packings from each other, and that of their own packing from obstacles and walls;
/// periodic images count as cells. From walls of any shape they keep it between their nodes, too, and no cell lies
/// around a piece of wall that holds a node of the lattice.
///
/// Random sequential adsorption ends, for cells of this shape, near a third of the area. So a cell that finds no room
/// is drawn smaller, and hard-particle Monte Carlo moves (Metropolis et al., J. Chem. Phys. 21, 1953) of all cells make
/// room in which the small ones grow, each on its own, until all have their size (after Lubachevsky and Stillinger,
/// J. Stat. Phys. 60, 1990, with random moves in place of collisions). As many sweeps again make the cells forget the
/// order in which they grew. Every configuration without overlap is then equally likely, as far as the sweeps reach.
///
/// The same request gives the same centres and angles to the last bit on every machine, between walls of any shape up
/// to the rounding of distances to these: the engine is the C++ standard's 64-bit Mersenne twister, nothing is decided
/// by a function of libm (rigid_body.hpp), angles are multiples of 2 pi / 2^20, and effort is counted in sweeps, not in
/// seconds.
std::optional<PackingShortfall> pack(const scene::Domain& domain, const std::vector<scene::CellType>& types,
                                     const std::vector<scene::RandomPacking>& packings,
                                     std::vector<scene::CellPlacement>& cells, const PackingWatch& watch = {});

}  // namespace rouleau::shape
