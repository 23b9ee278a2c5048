// The state of a block of the fluid: what steps change and observers read, and how it is set.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "any_fluid.hpp"
#include "field.hpp"
#include "lattice.hpp"
#include "node_mask.hpp"
#include "openings/open_links.hpp"
#include "solid_links.hpp"

namespace rouleau::core {

/// Of a node: deviation of density, velocity and its gradient {du/dx, du/dy, ..., dv/dx, dv/dy, ...}.
template <int D>
struct NodeState {
  double density, velocity[D], gradient[D * D];
};
/// By node of the lattice.
template <int D>
using StateOfNode = std::conditional_t<D == 2, std::function<NodeState<D>(int x, int y)>,
                                       std::function<NodeState<D>(int x, int y, int z)>>;

/// Populations, forces, relaxation rates and marks, and which half of a pair of steps comes next. Lattice units.
template <class T, class Set>
struct FluidState {
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;
  using Row = typename Lattice<T, Set>::Row;

  const FluidSetting<dimension>& setting;  ///< of who has this state, and lives as long; its drive may change
  Lattice<T, Set> lattice;
  NodeMask mask;
  std::unique_ptr<SolidLinks<T, Set>> links;    ///< null without solid nodes
  std::unique_ptr<OpenLinks<T, Set>> openings;  ///< null where x is periodic
  /// Force density, and after a step the velocity, in active nodes.
  VectorField<T, dimension> force;
  Field<T, dimension> relaxation_rate;
  std::vector<double> rate_of_height = {};  ///< by height in the block; empty without layers
  Parity parity = Parity::even;
  std::array<double, dimension> frame = {};  ///< its velocity (moving_frame.hpp)

  /// Fluid at rest.
  explicit FluidState(const FluidSetting<dimension>& setting);

  /// Nodes of the block along x.
  [[nodiscard]] int nx() const { return setting.domain.block.size(0); }
  [[nodiscard]] std::size_t bytes() const;
  /// 1/tau of the fluid at a row of the block, cells aside.
  /// LinkMemory::place of a link of row i.
  [[nodiscard]] double place_of_link(int i, int x, int q) const {
    const auto row = lattice.row(i);
    double node = 0;
    for (int k = dimension - 1; k >= 0; --k)
      node = node * setting.domain.size[k] + setting.domain.block.begin[k] + (k > 0 ? row[std::max(k - 1, 0)] : x);
    return node * velocity_count + q;
  }
  [[nodiscard]] double rate_of_row(const Row& row) const {
    return setting.viscosity_of_rows.empty() ? setting.relaxation_rate : rate_of_height[row[0]];
  }
  [[nodiscard]] bool in_layer(const Row& row) const { return rate_of_row(row) != setting.relaxation_rate; }
  /// Whether the nodes of a span have a force of their own.
  [[nodiscard]] bool has_force(const MaskSpan& span) const { return span.active && setting.membranes; }

  /// Completes what lies around the block (AnyFluid::settle).
  void settle();
  /// AnyFluid::link_memory() and recall_links().
  [[nodiscard]] LinkMemory link_memory(const Ranks<dimension>& ranks) const;
  void recall_links(const LinkMemory& memory);
  /// The relaxation rates are those of the suspending fluid.
  void set_plain_rates();
  // What sets all populations, for an even step.
  void set(const StateOfNode<dimension>& state);
  /// Fluid::take_over: of a state that is settled.
  void take_over(const FluidState& other, double factor);
  /// From those before the next collision, of the block's nodes, row after row.
  void restore(const std::function<std::vector<double>(int q)>& populations);

 private:
  [[nodiscard]] double equilibrium(int q, double density, const std::array<double, dimension>& u) const;
  /// The populations of all rows have been set.
  void restart();
};

extern template struct FluidState<float, D2Q9>;
extern template struct FluidState<double, D2Q9>;
extern template struct FluidState<float, D3Q19>;
extern template struct FluidState<double, D3Q19>;

}  // namespace rouleau::core
