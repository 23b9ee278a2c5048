// Outlines of cells as they are placed: closed polygons with equal segments on the shapes a scene can name.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.hpp"

namespace rouleau::shape {

/// Nodes of a closed polygon, counter-clockwise, in metres, centred at the origin at angle 0; node 0 lies on the
/// positive x axis.
struct Outline {
  std::vector<Eigen::Vector2d> nodes;
};

/// Polygon with its `segments` nodes on the shape and all segments equally long (to about 1e-12 of their length).
/// Throws std::invalid_argument for fewer than 3 segments or a size that is not positive.
Outline make_outline(const scene::Shape& shape, int segments);

/// The outline in which a type with one is free of stress, with a node for each of `first`, which is of its shape.
Outline stress_free_outline(const scene::CellType& type, const Outline& first);

/// Length of the membrane as placed, m, of a shape of two dimensions: exact for circles, to 1e-5 for others
/// (Ramanujan's formula for ellipses).
double shape_perimeter(const scene::Shape& shape);

/// Area that an outline encloses, m2.
double area_of(const Outline& outline);

}  // namespace rouleau::shape
