#include "frames.hpp"

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "file.hpp"
#include "hdf5/hdf5_rows.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::files {

bool equal_cells(const std::vector<int>& first) {
  for (std::size_t cell = 0; cell + 1 < first.size(); ++cell)
    if (first[cell + 1] - first[cell] != first[1] - first[0]) return false;
  return true;
}

FrameWriter::FrameWriter(std::filesystem::path file, const scene::Scene& scene)
    : file_(std::move(file)), title_(scene.title), domain_(scene.domain), storage_(scene.output.field_storage) {
  walls_ = observe::wall_border(scene);
}

void FrameWriter::write_header(hdf5::File& target) const {
  target.attribute("/", "format", "rouleau frames 1");
  target.attribute("/", "title", title_);
  target.attribute("/", "size_m", std::vector(domain_.size.begin(), domain_.size.end()));
  target.attribute("/", "nodes", std::vector<double>(domain_.nodes.begin(), domain_.nodes.end()));
  for (int axis = 1; axis < domain_.dimension(); ++axis)
    target.attribute("/", std::string("periodic_") + scene::axis_names[axis], domain_.periodic[axis] ? 1L : 0L);
  if (!domain_.periodic[0]) target.attribute("/", "periodic_x", 0L);
  if (!storage_.whole()) {
    const FieldGrid grid = field_grid();
    target.attribute("/", "fields_first_m", grid.origin);
    target.attribute("/", "fields_spacing_m", grid.spacing);
  }
  target.make_group("/frames");
  target.make_group("/topology");
  target.flush();
}

void FrameWriter::open_segment() {
  open_.emplace(segment(saved_.segments.size() + 1), hdf5::File::Mode::create);
  write_header(*open_);
  if (saved_.segments.empty()) write_walls(*open_, walls_);
  topology_here_ = false;
}

void FrameWriter::write(const observe::Snapshot& snapshot) {
  if (!open_) open_segment();
  const std::string frame = frame_path(frames_.size());
  open_->make_group(frame);
  open_->attribute(frame, "step", snapshot.step);
  open_->attribute(frame, "time_s", snapshot.time);
  open_->attribute(frame, "strain", snapshot.strain);
  open_->attribute(frame, "stage", static_cast<long>(snapshot.stage));
  open_->attribute(frame, "stage_name", snapshot.stage_name);
  FrameRecord record;
  record.time = snapshot.time;
  if (!snapshot.membranes.cell.empty())
    write_membranes(frame, snapshot, record);
  else
    observe::give_all(snapshot.membranes.fields);
  if (!snapshot.fields.empty()) write_fields(frame, snapshot.fields, record);
  record.sheared_walls = write_on_walls(*open_, frame + "/walls", snapshot.fields.on_walls);
  open_->flush();
  frames_.push_back(std::move(record));
}

namespace {

/// How many nodes are written at once of what is not brought from elsewhere.
constexpr std::size_t nodes_at_once = 1 << 20;

/// A dataset of whole numbers that are made some at a time.
class NumberRows {
 public:
  NumberRows(hdf5::File& file, const std::string& path, const std::vector<hsize_t>& shape)
      : columns_(shape.size() > 1 ? shape[1] : 1),
        rows_(file.begin(path, shape, false, H5T_STD_I32LE, H5T_NATIVE_INT, "1")) {}
  /// Where the next ones go; write() looks whether they are many.
  std::vector<int>& next() { return waiting_; }
  void write(bool last = false) {
    if (waiting_.empty() || (!last && waiting_.size() < nodes_at_once)) return;
    rows_.append(waiting_.data(), waiting_.size() / columns_);
    waiting_.clear();
  }

 private:
  hsize_t columns_;
  hdf5::Rows rows_;
  std::vector<int> waiting_;
};

[[noreturn]] void refuse_damaged(const hdf5::File& file, const std::string& group, const char* dataset,
                                 const char* other) {
  throw Error(Cause::input_output, Place{file.path().string()},
              group + dataset + " does not fit " + group + other + ": the file is damaged; repeat the run");
}

}  // namespace

void FrameWriter::write_membranes(const std::string& frame, const observe::Snapshot& snapshot, FrameRecord& record) {
  const observe::MembraneSnapshot& membranes = snapshot.membranes;
  if (!topology_here_ || membranes.first != first_ || membranes.cell != cell_) write_topology(membranes);
  static_cast<Topology&>(record) = topology_record_;

  const std::string group = frame + "/membranes";
  open_->make_group(group);
  for (const observe::Field& field : membranes.fields) {
    const auto components = static_cast<hsize_t>(field.components);
    std::vector<hsize_t> shape{record.nodes};
    if (components > 1) shape.push_back(components);
    std::string path = group;
    path.append("/").append(field.name);
    hdf5::Rows rows = open_->begin(path, shape, false, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, field.unit);
    field.give([&](const std::vector<double>& values) { rows.append(values.data(), values.size() / components); });
  }
  std::vector<int> aggregate = membranes.cell;
  for (std::size_t k = 0; k < std::min(aggregate.size(), snapshot.cells.size()); ++k)
    aggregate[k] = snapshot.cells[k].aggregate;
  write_of_cells(group + "/aggregate", membranes.first, aggregate);
  for (const char* shared : {"/first", "/cell", record.surfaces ? "/triangles" : "/connectivity"})
    open_->link(topology_ + shared, group + shared);
}

