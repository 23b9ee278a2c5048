#include "blocks.hpp"

#include <string>

#include "base/error.hpp"
#include "core/membrane/membranes.hpp"
#include "core/membrane/rounding.hpp"
#include "estimate.hpp"
#include "solver_setup.hpp"

namespace rouleau::plan {

core::Decomposition<2> make_blocks(const Plan& plan, int ranks) {
  const scene::Scene& scene = *plan.scene;
  if (scene.domain.depth) {
    throw Error(Cause::bad_input, scene.place("/domain/size"), "three dimensions run in one process only so far",
                {"start one process, with several threads"});
  }
  const core::Domain<2> domain = lattice_domain(scene);
  constexpr int least_width = 16, least_height = 4;  // smaller blocks are mostly border
  const long most = domain.nodes() / (least_width * least_height);
  if (ranks < 1) throw Error(Cause::bad_input, std::to_string(ranks) + " ranks: there is at least one");
  if (ranks > most) {
    throw Error(Cause::bad_input, scene.place("/domain/nodes"),
                std::to_string(ranks) + " ranks are more than the " + std::to_string(most) + " blocks of " +
                    std::to_string(least_width) + " x " + std::to_string(least_height) +
                    " nodes that the lattice has room for",
                {"take fewer ranks"});
  }
  std::vector<std::array<int, 2>> points;
  if (plan.has_cells) {
    const core::Membranes membranes = make_membranes(scene, lattice_spacing(scene));
    points.reserve(membranes.x.size());
    for (std::size_t i = 0; i < membranes.x.size(); ++i) {
      const int x = domain.wrapped(0, core::floor_int(membranes.x[i])),
                y = domain.wrapped(1, core::floor_int(membranes.y[i]));
      if (x >= 0 && y >= 0) points.push_back({x, y});
    }
  }
  const double count = static_cast<double>(domain.nodes()), of_points = static_cast<double>(points.size());
  const double of_fluid = step_cost(count, 0, scene.numerics.precision),
               of_all = step_cost(count, of_points, scene.numerics.precision);
  const double point_cost = points.empty() ? 0 : (of_all - of_fluid) / of_points / (of_fluid / count);
  return core::Decomposition<2>::bisected(domain, ranks, points, point_cost);
}

}  // namespace rouleau::plan
