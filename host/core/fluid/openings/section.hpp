// The developed flow through a section of any shape, from the section's own nodes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/fluid/walls.hpp"

namespace rouleau::core {

/// The nodes of a lattice at one place along the axis that a flow goes along (Domain::flow_axis), in their order: those
/// beside each other along the first of the other axes follow each other.
template <int D>
class SectionNodes {
 public:
  explicit SectionNodes(const Domain<D>& domain) : size_(domain.size), axis_(domain.flow_axis()) { size_[axis_] = 1; }
  [[nodiscard]] int axis() const { return axis_; }
  [[nodiscard]] int count() const {
    int product = 1;
    for (const int n : size_) product *= n;
    return product;
  }
  /// Number i of them at a place along the axis, and the other way round.
  [[nodiscard]] std::array<int, D> node(int i, int place) const {
    std::array<int, D> node;
    for (int k = 0; k < D; i /= size_[k++]) node[k] = k == axis_ ? place : i % size_[k];
    return node;
  }
  [[nodiscard]] std::size_t number(const std::array<int, D>& node) const {
    std::size_t number = 0;
    for (int k = D - 1; k >= 0; --k)
      if (k != axis_) number = number * static_cast<std::size_t>(size_[k]) + static_cast<std::size_t>(node[k]);
    return number;
  }

 private:
  std::array<int, D> size_;
  int axis_;
};

/// Of the fluid nodes of a lattice at one place along the axis, if the section there goes on without end. Walls lie
/// where the lattice's links are cut, and velocities are exact between planes (Shortley and Weller, J. Appl. Phys. 9,
/// 334, 1938). Several channels beside each other have one pressure gradient.
struct Section {
  /// By node of the section, 0 in the solid: the velocity along the axis for each force per volume over the viscosity,
  /// and what the walls drag along. Without any wall the former is not finite.
  std::vector<double> driven, dragged;
  double mean_driven = 0, mean_dragged = 0;  ///< of the fluid nodes

  /// The velocity of a node where the mean of the fluid nodes is `mean`.
  [[nodiscard]] double velocity(std::size_t node, double mean) const {
    if (std::isinf(mean_driven)) return driven[node] == 0 ? 0 : mean;
    return dragged[node] + driven[node] * ((mean - mean_dragged) / mean_driven);
  }
};

/// `solid`: null, or the solid nodes.
template <int D>
Section section_at(const Domain<D>& domain, const SolidNodes<D>* solid, const WallVelocity& walls, int place);

/// The openings beside each other at an end, 0 the lower one and 1 the upper one: by node of the section the number of
/// the connected part of the fluid that it belongs to, -1 in the solid. Nodes are connected along axes, over periods,
/// too. Parts are numbered from 0 in the order of their first nodes (SectionNodes).
template <int D>
std::vector<int> parts_of_section(const Domain<D>& domain, int end,
                                  const std::function<bool(const std::array<int, D>& node)>& is_fluid);
/// The same of both ends. `solid`: null without solid nodes.
template <int D>
std::array<std::vector<int>, 2> parts_of_ends(const Domain<D>& domain, const SolidNodes<D>* solid);

}  // namespace rouleau::core
