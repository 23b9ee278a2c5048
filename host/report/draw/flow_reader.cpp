#include "flow_reader.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "files/field_nodes.hpp"
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
  const files::FieldNodes grid(file_, dataset);
  velocity_.first = grid.box().first;
  velocity_.size = grid.box().size;
  velocity_.periodic_x = grid.periodic[0];
  auto [u, v] = mean_vectors(file_, grid, dataset, most_blocks);
  velocity_.u = std::move(u);
  velocity_.v = std::move(v);
  read_ = wanted;
  return &velocity_;
}

}  // namespace rouleau::report
