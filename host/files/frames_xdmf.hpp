// frames.xmf: tells ParaView what the datasets of frames.h5 mean.
#pragma once

#include <string>
#include <vector>
#include "walls.hpp"

namespace rouleau::files {

/// "/frames/000012"
std::string frame_path(std::size_t frame);

/// What frames.xmf has to know about the membranes of a frame.
struct Topology {
  std::size_t nodes = 0, cells = 0;  ///< 0: none
  std::size_t connectivity = 0;      ///< entries
  bool uniform = false;              ///< all cells have the same number of nodes
  bool surfaces = false;             ///< triangles, of three nodes each, and not outlines
};

/// And about the frame.
struct FrameRecord : Topology {
  double time = 0;                  ///< s
  std::vector<std::string> fields;  ///< datasets under fields/
  bool sheared_walls = false;       ///< it has walls/wall_shear_stress
};

/// Where the nodes lie that the fields are given at, and how their numbers are stored.
struct FieldGrid {
  std::vector<double> origin, spacing;  ///< m, of the first node, and between nodes; along x, y and, if there is one, z
  std::vector<int> nodes;
  int bytes = 4;  ///< of a number
};

/// XDMF text: temporal collections for membranes, fields and what there is on walls, for frames 0, 1, ... of `h5`,
/// and the walls.
std::string xdmf_text(const std::vector<FrameRecord>& frames, const std::string& h5, const FieldGrid& grid,
                      const WallBorder& walls);

}  // namespace rouleau::files
