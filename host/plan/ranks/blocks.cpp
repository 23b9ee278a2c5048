#include "blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "core/membrane/membranes.hpp"
#include "core/membrane/rounding.hpp"
#include "plan/estimate.hpp"
#include "plan/placed_cells.hpp"
#include "scene/lattice.hpp"
#include "scene/scene_reader.hpp"

namespace rouleau::plan {

namespace {

/// Sides of the smallest block: smaller ones are mostly border.
std::vector<int> least_block(const scene::Domain& domain) {
  constexpr std::array sides{16, 4, 4};
  return {sides.begin(), sides.begin() + domain.dimension()};
}

/// Membrane nodes on the lattice. Of very many a part is enough.
template <int D>
class Points {
 public:
  Points(const core::Domain<D>& domain, double nodes) : domain_(domain), every_(1 + static_cast<int>(nodes / most)) {
    points_.reserve(static_cast<std::size_t>(nodes / every_) + 1);
  }
  /// Those of own cells.
  void add(const core::CellNodes& cells) {
    const auto& places = cells.position;
    for (int c = 0; c < cells.cell_count(); ++c) {
      const core::CellRange& cell = cells.cells[c];
      for (int i = (cell.first + every_ - 1) / every_ * every_; i < cell.end() && cells.owns(c); i += every_) {
        std::array<int, D> node;
        for (int k = 0; k < D; ++k) node[k] = domain_.wrapped(k, core::floor_int(places[k][i]));
        if (*std::min_element(node.begin(), node.end()) >= 0) points_.push_back(node);
      }
    }
  }
  /// Those of all ranks.
  void share(const core::Ranks<D>& ranks) {
    const auto of_ranks = core::all_of(ranks, std::move(points_));
    points_.clear();
    for (const auto& of_rank : of_ranks) points_.insert(points_.end(), of_rank.begin(), of_rank.end());
  }
  [[nodiscard]] const std::vector<std::array<int, D>>& all() const { return points_; }
  /// How much more than a node of the lattice one of them costs.
  [[nodiscard]] double cost(const Plan& plan) const {
    if (points_.empty()) return 0;
    const scene::Precision precision = plan.scene->numerics.precision;
    const double count = scene::fluid_nodes(plan.scene->domain), nodes = static_cast<double>(points_.size()) * every_,
                 of_fluid = step_cost(count, 0, precision, D),
                 of_all = step_cost(count, nodes, precision, D, membrane_scheme(plan));
    return (of_all - of_fluid) / nodes / (of_fluid / count) * every_;
  }

