// How a lattice is cut into blocks, one for each rank.
#pragma once

#include <algorithm>
#include <cmath>
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
    }
    make_index();
    for (const Box<D>& block : blocks_) {
      if (meeting(block).size() > 1) throw std::invalid_argument("two blocks overlap");
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

  /// In each block of an earlier cut all costs so many times as much; without one, once.
  struct Measured {
    const Decomposition* blocks = nullptr;
    std::vector<double> factor = {};
  };
  /// Some of the nodes that are not solid, all over the lattice; each stands for so many. None: all nodes are fluid.
  struct Fluid {
    std::vector<std::array<int, D>> nodes = {};
    double each = 0;
  };
  /// As many blocks as wanted, by cutting what is left again and again, where the border costs least, so that both
  /// parts cost what the numbers of their blocks ask for: a fluid node 1, each point `point_cost` more. Along the
  /// first axis cuts lie at multiples of 16 nodes where there is room for that. Throws std::invalid_argument for more
  /// blocks than blocks of 16 nodes have room.
  static Decomposition bisected(const Domain<D>& whole, int ranks, const std::vector<std::array<int, D>>& points = {},
                                double point_cost = 0, const Measured& measured = {}, const Fluid& fluid = {}) {
    if (ranks < 1 || whole.nodes() / least_nodes < ranks)
      throw std::invalid_argument("more blocks than there is room for");
    std::vector<Box<D>> blocks;
    bisect({{}, whole.size}, ranks, points, point_cost, measured, fluid, blocks);
    return {whole, std::move(blocks)};
  }
  static constexpr long least_nodes = 16;  ///< of a block, by bisection

  [[nodiscard]] int ranks() const { return static_cast<int>(blocks_.size()); }
  /// The lattice with the block of a rank.
  [[nodiscard]] Domain<D> domain(int rank) const { return whole_.with(blocks_[rank]); }
  /// The rank that computes a node of the lattice.
  [[nodiscard]] int owner(const std::array<int, D>& node) const {
    const std::vector<int>& near = index_[square_of(node)];
    return *std::find_if(near.begin(), near.end(), [&](int rank) { return blocks_[rank].contains(node); });
  }
  /// The ranks, in their order, whose blocks have nodes in a box; the box may reach out of the lattice.
  [[nodiscard]] std::vector<int> meeting(const Box<D>& box) const {
    std::vector<int> ranks;
    for_squares(box, [&](int square) {
      for (const int rank : index_[square]) {
        if (blocks_[rank].meets(box)) ranks.push_back(rank);
      }
    });
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
    return ranks;
  }

 private:
  /// Squares of about a block's size, and the ranks whose blocks meet each.
  void make_index() {
    const double share = static_cast<double>(whole_.nodes()) / static_cast<double>(blocks_.size());
    side_ = std::max(1, static_cast<int>(std::pow(share, 1.0 / D)));
    std::size_t count = 1;
    for (int k = 0; k < D; ++k) count *= static_cast<std::size_t>(squares(k));
    index_.resize(count);
    for (int rank = 0; rank < ranks(); ++rank) {
      for_squares(blocks_[rank], [&](int square) { index_[square].push_back(rank); });
    }
  }
  [[nodiscard]] int squares(int axis) const { return (whole_.size[axis] + side_ - 1) / side_; }
  [[nodiscard]] int square_of(const std::array<int, D>& node) const {
    int square = 0;
    for (int k = D - 1; k >= 0; --k) square = square * squares(k) + node[k] / side_;
    return square;
  }
  /// Calls function(square) for those that a box meets.
  template <class Function>
  void for_squares(const Box<D>& box, Function function) const {
    std::array<int, D> first, last;  // nodes of the lattice
    for (int k = 0; k < D; ++k) {
      first[k] = std::max(box.begin[k], 0) / side_ * side_;
      last[k] = std::min(box.end[k], whole_.size[k]) - 1;
      if (box.begin[k] >= box.end[k] || first[k] > last[k]) return;
    }
    for (std::array<int, D> node = first;;) {
      function(square_of(node));
      int k = 0;
      for (; k < D && (node[k] += side_) > last[k]; ++k) node[k] = first[k];
      if (k == D) return;
    }
  }
  static long volume(const Box<D>& box) {
    long product = 1;
    for (int k = 0; k < D; ++k) product *= box.size(k);
    return product;
  }
  /// Slices of a box across an axis: what they cost, and how many points they have.
  struct Slices {
    std::vector<double> cost;
    std::vector<long> points;
  };
  static Slices slices_of(const Box<D>& box, int axis, const std::vector<std::array<int, D>>& points, double point_cost,
                          const Measured& measured, const Fluid& fluid) {
    const auto size = static_cast<std::size_t>(box.size(axis));
    Slices slices{std::vector<double>(size), std::vector<long>(size)};
    const auto add = [&](const Box<D>& part, double factor) {
      const double slice = static_cast<double>(volume(part)) / part.size(axis) * factor;
      for (int i = part.begin[axis]; i < part.end[axis]; ++i) slices.cost[i - box.begin[axis]] += slice;
    };
    const auto factor_at = [&](const std::array<int, D>& node) {
      return measured.blocks == nullptr ? 1 : measured.factor[measured.blocks->owner(node)];
    };
    if (!fluid.nodes.empty()) {
      for (const auto& node : fluid.nodes)
        if (box.contains(node)) slices.cost[node[axis] - box.begin[axis]] += fluid.each * factor_at(node);
    } else if (measured.blocks == nullptr) {
      add(box, 1);
    } else {
      for (const int rank : measured.blocks->meeting(box))
        add(box.common(measured.blocks->blocks_[rank]), measured.factor[rank]);
    }
    for (const auto& point : points) {
      const int i = point[axis] - box.begin[axis];
      slices.cost[i] += point_cost * factor_at(point);
      ++slices.points[i];
    }
    return slices;
  }
  /// What a cut costs both sides, as a step of so many nodes does: numbers beside each other in memory are sent at
  /// little cost, those of a border across rows lie alone, and more so where blocks are larger than a cache (measured:
  /// docs/results/scaling-2026-11.md); and points near it are known twice.
  static double border_cost(const Box<D>& box, int axis, int at, const std::vector<long>& points, double point_cost,
                            int parts) {
    constexpr int near = 15;          // spacings: half a cell, and what it reaches
    constexpr double in_cache = 1e5;  // nodes of a block
    const double nodes = static_cast<double>(volume(box)), alone = nodes / parts < in_cache ? 30 : 100, beside = 10;
    long known = 0;
    for (int i = std::max(at - near + 1, 0); i < std::min(at + near, box.size(axis)); ++i) known += points[i];
    return nodes / box.size(axis) * (axis == 0 ? alone : beside) + static_cast<double>(known) * point_cost;
  }
  struct Place {
    int at;            ///< slices from the box's beginning
    double off_share;  ///< by how much the cost below misses what is wanted there
  };
  /// Where a cut across an axis lies. Each part has room for its blocks where whole slices allow; and the cut a round
  /// place, where there is one.
  static Place place_of_cut(const Box<D>& box, int axis, int lower_parts, int upper_parts,
                            const std::vector<double>& cost) {
    const int size = box.size(axis), parts = lower_parts + upper_parts;
    double all = 0;
    for (const double c : cost) all += c;
    const double wanted = all * lower_parts / parts, slice = static_cast<double>(volume(box)) / size;
    const auto slices = [&](int blocks_of) { return static_cast<int>(std::ceil(blocks_of * least_nodes / slice)); };
    const int first = slices(lower_parts), last = size - slices(upper_parts);
    Place place{static_cast<int>(std::lround(static_cast<double>(size) * lower_parts / parts)), INFINITY};
    for (const int grain : {axis == 0 ? 16 : 1, 1}) {
      double below = 0;
      for (int i = 1; i <= last; ++i) {
        below += cost[i - 1];
        if (i < first || (box.begin[axis] + i) % grain != 0) continue;
        if (std::abs(below - wanted) < place.off_share) place = {i, std::abs(below - wanted)};
      }
      if (std::isfinite(place.off_share)) break;
    }
    return place;
  }
  static void bisect(const Box<D>& box, int parts, std::vector<std::array<int, D>> points, double point_cost,
                     const Measured& measured, const Fluid& fluid, std::vector<Box<D>>& blocks) {
    if (parts == 1) {
      blocks.push_back(box);
      return;
    }
    const int lower_parts = parts / 2, upper_parts = parts - lower_parts;
    int axis = 0, at = 0;
    double least = INFINITY;
    for (int k = 0; k < D; ++k) {
      if (box.size(k) < 2) continue;
      const Slices slices = slices_of(box, k, points, point_cost, measured, fluid);
      const Place place = place_of_cut(box, k, lower_parts, upper_parts, slices.cost);
      const double cost = place.off_share + border_cost(box, k, place.at, slices.points, point_cost, parts);
      if (at == 0 || cost <= least) least = cost, axis = k, at = place.at;
    }
    Box<D> lower = box, upper = box;
    lower.end[axis] = upper.begin[axis] = box.begin[axis] + at;
    std::vector<std::array<int, D>> below, above;
    for (const auto& point : points) (lower.contains(point) ? below : above).push_back(point);
    bisect(lower, lower_parts, std::move(below), point_cost, measured, fluid, blocks);
    bisect(upper, upper_parts, std::move(above), point_cost, measured, fluid, blocks);
  }
  Domain<D> whole_;
  std::vector<Box<D>> blocks_;
  int side_ = 1;  ///< of the squares of the index, nodes
  std::vector<std::vector<int>> index_;
};

}  // namespace rouleau::core
