// Reads what a checkpoint has of cells.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/domain/bounding_box.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "files/checkpoint_file.hpp"
#include "plan/plan.hpp"
#include "run_state.hpp"

namespace rouleau::run {

/// Where nodes are, along each axis.
inline constexpr std::array places{"/membranes/x", "/membranes/y", "/membranes/z"};

inline void read(const files::CheckpointReader& reader, const std::string& path, std::vector<double>& values) {
  reader.array(path, values.size(), values.data());
}
/// Of these parts of an array of so many nodes.
template <class Values>
void read(const files::CheckpointReader& reader, const std::string& path, std::size_t nodes,
          const std::vector<Range>& parts, Values& values) {
  for (const Range& part : parts) {
    const auto begin = static_cast<std::size_t>(part.begin), end = static_cast<std::size_t>(part.end);
    reader.part(path, nodes, begin, end, values.data() + begin);
  }
}

/// What a checkpoint has arrays of: the cells but for those at the end that have not come in yet. A run that goes on
/// may have room for more or fewer of these.
struct Kept {
  std::size_t cells, nodes;
  Kept(const plan::Plan& plan, const RunState& state, const core::CellNodes& of)
      : cells(observe::has_traffic(*plan.scene)
                  ? plan.scene->placed().size() + static_cast<std::size_t>(state.traffic.cells.in())
                  : of.cells.size()),
        nodes(cells < of.cells.size() ? static_cast<std::size_t>(of.cells[cells].first) : of.position[0].size()) {}
};

/// The boxes of these cells, whose nodes are not in memory all at once; unknown ones of all others.
template <int D>
std::vector<core::BoundingBox<D>> read_boxes(const files::CheckpointReader& reader, const core::CellNodes& nodes,
                                             const Kept& kept) {
  constexpr int at_once = 1 << 18;
  std::vector<core::BoundingBox<D>> boxes;
  boxes.reserve(nodes.cells.size());
  core::CellNodes some;
  auto& along = some.position;
  for (int c = 0, count = static_cast<int>(kept.cells); c < count;) {
    const int first = nodes.cells[c].first;
    some.cells.clear();
    for (; c < count && (some.cells.empty() || nodes.cells[c].end() - first <= at_once); ++c) {
      some.cells.push_back(nodes.cells[c]);
      some.cells.back().first -= first;
    }
    const auto from = static_cast<std::size_t>(first), size = static_cast<std::size_t>(some.cells.back().end());
    for (int k = 0; k < D; ++k) {
      along[k].resize(size);
      reader.part(places[k], kept.nodes, from, from + size, along[k].data());
    }
    for (const core::BoundingBox<D>& box : core::boxes_of<D>(some)) boxes.push_back(box);
  }
  boxes.resize(nodes.cells.size(), core::BoundingBox<D>::unknown());
  return boxes;
}

/// A number of each of the cells that are kept; none has come yet of the others.
inline void read_of_cells(const files::CheckpointReader& reader, const std::string& path, const Kept& kept,
                          std::vector<double>& values) {
  std::vector<double> of_kept(std::min(kept.cells, values.size()));
  read(reader, path, of_kept);
  std::copy(of_kept.begin(), of_kept.end(), values.begin());
}

}  // namespace rouleau::run
