// Walls of any shape: which nodes of the lattice are solid.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/domain/domain.hpp"

namespace rouleau::core {

/// A mark for every node of the whole lattice. Between a fluid node and a solid one lies a wall at rest, half way.
template <int D>
class SolidNodes {
 public:
  using Node = std::array<int, D>;
  SolidNodes(const Node& size, const std::function<bool(const Node&)>& is_solid) : size_(size) {
    const Box<D> all{{}, size};
    solid_.reserve(static_cast<std::size_t>(row_count(all)) * size[0]);
    for (int i = 0; i < row_count(all); ++i) {
      const std::array<int, D - 1> row = row_of(all, i);
      Node node;
      std::copy(row.begin(), row.end(), node.begin() + 1);
      for (node[0] = 0; node[0] < size[0]; ++node[0]) solid_.push_back(is_solid(node));
    }
    fluid_count_ = std::count(solid_.begin(), solid_.end(), false);
  }

  [[nodiscard]] const Node& size() const { return size_; }
  /// Of a node of the lattice.
  [[nodiscard]] bool at(const Node& node) const {
    std::size_t place = 0;
    for (int k = D - 1; k >= 0; --k)
      place = place * static_cast<std::size_t>(size_[k]) + static_cast<std::size_t>(node[k]);
    return solid_[place];
  }
  /// The same of periodic images, too; what lies beyond the walls of the domain is none.
  [[nodiscard]] bool at(const Domain<D>& domain, Node node) const {
    for (int k = 0; k < D; ++k) {
      node[k] = domain.wrapped(k, node[k]);
      if (node[k] < 0) return false;
    }
    return at(node);
  }
  [[nodiscard]] long fluid_count() const { return fluid_count_; }

 private:
  Node size_;
  std::vector<bool> solid_;
  long fluid_count_ = 0;
};

/// A tube along x through the middle of the lattice; its radius in spacings.
inline SolidNodes<3> tube_nodes(const std::array<int, 3>& size, double radius) {
  return {size, [&](const std::array<int, 3>& node) {
            double square = 0;
            for (int k = 1; k < 3; ++k) square += (node[k] - (size[k] - 1) / 2.0) * (node[k] - (size[k] - 1) / 2.0);
            return square >= radius * radius;
          }};
}

}  // namespace rouleau::core
