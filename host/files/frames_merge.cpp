// frames.h5 made of segments, and a run's frames taken up again.
#include <unistd.h>

#include <algorithm>
#include <map>

#include "checksum.hpp"
#include "file.hpp"
#include "frames.hpp"

namespace rouleau::files {

namespace {

/// The topology groups of a file, by where their /first lies, which the frames' links lead to.
std::map<haddr_t, std::string> topologies_of(const Hdf5File& file) {
  std::map<haddr_t, std::string> found;
  for (const auto& name : file.names("/topology"))
    found[file.address("/topology/" + name + "/first")] = "/topology/" + name;
  return found;
}

/// What of a frame's membranes is linked from the topology.
constexpr std::array<const char*, 3> shared_names{"first", "cell", "connectivity"};

bool is_shared(const std::string& name) {
  return std::find(shared_names.begin(), shared_names.end(), name) != shared_names.end();
}

}  // namespace

FrameWriter::FrameWriter(std::filesystem::path file, const scene::Scene& scene, const FramesSaved& saved)
    : FrameWriter(std::move(file), scene) {
  saved_ = saved;
  found_ = find_frames(file_, saved);
  remove_segments(file_, found_.merged + 1, saved.segments.size());
  std::size_t merged_frames = 0;
  for (std::size_t i = 0; i < found_.merged; ++i) merged_frames += saved.segments[i].frames;
  if (merged_frames > 0) read_back(file_, merged_frames);
  for (std::size_t i = found_.merged; i < saved.segments.size(); ++i)
    read_back(segment(i + 1), saved.segments[i].frames);
}

void FrameWriter::read_back(const std::filesystem::path& source, std::size_t frames) {
  const Hdf5File file(source, Hdf5File::Mode::read);
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
        topology_record_ = {};
        topology_record_.nodes = static_cast<std::size_t>(first_.back());
        topology_record_.cells = first_.size() - 1;
        topology_record_.uniform = equal_cells(first_);
        topology_record_.connectivity = file.elements(topology + "/connectivity");
      }
      record.nodes = topology_record_.nodes;
      record.cells = topology_record_.cells;
      record.connectivity = topology_record_.connectivity;
      record.uniform = topology_record_.uniform;
    }
    if (file.has(frame + "/fields"))
      for (const char* field : field_names)
        if (file.has(frame + "/fields/" + field)) record.fields.emplace_back(field);
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
  const std::size_t segments = saved_.segments.size();
  if (found_.merged == 0 && segments == 1) {
    move_into_place(segment(1), file_);
  } else if (segments == 0 || segments > found_.merged || found_.more) {
    merge();
  }
  remove_segments(file_, 1, 0);
}

void FrameWriter::merge() const {
  const auto partial =
      file_.parent_path() / ("." + file_.filename().string() + "." + std::to_string(::getpid()) + ".partial");
  try {
    Hdf5File target(partial, Hdf5File::Mode::create);
    write_header(target);
    std::size_t frame = 0;
    for (std::size_t i = 0; i < found_.merged; ++i) frame += saved_.segments[i].frames;
    if (frame > 0) copy_frames(file_, 0, frame, target);
    for (std::size_t i = found_.merged; i < saved_.segments.size(); frame += saved_.segments[i++].frames)
      copy_frames(segment(i + 1), frame, saved_.segments[i].frames, target);
    target.close();
    if (!saved_.segments.empty()) append_checksums(partial, saved_.segments);
    synchronise(partial);
    move_into_place(partial, file_);
  } catch (...) {
    ::unlink(partial.c_str());  // the segments are still there
    throw;
  }
}

void FrameWriter::copy_frames(const std::filesystem::path& source, std::size_t first, std::size_t count,
                              Hdf5File& target) const {
  const Hdf5File file(source, Hdf5File::Mode::read);
  const auto topologies = topologies_of(file);
  for (std::size_t i = first; i < first + count; ++i) {
    const std::string frame = frame_path(i), membranes = frame + "/membranes";
    target.make_group(frame);
    target.copy_attributes(file, frame);
    if (file.has(membranes)) {
      target.make_group(membranes);
      target.copy_attributes(file, membranes);
      for (const auto& name : file.names(membranes))
        if (!is_shared(name)) target.copy(file, membranes + "/" + name);
      const std::string& topology = topologies.at(file.address(membranes + "/first"));
      if (!target.has(topology)) target.copy(file, topology);
      for (const auto* name : shared_names) target.link(topology + "/" + name, membranes + "/" + name);
    }
    if (file.has(frame + "/fields")) target.copy(file, frame + "/fields");
  }
}

}  // namespace rouleau::files
