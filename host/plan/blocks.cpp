#include "blocks.hpp"

#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "core/membrane/membranes.hpp"
#include "core/membrane/rounding.hpp"
#include "estimate.hpp"
#include "shape/extent.hpp"
#include "solver_setup.hpp"

namespace rouleau::plan {

namespace {

constexpr int least_width = 16, least_height = 4;  // smaller blocks are mostly border

template <int D>
core::Decomposition<D> cut(const Plan& plan, int ranks) {
  const scene::Scene& scene = *plan.scene;
  const core::Domain<D> domain = lattice_domain<D>(scene);
  std::vector<std::array<int, D>> points;  // membrane nodes; of very many a part is enough
  constexpr double most_points = 1e7;
  int every = 1;
  if (plan.has_cells) {
    double nodes = 0;
    for (const scene::CellPlacement& cell : scene.cells) nodes += shape::node_count(scene.cell_types[cell.type]);
    every += static_cast<int>(nodes / most_points);
    points.reserve(static_cast<std::size_t>(nodes / every));
    for_each_cell<D>(scene, lattice_spacing(scene), [&](std::size_t, const auto& cell) {
      const std::vector<double>* const places[] = {&cell.x, &cell.y, &cell.z};
      for (int i = 0; i < cell.node_count(); i += every) {
        std::array<int, D> node;
        for (int k = 0; k < D; ++k) node[k] = domain.wrapped(k, core::floor_int((*places[k])[i]));
        if (*std::min_element(node.begin(), node.end()) >= 0) points.push_back(node);
      }
    });
  }
  const double count = static_cast<double>(domain.nodes()), of_points = static_cast<double>(points.size()) * every;
  const double of_fluid = step_cost(count, 0, scene.numerics.precision, D),
               of_all = step_cost(count, of_points, scene.numerics.precision, D);
  const double point_cost = points.empty() ? 0 : (of_all - of_fluid) / of_points / (of_fluid / count) * every;
  return core::Decomposition<D>::bisected(domain, ranks, points, point_cost);
}

}  // namespace

int most_blocks(const Plan& plan) {
  const int least_depth = plan.scene->domain.depth ? least_height : 1;
  const double most = plan.scene->domain.node_count() / (least_width * least_height * least_depth);
  return static_cast<int>(std::min(most, 1e9));
}

Blocks make_blocks(const Plan& plan, int ranks) {
  const scene::Scene& scene = *plan.scene;
  const int most = most_blocks(plan);
  if (ranks < 1) throw Error(Cause::bad_input, std::to_string(ranks) + " ranks: there is at least one");
  if (ranks > most) {
    const std::string height = std::to_string(least_height);
    throw Error(Cause::bad_input, scene.place("/domain/nodes"),
                std::to_string(ranks) + " ranks are more than the " + std::to_string(most) + " blocks of " +
                    std::to_string(least_width) + " x " + height + (scene.domain.depth ? " x " + height : "") +
                    " nodes that the lattice has room for",
                {"take fewer ranks"});
  }
  if (scene.domain.depth) return cut<3>(plan, ranks);
  return cut<2>(plan, ranks);
}

}  // namespace rouleau::plan
