// Surfaces of triangles from files: OFF, STL and PLY, as meshing programs write them.
#pragma once

#include <filesystem>

#include "surface.hpp"

namespace rouleau::shape {

/// Coordinates are in the file's own unit. Faces of more corners are cut into triangles. The format follows from how the
/// file begins: OFF in text, PLY in text or little-endian, STL in text or binary, of which corners at the same place are
/// one node. Throws Error(input_output) for a file that cannot be read, Error(bad_input) with the line (or, of binary files, the face) for
/// what is no surface of finite size that is closed, in one piece and without seams (core::Mesh).
TriangleSurface read_mesh(const std::filesystem::path& file);

}  // namespace rouleau::shape
