#include "output/frames.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

namespace rouleau::host {

std::string frame_path(std::size_t frame) {
  std::string digits = std::to_string(frame);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return "/frames/" + digits;
}

FrameWriter::FrameWriter(const std::filesystem::path& file, const Scene& scene)
    : file_(file, Hdf5File::Mode::create),
      file_name_(file.filename().string()),
      title_(scene.title),
      size_{scene.domain.size.x(), scene.domain.size.y()},
      nodes_(scene.domain.nodes) {
  file_.attribute("/", "format", "rouleau frames 1");
  file_.attribute("/", "title", title_);
  file_.attribute("/", "size_m", std::vector<double>{size_[0], size_[1]});
  file_.attribute("/", "nodes", std::vector<double>{double(nodes_[0]), double(nodes_[1])});
  file_.attribute("/", "periodic_y", scene.domain.periodic_y ? 1L : 0L);
  file_.make_group("/frames");
  file_.make_group("/topology");
  file_.flush();
}

void FrameWriter::write(const Snapshot& snapshot) {
  const std::string frame = frame_path(frames_.size());
  file_.make_group(frame);
  file_.attribute(frame, "step", snapshot.step);
  file_.attribute(frame, "time_s", snapshot.time);
  file_.attribute(frame, "strain", snapshot.strain);
  file_.attribute(frame, "stage", static_cast<long>(snapshot.stage));
  file_.attribute(frame, "stage_name", snapshot.stage_name);
  FrameRecord record;
  record.time = snapshot.time;
  if (!snapshot.outlines.x.empty()) write_membranes(frame, snapshot, record);
  if (!snapshot.fields.empty()) write_fields(frame, snapshot.fields, record);
  file_.flush();
  frames_.push_back(std::move(record));
}

void FrameWriter::write_membranes(const std::string& frame, const Snapshot& snapshot, FrameRecord& record) {
  const auto& outlines = snapshot.outlines;
  if (topology_.empty() || outlines.first != first_) write_topology(outlines.first);
  record.nodes = topology_record_.nodes;
  record.cells = topology_record_.cells;
  record.connectivity = topology_record_.connectivity;
  record.uniform = topology_record_.uniform;

  const std::string group = frame + "/membranes";
  file_.make_group(group);
  std::vector<double> points(2 * outlines.x.size());
  for (std::size_t i = 0; i < outlines.x.size(); ++i) {
    points[2 * i] = outlines.x[i];
    points[2 * i + 1] = outlines.y[i];
  }
  file_.write(group + "/points", {outlines.x.size(), 2}, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, points.data(), "m");
  // frames.xmf promises every attribute at every frame, so that ParaView can colour the whole animation.
  auto tension = outlines.tension;
  tension.resize(outlines.x.size(), 0.0);
  file_.write(group + "/tension", tension, "N/m");

  std::map<int, int> label;
  for (const auto& cell : snapshot.cells) label[cell.cell] = cell.aggregate;
  std::vector<int> aggregate(outlines.x.size());
  for (std::size_t cell = 0; cell < record.cells; ++cell) {
    const auto known = label.find(static_cast<int>(cell));
    std::fill(aggregate.begin() + outlines.first[cell], aggregate.begin() + outlines.first[cell + 1],
              known == label.end() ? static_cast<int>(cell) : known->second);
  }
  file_.write(group + "/aggregate", aggregate, "1");
  for (const char* shared : {"/first", "/cell", "/connectivity"}) file_.link(topology_ + shared, group + shared);
}

void FrameWriter::write_topology(const std::vector<int>& first) {
  constexpr int polyline = 2;  // XDMF's code in a mixed topology, followed by the number of nodes
  const std::size_t cells = first.size() - 1;
  topology_record_ = {};
  topology_record_.nodes = static_cast<std::size_t>(first.back());
  topology_record_.cells = cells;
  topology_record_.uniform = true;
  for (std::size_t cell = 0; cell < cells; ++cell)
    topology_record_.uniform = topology_record_.uniform && first[cell + 1] - first[cell] == first[1] - first[0];

  std::vector<int> owner, connectivity;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (!topology_record_.uniform)
      connectivity.insert(connectivity.end(), {polyline, first[cell + 1] - first[cell] + 1});
    for (int node = first[cell]; node < first[cell + 1]; ++node) {
      owner.push_back(static_cast<int>(cell));
      connectivity.push_back(node);
    }
    connectivity.push_back(first[cell]);  // closes the outline
  }
  topology_record_.connectivity = connectivity.size();

  topology_ = "/topology/" + std::to_string(topologies_++);
  file_.make_group(topology_);
  file_.write(topology_ + "/first", first, "1");
  file_.write(topology_ + "/cell", owner, "1");
  file_.write(topology_ + "/connectivity", connectivity, "1");
  first_ = first;
}

void FrameWriter::write_fields(const std::string& frame, const FieldSnapshot& fields, FrameRecord& record) {
  const std::string group = frame + "/fields";
  file_.make_group(group);
  const auto nx = static_cast<hsize_t>(fields.nx), ny = static_cast<hsize_t>(fields.ny);
  if (!fields.velocity_x.empty()) {
    std::vector<float> velocity(3 * nx * ny, 0.0f);
    for (std::size_t i = 0; i < nx * ny; ++i) {
      velocity[3 * i] = fields.velocity_x[i];
      velocity[3 * i + 1] = fields.velocity_y[i];
    }
    file_.write(group + "/velocity", {ny, nx, 3}, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, velocity.data(), "m/s", true);
    record.fields.emplace_back("velocity");
  }
  const auto scalar = [&](const char* name, const std::vector<float>& values, const char* unit) {
    if (values.empty()) return;
    file_.write(group + "/" + name, {ny, nx}, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, values.data(), unit, true);
    record.fields.emplace_back(name);
  };
  scalar("density", fields.density, "1");
  scalar("viscosity", fields.viscosity, "Pa s");
  scalar("vorticity", fields.vorticity, "1/s");
}

std::string FrameWriter::xdmf() const { return xdmf_text(frames_, file_name_, size_, nodes_); }

std::array<double, 2> FrameReader::size() const {
  return {file_.read_attribute("/", "size_m", 0), file_.read_attribute("/", "size_m", 1)};
}

long FrameReader::step(int frame) const {
  return static_cast<long>(file_.read_attribute(frame_path(static_cast<std::size_t>(frame)), "step"));
}

OutlineSnapshot FrameReader::outlines(int frame) const {
  OutlineSnapshot outlines;
  const std::string group = frame_path(static_cast<std::size_t>(frame)) + "/membranes";
  if (!file_.has(group)) return outlines;
  for (const double first : file_.read(group + "/first")) outlines.first.push_back(static_cast<int>(first));
  const auto points = file_.read(group + "/points");
  for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
    outlines.x.push_back(points[i]);
    outlines.y.push_back(points[i + 1]);
  }
  outlines.tension = file_.read(group + "/tension");
  return outlines;
}

}  // namespace rouleau::host
