// A run's frames taken up again, sealed, and frames.h5 that leads to them.
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>

#include "file.hpp"
#include "frames.hpp"

namespace rouleau::files {

namespace {

/// The topology groups of a file, by where their /first lies, which the frames' links lead to.
std::map<haddr_t, std::string> topologies_of(const hdf5::File& file) {
  std::map<haddr_t, std::string> found;
  for (const auto& name : file.names("/topology"))
    found[file.address("/topology/" + name + "/first")] = "/topology/" + name;
  return found;
}

}  // namespace

FrameWriter::FrameWriter(std::filesystem::path file, const scene::Scene& scene, const FramesSaved& saved)
    : FrameWriter(std::move(file), scene) {
  saved_ = saved;
  require_segments(file_, saved);
  take_up_segments(file_, saved);
  for (std::size_t i = 0; i < saved.segments.size(); ++i) read_back(segment(i + 1), saved.segments[i].frames);
}

void FrameWriter::read_back(const std::filesystem::path& source, std::size_t frames) {
  const hdf5::File file(source, hdf5::File::Mode::read);
  const auto topologies = topologies_of(file);
  for (const std::size_t end = frames_.size() + frames; frames_.size() < end;) {
    const std::string frame = frame_path(frames_.size());
    FrameRecord record;
    record.time = file.read_attribute(frame, "time_s");
    if (file.has(frame + "/membranes")) {
      const std::string& topology = topologies.at(file.address(frame + "/membranes/first"));
      if (topology != topology_) {
        topology_ = topology;
        topologies_ = std::max(topologies_, std::stoi(topology.substr(topology.rfind('/') + 1)) + 1);
        first_.clear();
        for (const double node : file.read(topology + "/first")) first_.push_back(static_cast<int>(node));
        cell_ = cells_of(file, topology, first_);
        topology_record_ = {};
        topology_record_.nodes = static_cast<std::size_t>(first_.back());
        topology_record_.cells = first_.size() - 1;
        topology_record_.uniform = equal_cells(first_);
        topology_record_.surfaces = file.has(topology + "/triangles");
        topology_record_.connectivity =
            file.elements(topology + (topology_record_.surfaces ? "/triangles" : "/connectivity"));
      }
      static_cast<Topology&>(record) = topology_record_;
    }
    if (file.has(frame + "/fields"))
      for (const char* field : field_names)
        if (file.has(frame + "/fields/" + field)) record.fields.emplace_back(field);
    record.sheared_walls = file.has(frame + "/walls");
    frames_.push_back(std::move(record));
  }
}

const FramesSaved& FrameWriter::seal() {
  if (!open_) return saved_;
  const auto file = segment(saved_.segments.size() + 1);
  open_->close();
  open_.reset();
  synchronise(file);
  synchronise(file_.has_parent_path() ? file_.parent_path() : ".");
  saved_.segments.push_back(
      {frames_.size() - saved_.frames(), std::filesystem::file_size(file), checksum_of(file).value()});
  return saved_;
}

void FrameWriter::close() {
  seal();
  if (saved_.segments.size() == 1)
    move_into_place(segment(1), file_);
  else
    link_segments();
}

std::vector<std::string> FrameWriter::names() const {
  std::vector<std::string> names{file_.filename().string()};
  if (saved_.segments.size() > 1)
    for (std::size_t i = 0; i < saved_.segments.size(); ++i) names.push_back(segment_name(i + 1));
  return names;
}

void FrameWriter::link_segments() const {
  const auto partial =
      file_.parent_path() / ("." + file_.filename().string() + "." + std::to_string(::getpid()) + ".partial");
  try {
    hdf5::File all(partial, hdf5::File::Mode::create);
    write_header(all);
    std::set<std::string> linked;
    for (std::size_t i = 0; i < saved_.segments.size(); ++i) {
      const hdf5::File part(segment(i + 1), hdf5::File::Mode::read);
      if (part.has("/walls")) all.link_to(segment_name(i + 1), "/walls");
      for (const std::string group : {"/frames/", "/topology/"})
        for (const std::string& name : part.names(group))
          if (linked.insert(group + name).second) all.link_to(segment_name(i + 1), group + name);
    }
    all.close();
    synchronise(partial);
    move_into_place(partial, file_);
  } catch (...) {
    ::unlink(partial.c_str());  // the segments are still there
    throw;
  }
}

}  // namespace rouleau::files
