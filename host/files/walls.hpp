// Walls that are no planes, as pictures show them: what frames.h5 has of them.
#pragma once

#include "hdf5/hdf5_file.hpp"
#include "observe/snapshot.hpp"
#include "observe/walls/wall_border.hpp"

namespace rouleau::files {

using observe::WallBorder;

/// Adds them to a file as group /walls, unless they are empty. Throws Error(input_output).
void write_walls(hdf5::File& file, const WallBorder& walls);
/// Fields that are given on their facets, as datasets of a group, which is made if there are any: whether there are.
bool write_on_walls(hdf5::File& file, const std::string& group, const std::vector<observe::Field>& fields);
/// Empty where the file has none. Throws Error(input_output), also where numbers do not fit each other.
WallBorder read_walls(const hdf5::File& file);

}  // namespace rouleau::files
