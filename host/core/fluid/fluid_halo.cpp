#include "fluid_halo.hpp"

#include "periodic.hpp"
#include "walls.hpp"

namespace rouleau::core {

namespace {

/// Populations of halo nodes that cross the border of a block: of a node outside, those whose velocity points out of
/// the block wherever the node lies outside, and whose origin the block holds. An even step sends them out, and what an
/// odd step has put there goes home. Nothing crosses between solid nodes and others.
template <class Set>
std::vector<HaloCopy<Set::dimension>> population_copies(const Domain<Set::dimension>& domain,
                                                        const SolidNodes<Set::dimension>* solid) {
  using Node = std::array<int, Set::dimension>;
  std::vector<HaloCopy<Set::dimension>> copies;
  for_halo_nodes(domain, 1, 1, [&](const Node& node, const Node& out) {
    for (int q = 1; q < Set::velocity_count; ++q) {
      bool leaves = true;
      Node origin = node;
      for (int k = 0; k < Set::dimension; ++k) {
        const int c = Set::velocity[q][k];
        leaves = leaves && (out[k] == 0 || c == out[k]);
        origin[k] -= c;
      }
      if (solid != nullptr && (solid->at(domain, node) || solid->at(domain, origin))) continue;
      if (leaves && domain.block.contains(origin)) copies.push_back({node, q});
    }
  });
  return copies;
}

/// All components of the velocity, so many nodes deep.
template <int D>
std::vector<HaloCopy<D>> velocity_copies(const Domain<D>& domain, int below, int above) {
  std::vector<HaloCopy<D>> copies;
  for_halo_nodes(domain, below, above, [&](const std::array<int, D>& node, const std::array<int, D>&) {
    for (int component = 0; component < D; ++component) copies.push_back({node, component});
  });
  return copies;
}

}  // namespace

template <class T, class Set>
FluidHalo<T, Set>::FluidHalo(FluidState<T, Set>& state, const Ranks<dimension>& ranks)
    : state_(state), ranks_(ranks), edges_(state.setting.domain.block) {
  using Node = std::array<int, dimension>;
  using Row = typename FluidState<T, Set>::Row;
  const FluidSetting<dimension>& setting = state.setting;
  const Box<dimension> block = setting.domain.block;
  const auto row_of_node = [block](const Node& node) {
    Row row;
    for (int k = 1; k < dimension; ++k) row[k - 1] = node[k] - block.begin[k];
    return row;
  };
  const auto early = [this](const Node& node) { return in_end_rows(node[dimension - 1]); };
  populations_ = std::make_unique<Halo<T, dimension>>(
      ranks_, [&](const Domain<dimension>& domain) { return population_copies<Set>(domain, setting.solid.get()); },
      [&](const Node& node) { return state.lattice.offset(node[0] - block.begin[0], row_of_node(node)); }, early);
  edge_values_ = std::make_unique<Halo<double, dimension>>(
      ranks_, [](const Domain<dimension>& domain) { return velocity_copies(domain, 1, 1); },
      [&](const Node& node) { return edges_.place(node[0] - block.begin[0], row_of_node(node)); });
  if (!setting.membranes) return;
  // What the stencils of nodes above the block's own reach.
  velocities_ = std::make_unique<Halo<T, dimension>>(
      ranks_,
      [above = setting.stencil_above](const Domain<dimension>& domain) {
        return velocity_copies(domain, above - 1, above);
      },
      [&](const Node& node) {
        return state.force[0].row(row_of_node(node)) + (node[0] - block.begin[0]) - state.force[0].row(Row{});
      },
      early);
}

/// Whether the rows of a layer of nodes, in or around the block, are taken first.
template <class T, class Set>
bool FluidHalo<T, Set>::in_end_rows(int layer) const {
  constexpr int axis = dimension - 1;
  const Box<dimension>& block = state_.setting.domain.block;
  const EndRows ends = end_rows(state_.setting.domain, ranks_);
  const int rows = row_count(block) / block.size(axis), above = block.end[axis] - ends.above / rows;
  return layer < block.begin[axis] + ends.below / rows || layer >= above;
}

/// Calls function(halo, way, arrays) for what goes across the border after a step of this parity.
template <class T, class Set>
template <class Function>
void FluidHalo<T, Set>::with_arrays(Parity parity, Function function) {
  using Row = typename FluidState<T, Set>::Row;
  T* slots[velocity_count];
  for (int q = 0; q < velocity_count; ++q) slots[q] = state_.lattice.origin(q);
  function(*populations_, parity == Parity::even ? Way::out : Way::home, slots);
  if (!velocities_) return;
  T* velocity[dimension];
  for (int k = 0; k < dimension; ++k) velocity[k] = state_.force[k].row(Row{});
  function(*velocities_, Way::out, velocity);
}

template <class T, class Set>
void FluidHalo<T, Set>::send(Parity parity, bool early) {
  with_arrays(parity, [this, early](Halo<T, dimension>& halo, Way way, auto& arrays) {
    halo.begin(way, arrays, [this, early](std::size_t rank) {
      return early == (ends_sent_ && populations_->early(rank) && (!velocities_ || velocities_->early(rank)));
    });
  });
}

template <class T, class Set>
void FluidHalo<T, Set>::begin_ends() {
  ends_sent_ = true;
  send(state_.parity, true);
}

template <class T, class Set>
void FluidHalo<T, Set>::begin() {
  send(next(state_.parity), false);
  ends_sent_ = false;
}

template <class T, class Set>
void FluidHalo<T, Set>::end() {
  with_arrays(next(state_.parity), [](Halo<T, dimension>& halo, Way way, auto& arrays) { halo.end(way, arrays); });
  const FluidSetting<dimension>& setting = state_.setting;
  if (velocities_) mirror_velocity<T, dimension>(state_.force, setting.domain, setting.walls);
}

template <class T, class Set>
void FluidHalo<T, Set>::exchange_edges(std::array<double*, dimension> values) const {
  edge_values_->begin(Way::out, values);
  edge_values_->end(Way::out, values);
}

template class FluidHalo<float, D2Q9>;
template class FluidHalo<double, D2Q9>;
template class FluidHalo<float, D3Q19>;
template class FluidHalo<double, D3Q19>;

}  // namespace rouleau::core
