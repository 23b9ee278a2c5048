// Regions given by a formula.
#pragma once

#include "region.hpp"

namespace rouleau::core {

/// Between two corners; infinite components are no border.
template <int D>
RegionPointer<D> box_region(const Vec<D>& lower, const Vec<D>& upper);

/// Between the walls across a domain's axes.
template <int D>
RegionPointer<D> between_walls(const Domain<D>& domain);

/// A disc, or a ball.
template <int D>
RegionPointer<D> ball_region(const Vec<D>& center, double radius);

/// A region of a plane, extended from one height to another along an axis across it; the plane's coordinates are those
/// along the other two axes, in their order. Infinite heights are no border. A disc becomes a cylinder.
RegionPointer<3> extruded(RegionPointer<2> section, int axis, double from, double to);

}  // namespace rouleau::core
