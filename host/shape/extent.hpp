// How much there is of a cell, as an outline or as a surface.
#pragma once

#include "scene/scene.hpp"

namespace rouleau::shape {

/// What a cell of this type encloses as placed: m2 of an outline, m3 of a surface.
double enclosed_by(const scene::CellType& type);
/// Nodes of a closed surface without holes, by Euler's formula.
int surface_nodes(int triangles);
/// Triangles of a divided icosahedron, 20 n^2, whose edges are so many times longer than with `triangles`.
int divided_triangles(int triangles, double coarser);
/// Nodes of its membrane.
double node_count(const scene::CellType& type);
/// Mean length of its segments, or of its edges, m.
double node_spacing(const scene::CellType& type);

/// Half of the longest axis, m: what Reynolds, capillary and adhesion numbers are made with.
double shape_radius(const scene::Shape& shape);
/// That of the smallest cell of a scene; 0 without cells.
double smallest_radius(const scene::Scene& scene);

}  // namespace rouleau::shape
