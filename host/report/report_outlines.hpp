// Outlines and surfaces of cells, and walls, as report.html carries them: integers relative to origins, in base64.
#pragma once

#include <string>
#include <vector>

#include "files/frames.hpp"
#include "json/json.hpp"

namespace rouleau::report {

/// A report tells lengths in micrometres.
inline constexpr double micro = 1e6;

/// {quantum_um, cells, first, there, origin_um, nodes, tension} of the outputs `selection`, one
/// node in `stride` of every cell. cells, first: of all that are there at some output, their numbers and where their
/// nodes begin if all are; there: of each output, places among them of those that are there, null: all are. nodes[k]
/// is, for the k-th output, base64 of little-endian int16 x, y of every node that is there, in quanta from its cell's
/// origin; tension {scale_N_per_m, values} of int8 for each node, the tension of the segment that begins there over the
/// scale times 127. Null when there are no cells, or when the number of a cell's nodes changes; also of surfaces.
nlohmann::json outline_data(const files::FrameReader& reader, const std::vector<std::size_t>& selection,
                            std::size_t stride);

/// {quantum_um, cells, first, there, meshes, mesh, outputs, origin_um, nodes, tension} of
/// the outputs `selection`, or of so many of them that the page stays small: `outputs` are places in the selection.
/// cells, first and there are those of outline_data. meshes: triangles of different cells, 32-bit numbers of nodes from
/// a cell's first; mesh: which of them each cell has. Nodes of an output are 16-bit multiples of the quantum from their
/// cell's origin; both in base64. tension {scale_N_per_m, values} of int8 for each node, the mean of its triangles over
/// the scale times 127. Null without surfaces.
nlohmann::json surface_data(const files::FrameReader& reader, const std::vector<std::size_t>& selection);

/// Adds a length as a little-endian int16 of quanta; 0 where it is no number.
void append_place(std::vector<unsigned char>& bytes, double metres, double quantum);
/// Base64 (RFC 4648) of bytes.
std::string base64(const std::vector<unsigned char>& bytes);

/// {corners_um, first, segments, surface}: x and y of the corners of polygons around walls, one after another, polygon
/// i from corner first[i] on; segments: pairs of corners between which fluid meets them; surface {quantum_um, points,
/// triangles} in three dimensions, else null: base64 of 16-bit multiples of the quantum, x, y, z of every corner, and
/// of 32-bit numbers of corners. Null without such walls.
nlohmann::json wall_data(const files::FrameReader& reader);

}  // namespace rouleau::report