 private:
  static constexpr double most = 1e7;
  core::Domain<D> domain_;
  int every_;
  std::vector<std::array<int, D>> points_;
};

/// Between walls of any shape; none without them.
template <int D>
typename core::Decomposition<D>::Fluid some_fluid(const scene::Scene& scene, const core::Domain<D>& domain) {
  constexpr double enough = 1e5;
  const core::RegionPointer<D> region = scene::fluid_region<D>(scene);
  if (!region) return {};
  const double count = scene::fluid_nodes(scene.domain);
  const int every = static_cast<int>(std::ceil(std::pow(std::max(count / enough, 1.0), 1.0 / D)));
  core::Box<D> coarse{};
  for (int k = 0; k < D; ++k) coarse.end[k] = (domain.size[k] - 1) / every + 1;
  typename core::Decomposition<D>::Fluid fluid;
  for (int i = 0; i < row_count(coarse) * coarse.size(0); ++i) {
    std::array<int, D> node;
    core::Vec<D> place;
    for (int k = 0, rest = i; k < D; rest /= coarse.size(k++)) place[k] = node[k] = rest % coarse.size(k) * every;
    if (region->distance(place).value > 0) fluid.nodes.push_back(node);
  }
  fluid.each = count / static_cast<double>(fluid.nodes.size());
  return fluid;
}

template <int D>
core::Decomposition<D> cut(const Plan& plan, int ranks) {
  const scene::Scene& scene = *plan.scene;
  const core::Domain<D> domain = scene::lattice_domain<D>(scene);
  Points<D> points(domain, membrane_nodes(scene));
  if (plan.has_cells)
    for_each_cell<D>(scene, scene::lattice_spacing(scene), [&](std::size_t, const auto& cell) { points.add(cell); });
  return core::Decomposition<D>::bisected(domain, ranks, points.all(), points.cost(plan), {},
                                          some_fluid<D>(scene, domain));
}

}  // namespace

int most_blocks(const Plan& plan) {
  double most = plan.scene->domain.node_count();
  for (const int side : least_block(plan.scene->domain)) most /= side;
  return static_cast<int>(std::min(most, 1e9));
}

void require_computable(const scene::Scene& scene, const Blocks* blocks) {
  double most = scene.domain.node_count();
  int ranks = 1;
  const auto look = [&](const auto& of_lattice) {
    ranks = of_lattice.ranks(), most = 0;
    for (int rank = 0; rank < ranks; ++rank) {
      const auto block = of_lattice.domain(rank).block;
      most = std::max(most, static_cast<double>(core::row_count(block)) * block.size(0));
    }
  };
  if (blocks != nullptr) std::visit(look, *blocks);
  if (most <= static_cast<double>(scene::most_nodes_of_block)) return;
  const int enough = std::max(scene::fewest_ranks(scene.domain), ranks + 1);
  throw Error(Cause::bad_input, scene.place("/domain/nodes"),
              number(most, 12) + (ranks > 1 ? " nodes of a block" : " nodes") + " are more than the " +
                  std::to_string(scene::most_nodes_of_block) + " that one rank can compute",
              {"start the run on more ranks, at least " + std::to_string(enough) + " (docs/ranks.md)"});
}

Blocks make_blocks(const Plan& plan, int ranks) {
  const scene::Scene& scene = *plan.scene;
  const int most = most_blocks(plan);
  if (ranks < 1) throw Error(Cause::bad_input, std::to_string(ranks) + " ranks: there is at least one");
  if (ranks > most)
    throw Error(Cause::bad_input, scene.place("/domain/nodes"),
                std::to_string(ranks) + " ranks are more than the " + std::to_string(most) + " blocks of " +
                    scene::by_axes(least_block(scene.domain)) + " nodes that the lattice has room for",
                {"take fewer ranks"});
  return scene::in_dimension(scene.domain.dimension(),
                             [&]<int D>(std::integral_constant<int, D>) -> Blocks { return cut<D>(plan, ranks); });
}

template <int D>
core::Decomposition<D> cut_again(const Plan& plan, const core::Ranks<D>& ranks, const core::CellNodes& cells,
                                 const std::vector<double>& seconds) {
  const core::Decomposition<D>& blocks = *ranks.blocks;
  const core::Domain<D> domain = scene::lattice_domain<D>(*plan.scene);
  Points<D> points(domain, cells.node_count());
  points.add(cells);
  points.share(ranks);
  const double point_cost = points.cost(plan);
  const auto fluid = some_fluid<D>(*plan.scene, domain);
  std::vector<double> expected(seconds.size(), 1.0);
  for (int rank = 0; rank < blocks.ranks() && fluid.nodes.empty(); ++rank) {
    const core::Box<D> block = blocks.domain(rank).block;
    expected[rank] = static_cast<double>(core::row_count(block)) * block.size(0);
  }
  for (const std::array<int, D>& node : fluid.nodes) expected[blocks.owner(node)] += fluid.each;
  for (const std::array<int, D>& point : points.all()) expected[blocks.owner(point)] += point_cost;
  typename core::Decomposition<D>::Measured measured{.blocks = &blocks, .factor = {}};
  const bool known = std::all_of(seconds.begin(), seconds.end(), [](double s) { return s > 0; });
  for (std::size_t rank = 0; rank < seconds.size(); ++rank)
    measured.factor.push_back(known ? seconds[rank] / expected[rank] : 1);
  const double mean = std::accumulate(measured.factor.begin(), measured.factor.end(), 0.0) / blocks.ranks();
  for (double& factor : measured.factor) factor /= mean;
  return core::Decomposition<D>::bisected(domain, blocks.ranks(), points.all(), point_cost, measured, fluid);
}

template core::Decomposition<2> cut_again(const Plan&, const core::Ranks<2>&, const core::CellNodes&,
                                          const std::vector<double>&);
template core::Decomposition<3> cut_again(const Plan&, const core::Ranks<3>&, const core::CellNodes&,
                                          const std::vector<double>&);

}  // namespace rouleau::plan
