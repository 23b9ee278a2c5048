// frames.h5: outlines of the cells that are there at every output time, fluid fields where due, in a form ParaView and
// h5py open.
//
//   /                      attributes format, title, size_m [2], nodes [2], periodic_y, between openings
//                          along x periodic_x, which is 0; where output.fields has a region or a stride:
//                          fields_first_m [2], fields_spacing_m [2]; each [3] in three dimensions, with periodic_z
//   /walls                 corners, first, segments; in three dimensions points, triangles: see WallBorder (walls.hpp)
//   /frames/000000         attributes step, time_s, strain, stage, stage_name
//     membranes/points     [n, 2] f64, m, not wrapped into the box; [n, 3] in three dimensions
//     membranes/tension    [n] f64, N/m, of the segment from this node to the cell's next one; of a surface the mean of
//                          the triangles around the node
//     membranes/curvature  [n] f64, 1/m, sum of both principal curvatures, in three dimensions
//     membranes/first      [cells + 1] i32, first node of each cell and the total
//     membranes/cell       [n] i32, number of the node's cell in the scene; those that are there, ascending
//     membranes/aggregate  [n] i32, label: smallest number of its cells
//     membranes/connectivity           closed polylines for XDMF; in three dimensions instead
//     membranes/triangles  [m, 3] i32  nodes, counter-clockwise seen from outside
//     fields/velocity      [ny, nx, 3] f32 or f64, m/s (third component 0: XDMF's vectors have three)
//     walls/wall_shear_stress [m, 3] f64, Pa, force of the fluid along the walls' segments, in three dimensions their
//                          triangles, per area (third component 0 in two dimensions)
//     fields/density, viscosity, vorticity [ny, nx] f32 or f64
//                          in three dimensions [nz, ny, nx, 3] (vorticity, too) and [nz, ny, nx]
//
// Every dataset has its unit as attribute "unit". Node (i, j) of the lattice lies at ((i + 1/2) dx, (j + 1/2) dx).
// first, cell and connectivity or triangles are links to one dataset as long as they do not change, so that they cost
// nothing per frame; they are written again when a cell comes or leaves. A frame without cells has no membranes.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "frame_segments.hpp"
#include "frames_xdmf.hpp"
#include "hdf5/hdf5_file.hpp"
#include "observe/snapshot.hpp"
#include "scene/scene.hpp"

namespace rouleau::files {

/// Writes frames.h5, in segments (frame_segments.hpp) so that no more than what follows the last checkpoint is lost
/// when the program is killed. What a reader finds in frames.h5 does not depend on the number of segments. Every member
/// throws Error(input_output).
class FrameWriter {
 public:
  /// Of a new run. `file` is frames.h5, which close() makes.
  FrameWriter(std::filesystem::path file, const scene::Scene& scene);
  /// Goes on behind the frames that seal() has named before. They must be there as they were; whatever was written
  /// after them is dropped.
  FrameWriter(std::filesystem::path file, const scene::Scene& scene, const FramesSaved& saved);

  /// Adds a frame and hands it to the system, so that a crash later on mostly leaves a segment that can be read. Has
  /// the fields given (observe::Field), in which all ranks take part.
  void write(const observe::Snapshot& snapshot);
  /// Closes the segment, synchronises it with the disk, and tells of all so far. The next frame begins another.
  const FramesSaved& seal();
  /// Makes frames.h5, which is or leads to all segments. Nothing may be written after it.
  void close();
  /// The files that there are after close().
  [[nodiscard]] std::vector<std::string> names() const;
  /// The frames.xmf that goes with the file.
  [[nodiscard]] std::string xdmf() const;

 private:
  [[nodiscard]] std::filesystem::path segment(std::size_t number) const {
    return file_.parent_path() / segment_name(number);
  }
  void open_segment();
  void write_header(hdf5::File& target) const;
  void write_membranes(const std::string& frame, const observe::Snapshot& snapshot, FrameRecord& record);
  void write_topology(const observe::MembraneSnapshot& membranes);
  /// A number of each node, the same for all of a cell.
  void write_of_cells(const std::string& path, const std::vector<int>& first, const std::vector<int>& number);
  void write_fields(const std::string& frame, const observe::FieldSnapshot& snapshot, FrameRecord& record);
  [[nodiscard]] FieldGrid field_grid() const;
  void read_back(const std::filesystem::path& source, std::size_t frames);
  void link_segments() const;

  std::filesystem::path file_;
  std::string title_;
  scene::Domain domain_;
  scene::FieldStorage storage_;
  WallBorder walls_;
  FramesSaved saved_;               ///< every sealed segment
  std::optional<hdf5::File> open_;  ///< the segment that is being written
  std::vector<FrameRecord> frames_;
  std::vector<int> cell_;       ///< as in the topology written last
  std::vector<int> first_;      ///< likewise
  Topology topology_record_;    ///< of the topology written last
  std::string topology_;        ///< its group
  bool topology_here_ = false;  ///< it is in the open segment
  int topologies_ = 0;
};

/// frames.h5 for reading; of a run that is still going on, or was killed, its segments, as if they were one file.
/// Throws Error(input_output).
hdf5::File open_frames(const std::filesystem::path& file);

/// What pictures need, read back from a run's frames. Throws Error(input_output).
class FrameReader {
 public:
  explicit FrameReader(const std::filesystem::path& file) : file_(open_frames(file)) {}
  [[nodiscard]] std::vector<double> size() const;    ///< of the domain along each of its axes, m
  [[nodiscard]] std::vector<bool> periodic() const;  ///< likewise
  [[nodiscard]] WallBorder walls() const { return read_walls(file_); }
  [[nodiscard]] int frames() const { return file_.members("/frames"); }
  /// Of the membranes, as they were written; 0 where the frame has none.
  [[nodiscard]] std::size_t nodes(int frame) const;
  [[nodiscard]] long step(int frame) const;
  /// Outlines or surfaces as written, without curvature. Empty (no cells) when the frame has no membranes.
  [[nodiscard]] observe::OutlineSnapshot outlines(int frame) const;

 private:
  hdf5::File file_;
};

/// The numbers of a frame's cells, from where each begins among the nodes. Throws Error(input_output) where they do not
/// ascend.
std::vector<int> cells_of(const hdf5::File& file, const std::string& group, const std::vector<int>& first);
/// All cells have the same number of nodes; `first` as in OutlineSnapshot.
bool equal_cells(const std::vector<int>& first);
/// The datasets that a frame's fields may have, in the order of frames.xmf.
inline constexpr std::array<const char*, 4> field_names{"velocity", "density", "viscosity", "vorticity"};

}  // namespace rouleau::files
