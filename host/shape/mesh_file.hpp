// Surfaces of triangles from files: OBJ, OFF, PLY and STL, as meshing programs write them.
#pragma once

#include <filesystem>

#include "surface.hpp"

namespace rouleau::shape {

/// Coordinates are in the file's own unit. Faces of more corners are cut into triangles. The format follows from how the
/// file begins: OFF in text, PLY in text or little-endian, STL in text or binary, of which corners at the same place are
/// one node; of OBJ, which begins with anything, from the name's end. Throws Error(input_output) for a file that cannot be
/// read, Error(bad_input) with the line (or, of binary files, the face) for what is no surface of finite size that is
/// closed, in one piece and without seams (core::Mesh).
TriangleSurface read_mesh(const std::filesystem::path& file);

}  // namespace rouleau::shape
