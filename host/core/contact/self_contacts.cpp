#include "self_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "contact_list.hpp"
#include "segment_table.hpp"

namespace rouleau::core {

namespace {

constexpr int block_size = 8;

/// Consecutive segments and a circle that holds them.
struct Block {
  int first, end;
  double x, y, radius;
};

std::vector<Block> blocks_of(int count, const double* x, const double* y) {
  std::vector<Block> blocks;
  for (int first = 0; first < count; first += block_size) {
    const int end = std::min(first + block_size, count), middle = (first + end) / 2;
    Block& block = blocks.emplace_back(Block{first, end, x[middle], y[middle], 0});
    for (int i = first; i <= end; ++i)
      block.radius = std::max(block.radius, std::hypot(x[i < count ? i : 0] - block.x, y[i < count ? i : 0] - block.y));
  }
  return blocks;
}

}  // namespace

SelfContacts::SelfContacts(const Membranes& membranes, const std::vector<double>& cutoffs) {
  for (std::size_t t = 0; t < cutoffs.size(); ++t) {
    Type& type = types_.emplace_back(Type{cutoffs[t], {}});
    const RestShape& rest = *membranes.types[t];
    const int count = static_cast<int>(rest.x.size());
    type.reach.resize(rest.x.size(), {0, 0});
    const double apart = std::numbers::pi / 2 * type.cutoff;
    const double whole = std::accumulate(rest.rest_length.begin(), rest.rest_length.end(), 0.0);
    for (int node = 0; node < count; ++node) {
      // Begins of segments that are far enough ahead, and ends of those that are far enough behind.
      double along = 0;
      int begin = 0, end = 0;
      for (int segment = 0; segment < count; ++segment) {
        if (along < apart) begin = segment + 1;
        along += rest.rest_length[(node + segment) % count];
        if (whole - along >= apart) end = segment + 1;
      }
      if (begin < end) type.reach[node] = {node + begin, node + end};
    }
  }
}

void SelfContacts::append(const CellRange& cell, const Membranes& membranes, ContactList& list) const {
  const Type& type = types_[cell.type];
  const int count = cell.count, before = list.count;
  const double *x = membranes.position[0].data() + cell.first, *y = membranes.position[1].data() + cell.first;
  // Those of all nodes, then those of nodes that are near something.
  double *square = list.distance.data() + before, *along = list.along.data() + before;
  double *away_x = list.direction_x.data() + before, *away_y = list.direction_y.data() + before;
  int* closest = list.segment.data() + before;
  std::fill(square, square + count, type.cutoff * type.cutoff);
  std::fill(closest, closest + count, -1);
  const auto look = [&](int node, int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const int next = j + 1 < count ? j + 1 : 0;
      const double along_x = x[next] - x[j], along_y = y[next] - y[j];
      const double length2 = along_x * along_x + along_y * along_y;
      const Approach<double> approach(x[node] - x[j], y[node] - y[j], along_x, along_y, length2 > 0 ? 1 / length2 : 0);
      if (!(approach.square < square[node])) continue;
      square[node] = approach.square;
      closest[node] = j;
      along[node] = approach.along;
      away_x[node] = approach.x, away_y[node] = approach.y;
    }
  };
  const std::vector<Block> blocks = blocks_of(count, x, y);
  for (const Block& own : blocks) {
    for (const Block& other : blocks) {
      const double reach = own.radius + other.radius + type.cutoff, dx = own.x - other.x, dy = own.y - other.y;
      if (!(dx * dx + dy * dy <= reach * reach)) continue;
      for (int node = own.first; node < own.end; ++node) {
        // Counted from the node on, segments of the block may come before or after the first one of the cell.
        const Reach allowed = type.reach[node];
        for (const int turn : {0, count})
          look(node, std::max(other.first, allowed.begin - turn), std::min(other.end, allowed.end - turn));
      }
    }
  }
  int end = before;
  for (int node = 0; node < count; ++node) {
    if (closest[node] < 0) continue;
    list.node[end] = cell.first + node;
    list.segment[end] = cell.first + closest[node];
    list.along[end] = along[node];
    list.distance[end] = std::max(std::sqrt(square[node]), least_distance);
    list.direction_x[end] = away_x[node];
    list.direction_y[end++] = away_y[node];
  }
  list.within = {before, end};
  list.count = end;
}

}  // namespace rouleau::core
