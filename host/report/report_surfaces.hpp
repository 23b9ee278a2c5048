// The surfaces of a three-dimensional run as the page holds them.
#pragma once

#include <vector>

#include "files/frames.hpp"
#include "json/json.hpp"

namespace rouleau::report {

/// {quantum_um, cells, first, there, meshes, mesh, outputs, origin_um, nodes, tension} of
/// the outputs `selection`, or of so many of them that the page stays small: `outputs` are places in the selection.
/// cells, first and there are those of outline_data. meshes: triangles of different cells, 32-bit numbers of nodes from
/// a cell's first; mesh: which of them each cell has. Nodes of an output are 16-bit multiples of the quantum from their
/// cell's origin; both in base64. tension {scale_N_per_m, values} of int8 for each node, the mean of its triangles over
/// the scale times 127. Null without surfaces.
nlohmann::json surface_data(const files::FrameReader& reader, const std::vector<std::size_t>& selection);

}  // namespace rouleau::report
