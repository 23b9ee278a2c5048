// The triangles of a mesh as loops over whole packs want them.
#pragma once

#include <array>
#include <vector>

#include "mesh.hpp"

namespace rouleau::core {

/// So many that whole packs hold at least `count` numbers, whatever the instruction set.
constexpr int padded(int count) {
  constexpr int pack_size = 8;  // doubles in the widest pack
  return (count + pack_size - 1) / pack_size * pack_size;
}

/// Numbers of triangles, and of their corners: those of corner k follow each other from k * size on. The last triangle
/// stands for those that fill the last pack.
struct PaddedTriangles {
  explicit PaddedTriangles(const Mesh& mesh);

  int count, size;             ///< of triangles, without and with those that fill the last pack
  std::vector<int> corner[3];  ///< nodes
  Mesh::Rings corners;         ///< around each node: corner k of triangle t is entry k * size + t
  std::vector<int> triangle;   ///< of each entry of corners

  /// Sums over all corners around a node, in their order.
  template <std::size_t n>
  [[nodiscard]] std::array<double, n> sums_of_corners(const std::array<const double*, n>& values, int node) const {
    return sums(values, corners.entry, node);
  }
  /// The same of what the triangles around a node have.
  template <std::size_t n>
  [[nodiscard]] std::array<double, n> sums_of_triangles(const std::array<const double*, n>& values, int node) const {
    return sums(values, triangle, node);
  }

 private:
  template <std::size_t n>
  [[nodiscard]] std::array<double, n> sums(const std::array<const double*, n>& values, const std::vector<int>& entry,
                                           int node) const {
    std::array<double, n> all{};
    for (int c = corners.first[node]; c < corners.first[node + 1]; ++c) {
      for (std::size_t k = 0; k < n; ++k) all[k] += values[k][entry[c]];
    }
    return all;
  }
};

}  // namespace rouleau::core
