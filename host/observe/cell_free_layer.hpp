// The layers beside the walls that no cell reaches.
#pragma once

#include <vector>

#include "core/domain/domain.hpp"
#include "core/domain/ranks.hpp"
#include "core/geometry/region.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::observe {

/// Thickness of the layers at the walls across y, spacings: in each column of the lattice the distance from the wall to
/// the nearest membrane, averaged over the columns (edge of the core as in Fedosov, Caswell, Popel and Karniadakis,
/// Microcirculation 17, 2010). Half the height counts where no membrane is nearer.
/// All ranks together, of all cells; the first one gets it.
struct CellFreeLayer {
  double lower, upper;
  double empty = 1;  ///< share of the columns without a membrane
};
/// With more empty columns than this share the layers' thickness is that of the box.
inline constexpr double most_empty_columns = 0.05;
CellFreeLayer cell_free_layer(const core::Membranes& membranes, const core::Domain<2>& domain,
                              const core::Ranks<2>& ranks = {});
CellFreeLayer cell_free_layer(const core::Surfaces& surfaces, const core::Domain<3>& domain,
                              const core::Ranks<3>& ranks = {});

/// At the wall of a tube of this radius, spacings, about the middle axis along x: along rays from the axis, a spacing
/// apart at the wall, in each layer of nodes across x. Lower: the half of the wall with y below the axis. The radius
/// counts where a ray meets no membrane.
CellFreeLayer cell_free_layer_in_tube(const core::Surfaces& surfaces, const core::Domain<3>& domain, double radius,
                                      const core::Ranks<3>& ranks = {});

/// A point of a wall, with its share of the surface, and how far into the fluid this wall stays the nearest one.
template <int D>
struct WallPoint {
  core::Vec<D> place;
  double size, half_width;
};
/// At most about ten thousand points, evenly over all walls across a domain and those of a region.
template <int D>
std::vector<WallPoint<D>> wall_points(const core::RegionPointer<D>& region, const core::Domain<D>& domain);
/// At walls of any shape: mean over these points of the distance to the nearest node of a membrane; the half width
/// counts where none is nearer. Lower and upper are the same.
template <int D>
CellFreeLayer cell_free_layer_at(const std::vector<WallPoint<D>>& walls, const core::CellNodes& cells,
                                 const core::Domain<D>& domain, const core::Ranks<D>& ranks = {});

}  // namespace rouleau::observe
