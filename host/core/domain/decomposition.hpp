// How a lattice is cut into blocks, one for each rank.
#pragma once

#include <stdexcept>
#include <vector>

#include "domain.hpp"

namespace rouleau::core {

/// Boxes that fill the lattice, each node once.
template <int D>
class Decomposition {
 public:
  /// Throws std::invalid_argument if the blocks leave out a node or overlap, or if one is empty.
  Decomposition(const Domain<D>& whole, std::vector<Box<D>> blocks) : whole_(whole), blocks_(std::move(blocks)) {
    long nodes = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      long volume = 1;
      for (int k = 0; k < D; ++k) {
        const bool inside = blocks_[i].begin[k] >= 0 && blocks_[i].end[k] <= whole.size[k];
        if (!inside || blocks_[i].size(k) < 1) throw std::invalid_argument("a block is empty or leaves the lattice");
        volume *= blocks_[i].size(k);
      }
      nodes += volume;
      for (std::size_t j = 0; j < i; ++j) {
        if (overlap(blocks_[i], blocks_[j])) throw std::invalid_argument("two blocks overlap");
      }
    }
    if (nodes != whole.nodes()) throw std::invalid_argument("the blocks do not fill the lattice");
  }

  /// parts[k] slices along every axis k, as even as whole nodes allow; ranks count along the first axis first.
  static Decomposition even(const Domain<D>& whole, const std::array<int, D>& parts) {
    std::vector<Box<D>> blocks{{{}, whole.size}};
    for (int k = 0; k < D; ++k) {
      std::vector<Box<D>> sliced;
      for (int i = 0; i < parts[k]; ++i) {
        for (Box<D> block : blocks) {
          block.begin[k] = static_cast<int>(static_cast<long>(whole.size[k]) * i / parts[k]);
          block.end[k] = static_cast<int>(static_cast<long>(whole.size[k]) * (i + 1) / parts[k]);
          sliced.push_back(block);
        }
      }
      blocks = std::move(sliced);
    }
    return {whole, std::move(blocks)};
  }

  [[nodiscard]] int ranks() const { return static_cast<int>(blocks_.size()); }
  /// The lattice with the block of a rank.
  [[nodiscard]] Domain<D> domain(int rank) const { return {whole_.size, whole_.periodic, blocks_[rank]}; }
  /// The rank that computes a node of the lattice.
  [[nodiscard]] int owner(const std::array<int, D>& node) const {
    int rank = 0;
    while (!blocks_[rank].contains(node)) ++rank;
    return rank;
  }

 private:
  static bool overlap(const Box<D>& a, const Box<D>& b) {
    for (int k = 0; k < D; ++k) {
      if (a.end[k] <= b.begin[k] || b.end[k] <= a.begin[k]) return false;
    }
    return true;
  }
  Domain<D> whole_;
  std::vector<Box<D>> blocks_;
};

}  // namespace rouleau::core
