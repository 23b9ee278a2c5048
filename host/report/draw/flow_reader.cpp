#include "flow_reader.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "files/frames.hpp"

namespace rouleau::report {

namespace {

constexpr std::size_t most_blocks = 8192;

std::string velocity_of(std::size_t output) { return files::frame_path(output) + "/fields/velocity"; }

}  // namespace

FlowReader::FlowReader(const std::filesystem::path& frames) : file_(files::open_frames(frames)) {
  const auto count = static_cast<std::size_t>(file_.members("/frames"));
  for (std::size_t output = 0; output < count; ++output)
    if (file_.has(velocity_of(output))) outputs_.push_back(output);
}

const BlockVelocity* FlowReader::at(std::size_t output) {
  const auto after = std::upper_bound(outputs_.begin(), outputs_.end(), output);
  if (after == outputs_.begin()) return nullptr;
  const std::size_t wanted = *(after - 1);
  if (!velocity_.u.values.empty() && read_ == wanted) return &velocity_;
  const std::string dataset = velocity_of(wanted);
  const auto shape = file_.shape(dataset);
  const auto values = file_.read(dataset);
  const std::size_t ny = shape.at(0), nx = shape.at(1);
  const bool part = file_.has_attribute("/", "fields_first_m");
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double length = file_.read_attribute("/", "size_m", axis), nodes = double(axis == 0 ? nx : ny);
    const double spacing = part ? file_.read_attribute("/", "fields_spacing_m", axis) : length / nodes;
    velocity_.first[axis] = part ? file_.read_attribute("/", "fields_first_m", axis) - spacing / 2 : 0;
    velocity_.size[axis] = spacing * nodes;
    if (axis == 0) velocity_.periodic_x = std::abs(velocity_.size[0] - length) < 1e-6 * length;
  }
  velocity_.u = block_means(velocity_component(values, nx, ny, 0), most_blocks);
  velocity_.v = block_means(velocity_component(values, nx, ny, 1), most_blocks);
  read_ = wanted;
  return &velocity_;
}

}  // namespace rouleau::report
