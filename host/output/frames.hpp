// frames.h5: outlines of all cells at every output time, fluid fields where due, in a form ParaView and h5py open.
//
//   /                      attributes format, title, size_m [2], nodes [2], periodic_y
//   /frames/000000         attributes step, time_s, strain, stage, stage_name
//     membranes/points     [n, 2] f64, m, not wrapped into the box
//     membranes/tension    [n] f64, N/m, of the segment from this node to the cell's next one
//     membranes/first      [cells + 1] i32, first node of each cell and the total
//     membranes/cell       [n] i32     membranes/aggregate [n] i32, label: smallest index of its cells
//     membranes/connectivity           closed polylines for XDMF
//     fields/velocity      [ny, nx, 3] f32, m/s (third component 0: XDMF's vectors have three)
//     fields/density, viscosity, vorticity [ny, nx] f32
//
// Every dataset has its unit as attribute "unit". Node (i, j) of the lattice lies at ((i + 1/2) dx, (j + 1/2) dx).
// first, cell and connectivity are links to one dataset as long as they do not change, so that they cost nothing per
// frame.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "output/frames_handle.hpp"
#include "output/snapshot.hpp"

namespace rouleau::host {

/// What frames.xmf has to know about a frame.
struct FrameRecord {
  double time = 0;                   ///< s
  std::size_t nodes = 0, cells = 0;  ///< of membranes; 0: none
  std::size_t connectivity = 0;      ///< entries
  bool uniform = false;              ///< all cells have the same number of nodes
  std::vector<std::string> fields;   ///< datasets under fields/
};

class FrameWriter {
 public:
  /// Creates the file; throws Error(input_output), as all members do.
  FrameWriter(const std::filesystem::path& file, const Scene& scene);
  /// Adds a frame and flushes, so that a crash later on leaves a file that can be read up to here.
  void write(const Snapshot& snapshot);
  void close() { file_.close(); }
  /// The frames.xmf that goes with the file.
  [[nodiscard]] std::string xdmf() const;

 private:
  void write_membranes(const std::string& frame, const Snapshot& snapshot, FrameRecord& record);
  void write_topology(const std::vector<int>& first);
  void write_fields(const std::string& frame, const FieldSnapshot& fields, FrameRecord& record);

  Hdf5File file_;
  std::string file_name_, title_;
  std::array<double, 2> size_;
  std::array<int, 2> nodes_;
  std::vector<FrameRecord> frames_;
  std::vector<int> first_;       ///< as in the topology written last
  FrameRecord topology_record_;  ///< of the topology written last
  std::string topology_;         ///< its group
  int topologies_ = 0;
};

/// XDMF text: one temporal collection for the membranes and one for the fields, for frames 0, 1, ... of `h5`.
std::string xdmf_text(const std::vector<FrameRecord>& frames, const std::string& h5, const std::array<double, 2>& size,
                      const std::array<int, 2>& nodes);

/// Outlines read back from a frames.h5. Throws Error(input_output).
class FrameReader {
 public:
  explicit FrameReader(const std::filesystem::path& file) : file_(file, Hdf5File::Mode::read) {}
  [[nodiscard]] std::array<double, 2> size() const;  ///< of the domain, m
  [[nodiscard]] bool periodic_y() const { return file_.read_attribute("/", "periodic_y") != 0; }
  [[nodiscard]] int frames() const { return file_.members("/frames"); }
  [[nodiscard]] long step(int frame) const;
  /// Empty (no cells) when the frame has no membranes.
  [[nodiscard]] OutlineSnapshot outlines(int frame) const;

 private:
  Hdf5File file_;
};

/// "/frames/000012"
std::string frame_path(std::size_t frame);

}  // namespace rouleau::host
