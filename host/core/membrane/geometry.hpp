// What can be read off a closed polygon: area, perimeter, inertia ellipse, distances between cells.
#pragma once

#include <algorithm>
#include <limits>

#include "core/domain/images.hpp"
#include "core/domain/vec.hpp"
#include "membranes.hpp"

namespace rouleau::core {

/// z component of the cross product: positive where b lies counter-clockwise of a.
inline double cross(const Vec<2>& a, const Vec<2>& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Signed area, positive for a counter-clockwise outline.
double enclosed_area(const Membranes& membranes, const CellRange& cell);
double perimeter(const Membranes& membranes, const CellRange& cell);
/// Smallest and largest stretch of a segment: length over rest length.
struct StretchRange {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  void add(double stretch) {
    least = std::min(least, stretch);
    most = std::max(most, stretch);
  }
};
StretchRange stretch_range(const Membranes& membranes, const CellRange& cell);
/// Centroid of the enclosed area.
Vec<2> centroid(const Membranes& membranes, const CellRange& cell);

/// Ellipse with the same second moments of area as the polygon.
struct InertiaEllipse {
  double semi_major, semi_minor;
  double angle;        ///< of the major axis against x, in (-pi/2, pi/2]
  double deformation;  ///< (semi_major - semi_minor) / (semi_major + semi_minor)
};
/// From the exact second moments of the polygon.
InertiaEllipse inertia_ellipse(const Membranes& membranes, const CellRange& cell);

/// Angle of marker node 0 about the centroid, in (-pi, pi].
double marker_angle(const Membranes& membranes, const CellRange& cell);

/// Smallest distance between the outlines of cell a and of cell b moved by `shift` periods, exact for two polygons that
/// do not cross. Returns infinity when it is above `limit`.
double outline_distance(const Membranes& membranes, const CellRange& a, const CellRange& b, ImageShift shift,
                        const Domain<2>& domain, double limit = std::numeric_limits<double>::infinity());

/// Rest length of cell a's membrane that lies nearer than `reach` to the outline of cell b moved by `shift` periods.
double facing_length(const Membranes& membranes, const CellRange& a, const CellRange& b, ImageShift shift,
                     const Domain<2>& domain, double reach);

/// Smallest gap of two cells over all periodic images (of cell a to its own images if a == b); infinity above `limit`.
/// `limit` must be finite: it bounds the images that are looked at.
double smallest_gap(const Membranes& membranes, int a, int b, const Domain<2>& domain, double limit);

/// Depth to which a point lies inside a cell moved by `shift`: distance to its outline; negative outside.
double depth_inside(const Membranes& membranes, const CellRange& cell, const Vec<2>& point);

}  // namespace rouleau::core
