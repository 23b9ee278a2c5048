// How the nodes of a cell are joined to a membrane.
#pragma once

namespace rouleau::core {

/// In two dimensions: a closed polygon, counter-clockwise. Segment i joins node i and the next node, so that nodes and
/// segments share their numbers. How the nodes of a surface are joined is a matter of its type (Mesh).
struct Segments {
  int first;  ///< node
  int count;  ///< of nodes and of segments

  [[nodiscard]] int end() const { return first + count; }
  /// The node after / before node i along the outline.
  [[nodiscard]] int next(int i) const { return i + 1 == end() ? first : i + 1; }
  [[nodiscard]] int previous(int i) const { return i == first ? end() - 1 : i - 1; }
};

}  // namespace rouleau::core
