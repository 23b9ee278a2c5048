// Borders of walls, polygons and triangles, and the regions that they enclose.
#pragma once

#include <string>

#include "core/domain/domain.hpp"
#include "core/geometry/border.hpp"
#include "core/geometry/region.hpp"
#include "scene/scene_reader.hpp"
#include "scene/wall_shape.hpp"

namespace rouleau::shape {

/// Places in the plane or in space are in a unit of length, `unit` m, in which a domain begins at -1/2 (core/domain);
/// faults name a pointer of the scene.

/// Refuses what reaches more than a period beyond the domain along an axis: its images would have to come again.
void require_reach(const scene::SceneFields& fields, const std::string& pointer, int axis, double period, double from,
                   double to, double unit);

/// As the file has it, turned and moved, m. Corners at nearly the same place are one where it is not closed otherwise.
core::Border<3> mesh_border(const scene::WallShape::Mesh& mesh);

/// What a border and its images along periodic axes enclose; refused where they leave it open, or where it is inside
/// out.
template <int D>
core::RegionPointer<D> closed_region(const scene::SceneFields& fields, const std::string& pointer,
                                     core::Border<D> border, const core::Domain<D>& domain, double unit);

/// What belongs to a picture, or in space to a stack of them, with images. Its border lies at half grey, linear between
/// middles of pixels; along a periodic axis that it fills the picture goes on with itself, elsewhere it ends.
template <int D>
core::RegionPointer<D> picture_region(const scene::SceneFields& fields, const std::string& pointer,
                                      const scene::WallShape::Image& image, const core::Domain<D>& domain, double unit);

}  // namespace rouleau::shape