void FrameWriter::write_of_cells(const std::string& path, const std::vector<int>& first,
                                 const std::vector<int>& number) {
  NumberRows rows(*open_, path, {static_cast<hsize_t>(first.back())});
  for (std::size_t cell = 0; cell + 1 < first.size(); ++cell) {
    rows.next().insert(rows.next().end(), static_cast<std::size_t>(first[cell + 1] - first[cell]), number[cell]);
    rows.write();
  }
  rows.write(true);
}

void FrameWriter::write_topology(const observe::MembraneSnapshot& membranes) {
  const std::vector<int>&first = membranes.first, &cell_of = membranes.cell;
  constexpr int polyline = 2;  // XDMF's code in a mixed topology, followed by the number of nodes
  const std::size_t cells = first.size() - 1;
  topology_record_ = {};
  topology_record_.nodes = static_cast<std::size_t>(first.back());
  topology_record_.cells = cells;
  topology_record_.uniform = equal_cells(first);
  topology_record_.surfaces = membranes.triangles != nullptr;
  // Of a cell: an outline is closed by its first node.
  const std::size_t per_outline = topology_record_.uniform ? 1 : 3;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    topology_record_.connectivity += topology_record_.surfaces
                                         ? 3 * membranes.triangles(cell_of[cell]).size()
                                         : static_cast<std::size_t>(first[cell + 1] - first[cell]) + per_outline;
  }

  // A new segment repeats the topology that still holds, under its name.
  if (first != first_ || cell_of != cell_ || topologies_ == 0) topology_ = "/topology/" + std::to_string(topologies_++);
  topology_here_ = true;
  open_->make_group(topology_);
  open_->write(topology_ + "/first", first, "1");
  write_of_cells(topology_ + "/cell", first, cell_of);
  if (topology_record_.surfaces) {
    NumberRows rows(*open_, topology_ + "/triangles", {topology_record_.connectivity / 3, 3});
    for (std::size_t cell = 0; cell < cells; ++cell) {
      for (const auto& corners : membranes.triangles(cell_of[cell]))
        for (const int corner : corners) rows.next().push_back(first[cell] + corner);
      rows.write();
    }
    rows.write(true);
  } else {
    NumberRows rows(*open_, topology_ + "/connectivity", {topology_record_.connectivity});
    for (std::size_t cell = 0; cell < cells; ++cell) {
      if (!topology_record_.uniform)
        rows.next().insert(rows.next().end(), {polyline, first[cell + 1] - first[cell] + 1});
      for (int node = first[cell]; node < first[cell + 1]; ++node) rows.next().push_back(node);
      rows.next().push_back(first[cell]);
      rows.write();
    }
    rows.write(true);
  }
  first_ = first;
  cell_ = cell_of;
}

void FrameWriter::write_fields(const std::string& frame, const observe::FieldSnapshot& snapshot, FrameRecord& record) {
  const std::string group = frame + "/fields";
  open_->make_group(group);
  const bool layers = domain_.dimension() == 3, f64 = storage_.precision == scene::Precision::f64;
  std::vector<float> single;
  for (const observe::Field& field : snapshot.fields) {
    std::vector<hsize_t> shape{static_cast<hsize_t>(snapshot.ny), static_cast<hsize_t>(snapshot.nx)};
    if (layers) shape.insert(shape.begin(), static_cast<hsize_t>(snapshot.nz));
    if (field.components > 1) shape.push_back(static_cast<hsize_t>(field.components));
    hdf5::Rows rows = open_->begin(group + "/" + field.name, shape, layers, f64 ? H5T_IEEE_F64LE : H5T_IEEE_F32LE,
                                   f64 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT, field.unit, storage_.compression);
    const std::size_t numbers = static_cast<std::size_t>(snapshot.nx) * static_cast<std::size_t>(field.components);
    field.give([&](const std::vector<double>& values) {
      if (!f64) single.assign(values.begin(), values.end());
      rows.append(f64 ? static_cast<const void*>(values.data()) : single.data(), values.size() / numbers);
    });
    record.fields.push_back(field.name);
  }
}

