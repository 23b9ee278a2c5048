// What is read off one cell: by its owner, for the first rank, which writes.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "core/geometry/region.hpp"
#include "core/membrane/geometry.hpp"
#include "core/surface/surfaces.hpp"
#include "scene/scene.hpp"
#include "snapshot.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::observe {

/// Lattice units; copied bit by bit from rank to rank.
struct CellMeasures {
  int cell;
  double x, y;         ///< centroid
  double deformation;  ///< (L - B) / (L + B)
  double long_axis;    ///< angle against x of the axis L, rad, modulo pi; NaN: the cell is round
  double marker;       ///< angle of a node about the centroid, rad, modulo 2 pi
  std::optional<double> area = {}, perimeter = {};  ///< of an outline
  double wall_gap;                                  ///< NaN without walls
  double gap = 0;  ///< to the nearest other cell, which others than the cell are asked for
  core::StretchRange stretch;
  // Of a surface.
  double z = 0, volume = 0, surface_area = 0;
  std::array<double, 3> semi_axes{};   ///< largest first
  std::array<double, 3> short_axis{};  ///< unit vector, its first component that is not 0 positive
  std::array<double, 3> extent{};      ///< along x, y and z
  double velocity = 0;                 ///< along x, mean over what the cell encloses
  double treading = 0;                 ///< of the membrane within its shape, counter-clockwise about z, rad per step
  double rear_hollow = 0;              ///< CellSnapshot::rear_hollow
  double length_along_force = std::numeric_limits<double>::quiet_NaN(), width_across_force = length_along_force;
};

/// Adds its extents along and across the first force in the scene's stages that pulls at the cell, or gravity.
void measure_pulled(const scene::Scene& scene, const core::CellNodes& nodes, CellMeasures& measures);

/// `region`: of the fluid (scene::fluid_region); null: planes alone close the domain. `marker`: the node that is
/// followed, counted from the cell's first; of an outline the first one is.
CellMeasures measure(const core::Membranes& membranes, int cell, const core::Domain<2>& domain,
                     const core::Region<2>* region = nullptr, int marker = 0);
CellMeasures measure(const core::Surfaces& surfaces, int cell, const core::Domain<3>& domain,
                     const core::Region<3>* region, int marker);

/// Area that an outline encloses.
double enclosed(const core::Membranes& membranes, int cell);
/// Volume that a surface encloses.
double enclosed(const core::Surfaces& surfaces, int cell);

/// Integral of the velocity along an axis over what a cell encloses.
double carried(const core::Membranes& membranes, int cell, int axis = 0);
double carried(const core::Surfaces& surfaces, int cell, int axis = 0);

/// The node of a surface farthest from the line along z through its centroid: its angle about that line is told best.
int outermost(const core::Surfaces& surfaces, int cell);
/// Of an outline its first node.
inline int outermost(const core::Membranes& /*membranes*/, int /*cell*/) { return 0; }

/// What cells.csv has of a surface alone, in SI; the cell's place along y is known.
void describe_surface(const CellMeasures& measures, const units::LatticeUnits& units, const scene::Domain& domain,
                      CellSnapshot& cell);

}  // namespace rouleau::observe
