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

}  // namespace

int most_blocks(const Plan& plan) {
  const double most = plan.scene->domain.node_count() / (least_width * least_height);
  return static_cast<int>(std::min(most, 1e9));
}

core::Decomposition<2> make_blocks(const Plan& plan, int ranks) {
  const scene::Scene& scene = *plan.scene;
  if (scene.domain.depth) {
    throw Error(Cause::bad_input, scene.place("/domain/size"), "three dimensions run in one process only so far",
                {"start one process, with several threads"});
  }
  const core::Domain<2> domain = lattice_domain(scene);
  const int most = most_blocks(plan);
  if (ranks < 1) throw Error(Cause::bad_input, std::to_string(ranks) + " ranks: there is at least one");
  if (ranks > most) {
    throw Error(Cause::bad_input, scene.place("/domain/nodes"),
                std::to_string(ranks) + " ranks are more than the " + std::to_string(most) + " blocks of " +
                    std::to_string(least_width) + " x " + std::to_string(least_height) +
                    " nodes that the lattice has room for",
                {"take fewer ranks"});
  }
  std::vector<std::array<int, 2>> points;  // membrane nodes; of very many a part is enough
  constexpr double most_points = 1e7;
  int every = 1;
  if (plan.has_cells) {
    double nodes = 0;
    for (const scene::CellPlacement& cell : scene.cells) nodes += shape::node_count(scene.cell_types[cell.type]);
    every += static_cast<int>(nodes / most_points);
    points.reserve(static_cast<std::size_t>(nodes / every));
    for_each_outline(scene, lattice_spacing(scene), [&](std::size_t, const core::Membranes& outline) {
      for (int i = 0; i < outline.node_count(); i += every) {
        const int x = domain.wrapped(0, core::floor_int(outline.x[i])),
                  y = domain.wrapped(1, core::floor_int(outline.y[i]));
        if (x >= 0 && y >= 0) points.push_back({x, y});
      }
    });
  }
  const double count = static_cast<double>(domain.nodes()), of_points = static_cast<double>(points.size()) * every;
  const double of_fluid = step_cost(count, 0, scene.numerics.precision),
               of_all = step_cost(count, of_points, scene.numerics.precision);
  const double point_cost = points.empty() ? 0 : (of_all - of_fluid) / of_points / (of_fluid / count) * every;
  return core::Decomposition<2>::bisected(domain, ranks, points, point_cost);
}

}  // namespace rouleau::plan
