// The box of lattice nodes that a simulation fills, and the block of it that is computed here.
#pragma once

#include <array>

namespace rouleau::core {

/// Nodes [begin[k], end[k]) along every axis k.
template <int D>
struct Box {
  std::array<int, D> begin{}, end{};

  [[nodiscard]] int size(int axis) const { return end[axis] - begin[axis]; }
  [[nodiscard]] bool contains(const std::array<int, D>& node) const {
    for (int k = 0; k < D; ++k) {
      if (node[k] < begin[k] || node[k] >= end[k]) return false;
    }
    return true;
  }
  /// Whether all nodes of another box lie in this one.
  [[nodiscard]] bool holds(const Box& other) const {
    for (int k = 0; k < D; ++k) {
      if (other.begin[k] < begin[k] || other.end[k] > end[k]) return false;
    }
    return true;
  }
  /// Whether a node lies in both.
  [[nodiscard]] bool meets(const Box& other) const {
    for (int k = 0; k < D; ++k) {
      if (end[k] <= other.begin[k] || other.end[k] <= begin[k]) return false;
    }
    return true;
  }
  /// The nodes that lie in both; where there are none, a box that ends before it begins.
  [[nodiscard]] Box common(const Box& other) const {
    Box both;
    for (int k = 0; k < D; ++k) {
      both.begin[k] = begin[k] > other.begin[k] ? begin[k] : other.begin[k];
      both.end[k] = end[k] < other.end[k] ? end[k] : other.end[k];
    }
    return both;
  }
  friend bool operator==(const Box&, const Box&) = default;
};

/// Rows of a box lie along its first axis. How many there are, and where row i of them is along the other axes.
template <int D>
int row_count(const Box<D>& box) {
  int rows = 1;
  for (int k = 1; k < D; ++k) rows *= box.size(k);
  return rows;
}
template <int D>
std::array<int, D - 1> row_of(const Box<D>& box, int i) {
  std::array<int, D - 1> row{};
  for (int k = 1; k + 1 < D; ++k) {
    row[k - 1] = i % box.size(k);
    i /= box.size(k);
  }
  row[D - 2] = i;
  return row;
}

/// Node i along an axis lies at coordinate i, in spacings. Along a periodic axis node i + size is an image of node i;
/// along any other there are walls, or along one axis openings, half a spacing outside the first and the last node, at
/// -1/2 and size - 1/2.
template <int D>
struct Domain {
  std::array<int, D> size{};       ///< nodes of the whole lattice
  std::array<bool, D> periodic{};  ///< of each axis
  Box<D> block{};                  ///< the nodes that are computed here
  int open_axis = -1;              ///< that has openings at its ends, and is not periodic; -1: none has

  Domain() = default;
  /// One block holds the whole lattice. There are no walls across x: where it is not periodic, it is open.
  Domain(const std::array<int, D>& nodes, const std::array<bool, D>& is_periodic)
      : Domain(nodes, is_periodic, {{}, nodes}) {}
  Domain(const std::array<int, D>& nodes, const std::array<bool, D>& is_periodic, const Box<D>& mine)
      : size(nodes), periodic(is_periodic), block(mine), open_axis(is_periodic[0] ? -1 : 0) {}
  /// The same lattice with another block, or all of it in one.
  [[nodiscard]] Domain with(const Box<D>& other) const {
    Domain same = *this;
    same.block = other;
    return same;
  }
  [[nodiscard]] Domain in_one_block() const { return with({{}, size}); }

  /// After how many spacings everything comes again along an axis; 0: never.
  [[nodiscard]] double period(int axis) const { return periodic[axis] ? size[axis] : 0.0; }
  /// Whether there are walls across an axis.
  [[nodiscard]] bool walled(int axis) const { return !periodic[axis] && axis != open_axis; }
  /// That a flow from end to end goes along: the open one, else x.
  [[nodiscard]] int flow_axis() const { return open_axis < 0 ? 0 : open_axis; }
  /// The node in [0, size) that node i is an image of; -1: it lies beyond a wall.
  [[nodiscard]] int wrapped(int axis, int i) const {
    const int n = size[axis];
    if (i >= 0 && i < n) return i;
    if (!periodic[axis]) return -1;
    const int rest = i % n;
    return rest < 0 ? rest + n : rest;
  }
  /// Whether one block holds the whole lattice.
  [[nodiscard]] bool whole() const { return block == Box<D>{{}, size}; }
  /// Whether the block is its own neighbour across both ends of an axis.
  [[nodiscard]] bool wraps(int axis) const { return periodic[axis] && block.size(axis) == size[axis]; }
  /// Whether a wall, or an opening, bounds the block at the lower or the upper end of an axis.
  [[nodiscard]] bool wall_below(int axis) const { return !periodic[axis] && block.begin[axis] == 0; }
  [[nodiscard]] bool wall_above(int axis) const { return !periodic[axis] && block.end[axis] == size[axis]; }
  /// Number of nodes of the whole lattice.
  [[nodiscard]] long nodes() const {
    long product = 1;
    for (const int n : size) product *= n;
    return product;
  }
};

}  // namespace rouleau::core
