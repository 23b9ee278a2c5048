// Surfaces of triangles from files: OBJ, OFF, PLY and STL, as meshing programs write them.
#pragma once

#include <filesystem>

#include "core/surface/triangle_surface.hpp"

namespace rouleau::shape {

/// Nodes no farther apart than this share of a mesh's largest extent are one, where the mesh is not closed otherwise: a
/// few units in the last of seven digits. Edges of a million even triangles are a hundred times longer.
inline constexpr double weld_distance = 1e-5;

/// What a file says, closed or not; of STL corners at the same place are one node. Nodes of triangles are there, and
/// finite. Throws what InputFile does, and Error(bad_input).
core::TriangleSurface read_triangles(const std::filesystem::path& file);
/// Nodes of a surface that are no farther apart are one, where it is not closed otherwise.
double weld_reach(const core::TriangleSurface& surface);

/// Coordinates are in the file's own unit. Faces of more corners are cut into triangles. The format follows from how
/// the file begins: OFF in text (also COFF, NOFF, STOFF), OBJ, PLY in text or binary, STL in text or binary, of which
/// corners at the same place are one node; the name's end tells OBJ that begins with something else. A mesh that is not
/// closed is welded (`weld_distance`). Throws what InputFile does, and Error(bad_input), with the line where one is to
/// blame, for what is no surface of finite size that is closed, in one piece and without seams (core::Mesh).
core::TriangleSurface read_mesh(const std::filesystem::path& file);

/// Nodes that lie no farther apart than `distance` become one, at the place of the first of them; triangles that lose a
/// corner so go. Returns how many nodes have gone; none where a triangle has a node that is not there. Throws
/// std::invalid_argument where so many lie together that it would take for ever.
int weld(core::TriangleSurface& surface, double distance);

}  // namespace rouleau::shape
