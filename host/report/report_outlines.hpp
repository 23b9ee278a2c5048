// Outlines of cells and walls as report.html carries them: integers relative to each cell's origin, in base64.
#pragma once

#include <functional>
#include <map>
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

/// Which cells the outputs of a page have, and how many nodes of each.
class CellLayout {
 public:
  /// Those of the next output, one node in `stride`. False where a cell has another number of nodes than before.
  bool add(const observe::OutlineSnapshot& outlines, std::size_t stride = 1);
  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  /// cells, first and there, as outline_data has them.
  void put_into(nlohmann::json& result) const;

 private:
  std::map<int, std::size_t> nodes_;     ///< of each cell
  std::vector<std::vector<int>> there_;  ///< cells of each output
};

/// What places within a domain of this size are multiples of, m.
double quantum_of(const std::vector<double>& size);
/// Adds a length as a little-endian int16 of quanta; 0 where it is no number.
void append_place(std::vector<unsigned char>& bytes, double metres, double quantum);
/// Adds a number as a little-endian int32.
void append_number(std::vector<unsigned char>& bytes, int number);

/// What all but one tension in a hundred stay below in magnitude, N/m: the ends of cells would hide the rest. outlines:
/// those of an output.
using Outlines = std::function<observe::OutlineSnapshot(int output)>;
double tension_scale(const Outlines& outlines, const std::vector<std::size_t>& selection);

/// Tensions of one node in `stride` of every cell as signed bytes in base64: 127 stands for `scale`.
std::string tension_bytes(const observe::OutlineSnapshot& outlines, std::size_t stride, double scale);

/// Base64 (RFC 4648) of bytes.
std::string base64(const std::vector<unsigned char>& bytes);

/// {corners_um, first, segments, surface}: x and y of the corners of polygons around walls, one after another, polygon
/// i from corner first[i] on; segments: pairs of corners between which fluid meets them; surface {quantum_um, points,
/// triangles} in three dimensions, else null: base64 of 16-bit multiples of the quantum, x, y, z of every corner, and
/// of 32-bit numbers of corners. Null without such walls.
nlohmann::json wall_data(const files::FrameReader& reader);

}  // namespace rouleau::report