FieldGrid FrameWriter::field_grid() const {
  FieldGrid grid;
  for (int axis = 0; axis < domain_.dimension(); ++axis) {
    const double spacing = domain_.size[axis] / domain_.nodes[axis];
    grid.nodes.push_back(storage_.count(axis, domain_.nodes[axis]));
    grid.origin.push_back(units::coordinate(storage_.first[axis], spacing));
    grid.spacing.push_back(storage_.stride * spacing);
  }
  grid.bytes = storage_.precision == scene::Precision::f64 ? 8 : 4;
  return grid;
}

std::string FrameWriter::xdmf() const { return xdmf_text(frames_, file_.filename().string(), field_grid(), walls_); }

hdf5::File open_frames(const std::filesystem::path& file) {
  const auto segment = [&](std::size_t number) {
    return std::filesystem::absolute(file).parent_path() / segment_name(number);
  };
  require_own(file);
  if (std::filesystem::exists(file) || !std::filesystem::exists(segment(1)))
    return hdf5::File(file, hdf5::File::Mode::read);
  hdf5::File all(file, hdf5::File::Mode::memory);
  all.make_group("/frames");
  for (std::size_t number = 1; std::filesystem::exists(segment(number)); ++number) {
    try {
      const hdf5::File part(segment(number), hdf5::File::Mode::read);
      if (number == 1) all.copy_attributes(part, "/");
      if (part.has("/walls")) all.link_to(segment(number), "/walls");
      for (const std::string& frame : part.names("/frames")) all.link_to(segment(number), "/frames/" + frame);
    } catch (const Error&) {
      if (number == 1) throw;
      break;  // the last one may be half written
    }
  }
  return all;
}

std::vector<double> FrameReader::size() const {
  std::vector<double> size;
  for (std::size_t axis = 0; axis < periodic().size(); ++axis)
    size.push_back(file_.read_attribute("/", "size_m", axis));
  return size;
}

std::vector<bool> FrameReader::periodic() const {
  std::vector<bool> periodic{!file_.has_attribute("/", "periodic_x"), file_.read_attribute("/", "periodic_y") != 0};
  if (file_.has_attribute("/", "periodic_z")) periodic.push_back(file_.read_attribute("/", "periodic_z") != 0);
  return periodic;
}

long FrameReader::step(int frame) const {
  return static_cast<long>(file_.read_attribute(frame_path(static_cast<std::size_t>(frame)), "step"));
}

std::size_t FrameReader::nodes(int frame) const {
  const std::string group = frame_path(static_cast<std::size_t>(frame)) + "/membranes";
  return file_.has(group) ? file_.shape(group + "/points").front() : 0;
}

std::vector<int> cells_of(const hdf5::File& file, const std::string& group, const std::vector<int>& first) {
  const std::vector<double> of_node = file.read(group + "/cell");
  std::vector<int> cells;
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    const auto node = static_cast<std::size_t>(first[k]);
    const double number = node < of_node.size() ? of_node[node] : -1;
    if (!(number > (cells.empty() ? -1 : cells.back()) && number <= std::numeric_limits<int>::max()))
      refuse_damaged(file, group, "/cell", "/first");
    cells.push_back(static_cast<int>(number));
  }
  return cells;
}

observe::OutlineSnapshot FrameReader::outlines(int frame) const {
  observe::OutlineSnapshot outlines;
  const std::string group = frame_path(static_cast<std::size_t>(frame)) + "/membranes";
  if (!file_.has(group)) return outlines;
  const auto points = file_.read(group + "/points");
  const bool in_space = file_.has(group + "/triangles");
  const std::size_t components = in_space ? 3 : 2, count = points.size() / components;
  const auto nodes = static_cast<double>(count);
  double before = -1;
  for (const double first : file_.read(group + "/first")) {
    const bool begins = before >= 0 || first == 0;
    if (!(begins && first > before && first <= nodes)) refuse_damaged(file_, group, "/first", "/points");
    outlines.first.push_back(static_cast<int>(before = first));
  }
  outlines.cell = cells_of(file_, group, outlines.first);
  for (std::size_t i = 0; i + components <= points.size(); i += components) {
    std::vector<double>* const along[] = {&outlines.x, &outlines.y, &outlines.z};
    for (std::size_t axis = 0; axis < components; ++axis) along[axis]->push_back(points[i + axis]);
  }
  outlines.tension = file_.read(group + "/tension");
  if (outlines.tension.size() != outlines.x.size()) refuse_damaged(file_, group, "/tension", "/points");
  if (!in_space) return outlines;
  const auto corners = file_.read(group + "/triangles");
  for (std::size_t i = 0; i + 3 <= corners.size(); i += 3) {
    std::array<int, 3>& triangle = outlines.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(corners[i + k] >= 0 && corners[i + k] < nodes)) refuse_damaged(file_, group, "/triangles", "/points");
      triangle[k] = static_cast<int>(corners[i + k]);
    }
  }
  return outlines;
}

}  // namespace rouleau::files
