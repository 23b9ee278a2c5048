// What membranes read and spread beside walls of any shape, with solid nodes in their stencils.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/geometry/region.hpp"
#include "wall_share.hpp"

namespace rouleau::core {

/// A membrane node with the weights w, the force F and solid nodes in its stencil reads u = k sum w(x) u(x) over the
/// fluid's nodes x, and spreads k w(x) F to them. With d the distance from the walls, negative in the solid,
///
///     k = sum over all nodes w d / sum over the fluid's nodes w d,
///
/// as if the velocity in the solid were d times a mean of u/d. So shear along a plane wall at any angle is read exactly
/// where a kernel has no first moment, and any flow to second order; a force F acts on the wall's shear by F times the
/// distance. k is 1 where the solid has no weight and 0 on the wall. Where the sum is negative, beyond a wall and in
/// the tip of a corner that the lattice does not resolve, k is its magnitude and at most 1: a node that got there goes
/// with the fluid and obeys forces. So with weights that are not negative k lies between 0 and 1, and no force grows.
/// Spreading and reading are adjoint, and walls take what does not reach the fluid. Beside walls that move with u_wall
/// it is u - u_wall that is read so.
template <int D>
class WallReach {
 public:
  using Node = std::array<int, D>;
  using Stencil = std::array<StencilAlong, D>;

  /// Of stencils of so many points that touch the domain's block. `time`: as in SolidLinks; the region is used then as
  /// long as this lives.
  WallReach(const Domain<D>& domain, const SolidNodes<D>& solid, const Region<D>& region, int points, double time = 0);

  /// Whether a stencil whose first node is an image of this one touches the block and has solid nodes.
  [[nodiscard]] bool touches(const Node& first) const {
    const std::ptrdiff_t place = place_of(first);
    return place >= 0 && touches_[static_cast<std::size_t>(place)] != 0;
  }
  /// k, if it does.
  [[nodiscard]] double factor(const Stencil& stencil) const;
  /// What is read with this factor beside what the fluid gives: the walls' velocity times what is lacking of it.
  [[nodiscard]] Vec<D> carried(const Stencil& stencil, double factor) const;
  /// What walls take of a force with such a stencil: those across y what is spread beyond them, as without solid nodes
  /// (add_wall_share), all others together the rest.
  void add_share(const std::array<double, D>& force, const Stencil& stencil, WallForceSums<D>& sums) const;

 private:
  /// Of a node around the block; negative: of none whose stencil touches it.
  [[nodiscard]] std::ptrdiff_t place_of(const Node& first) const {
    std::ptrdiff_t place = 0;
    for (int k = D - 1; k >= 0; --k) {
      int from_lower = first[k] - around_.begin[k];
      if (domain_.periodic[k] && from_lower < 0) from_lower += domain_.size[k];
      if (domain_.periodic[k] && from_lower >= domain_.size[k]) from_lower -= domain_.size[k];
      if (from_lower < 0 || from_lower + points_ > around_.size(k)) return -1;
      place = place * around_.size(k) + from_lower;
    }
    return place;
  }
  /// Calls function(row, place, weight) for the rows of a stencil's nodes: `row` is the first of them.
  template <class Function>
  void for_rows(const Stencil& stencil, Function function) const {
    Node first;
    int rows = 1;
    for (int k = 0; k < D; ++k) first[k] = stencil[k].first, rows *= k > 0 ? points_ : 1;
    const std::ptrdiff_t corner = place_of(first);
    for (int i = 0; i < rows; ++i) {
      Node row = first;
      double weight = 1;
      std::ptrdiff_t place = corner, stride = around_.size(0);
      for (int k = 1, rest = i; k < D; rest /= points_, stride *= around_.size(k++)) {
        const int at = rest % points_;
        row[k] += at, place += at * stride;
        weight *= stencil[k].weight[static_cast<std::size_t>(at)];
      }
      function(row, static_cast<std::size_t>(place), weight);
    }
  }
  /// Sums over a stencil of weights times value(place): of all nodes, and of those of the fluid.
  template <class Value>
  [[nodiscard]] std::pair<double, double> sums(const Stencil& stencil, Value value) const {
    double all = 0, of_fluid = 0;
    for_rows(stencil, [&](const Node&, std::size_t place, double weight) {
      double row = 0, row_of_fluid = 0;
      for (std::size_t x = 0; x < static_cast<std::size_t>(points_); ++x) {
        const double moment = stencil[0].weight[x] * value(place + x);
        row += moment, row_of_fluid += solid_[place + x] != 0 ? 0 : moment;
      }
      all += weight * row, of_fluid += weight * row_of_fluid;
    });
    return {all, of_fluid};
  }
  /// `marks` of the places from which so many steps up, or down, along every axis one is marked.
  [[nodiscard]] std::vector<char> grown(std::vector<char> marks, bool down) const;

  Domain<D> domain_;
  int points_;
  double time_;
  const Region<D>* region_;
  Box<D> around_;                 ///< the block and what stencils that touch it reach
  std::vector<char> solid_;       ///< of its nodes
  std::vector<char> touches_;     ///< of first nodes of stencils
  std::vector<double> distance_;  ///< where they reach; beyond a plane wall that of the fluid's node there reversed
};

extern template class WallReach<2>;
extern template class WallReach<3>;

}  // namespace rouleau::core
