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
  NodeMask mask;
  Lattice<T, Set> lattice;
  std::unique_ptr<SolidLinks<T, Set>> links;           ///< null without solid nodes
  std::unique_ptr<OpenLinks<T, Set>> openings;         ///< null where no axis is open
  std::array<std::vector<int>, 2> parts_of_ends = {};  ///< parts_of_ends(); empty without openings
  /// Force density, and after a step the velocity, in active nodes.
  VectorField<T, dimension> force;
  Field<T, dimension> relaxation_rate;
  std::vector<double> rate_of_height = {};  ///< by height in the block; empty without layers
  std::vector<long> fluid_below = {};       ///< nodes in the rows below each row, and in all; empty without solid nodes
  Parity parity = Parity::even;
  std::array<double, dimension> frame = {};  ///< its velocity (moving_frame.hpp)

  /// Fluid at rest.
  explicit FluidState(const FluidSetting<dimension>& setting);

  /// Nodes of the block along x.
  [[nodiscard]] int nx() const { return setting.domain.block.size(0); }
  [[nodiscard]] std::size_t bytes() const;
  /// Calls function(span, in) for the spans of row i, with the populations before the next collision from x = 0 on.
  template <class Function>
  void for_spans(int i, Function function) const {
    mask.for_spans(i, [&](const MaskSpan& span) {
      if (span.begin < span.end) function(span, pointers(i, span.begin).in);
    });
  }
  /// Calls function(begin, end, in) for the runs of fluid of row i.
  template <class Function>
  void for_fluid(int i, Function function) const {
    mask.for_fluid(i, [&](int begin, int end) { function(begin, end, pointers(i, begin).in); });
  }
  /// Where there are links to solid nodes, calls function(piece's number, pointers) for the pieces of row i.
  template <class Function>
  void for_links(int i, Function function) const {
    if (!links) return;
    lattice.for_pieces(i, [&](const RowPiece& piece, std::size_t n) { function(n, pointers(i, piece.begin)); });
  }
  /// Of the next collision of row i's piece at x.
  struct Pointers {
    typename Lattice<T, Set>::In in;
    typename Lattice<T, Set>::Out out;
  };
  [[nodiscard]] Pointers pointers(int i, int x) const {
    Pointers found;
    lattice.row_pointers(parity, lattice.row(i), x, found.in, found.out);
    return found;
  }
  /// LinkMemory::place of a link of row i.
  [[nodiscard]] double place_of_link(int i, int x, int q) const {
    const auto row = lattice.row(i);
    double node = 0;
    for (int k = dimension - 1; k >= 0; --k)
      node = node * setting.domain.size[k] + setting.domain.block.begin[k] + (k > 0 ? row[std::max(k - 1, 0)] : x);
    return node * velocity_count + q;
  }
  /// Calls function(link, LinkMemory::place) for the links of row i through openings.
  template <class Function>
  void for_open_links(int i, Function function) const {
    if (!openings) return;
    for (auto& link : openings->of_row(i)) function(link, -1 - place_of_link(i, link.x, link.q));
  }
  /// 1/tau of the fluid at a row of the block, cells aside.
  [[nodiscard]] double rate_of_row(const Row& row) const {
    return setting.viscosity_of_rows.empty() ? setting.relaxation_rate : rate_of_height[row[0]];
  }
  [[nodiscard]] bool in_layer(const Row& row) const { return rate_of_row(row) != setting.relaxation_rate; }
  /// Whether the nodes of a span have a force of their own.
  [[nodiscard]] bool has_force(const MaskSpan& span) const { return span.active && setting.membranes; }

  /// Completes what lies around the block (AnyFluid::settle).
  void settle();
  /// After a piece of a row has been collided, of which `out` has the populations (moving_frame.hpp).
  void add_moving_frame(const RowPiece& piece, const Row& row, const typename Lattice<T, Set>::Out& out) const;
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
