// The oscillation about a node, of a fluid that is given in bands of rows: that of all its nodes.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/solver/solver.hpp"
#include "monitor/failure_mode.hpp"
#include "plan/placed_cells.hpp"
#include "plan/solver_setup.hpp"
#include "unit/blocks_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;
using monitor::FluidSample;

namespace {

double noise(int x, int y, int z, int what) { return 1e-3 * ((x * 73 + y * 191 + z * 59 + what * 37) % 101 - 50) / 50; }

/// Compares with samples of all moments, at nodes inside, at borders and beyond them.
template <class Set>
void check(const std::string& file, const std::vector<std::string>& overrides) {
  constexpr int D = Set::dimension;
  const scene::Scene scene = plan::read_scene(file, overrides);
  const plan::Plan plan = plan::make_plan(scene, catalog());
  const Domain<D> domain = scene::lattice_domain<D>(scene);
  const auto state = [](int x, int y, int z) {
    typename Fluid<double, Set>::State of_node{noise(x, y, z, 0), {}, {}};
    for (int k = 0; k < D; ++k) of_node.velocity[k] = noise(x, y, z, 1 + k);
    return of_node;
  };
  const std::vector<std::array<int, 3>> nodes{{7, 5, 3},
                                              {0, 0, 0},
                                              {domain.size[0] - 1, domain.size[1] - 1, 4},
                                              {-3, domain.size[1] + 2, -2},
                                              {2, -5 * domain.size[1], 90}};
  const auto found = [&](const Domain<D>& own, const Ranks<D>& ranks, std::vector<double>& expected) {
    auto cells = plan::make_cells<D>(scene);
    auto setup = plan::make_solver_setup<D>(plan, 0);
    setup.domain = own;
    Solver<double, Set> solver(std::move(setup), cells, ranks, {});
    Fluid<double, Set>& fluid = solver.fluid();
    if constexpr (D == 2) {
      fluid.set_state([&](int x, int y) { return state(x, y, 0); });
    } else {
      fluid.set_state(state);
    }
    fluid.settle();
    const std::vector<Moments<D>> moments = fluid.all_moments();
    std::vector<double> values;
    for (const auto& [x, y, z] : nodes) {
      std::array<int, D> node{x, y};
      if constexpr (D == 3) node[2] = z;
      values.push_back(monitor::lattice_oscillation(fluid, node));
      if (!ranks.first()) continue;
      int layer = 0;
      if constexpr (D == 3) layer = std::min(std::max(z, 0), domain.size[2] - 1) * domain.size[1];
      expected.push_back(monitor::lattice_oscillation(x, y, [&](int i, int j) -> FluidSample {
        j = domain.wrapped(1, j);
        if (j < 0) return {NAN, NAN, NAN};
        const Moments<D>& m = moments[static_cast<std::size_t>((layer + j) * domain.size[0] + domain.wrapped(0, i))];
        return {m.velocity[0], m.velocity[1], m.density / std::sqrt(3.0)};
      }));
    }
    return values;
  };
  std::vector<double> expected, again;
  CHECK(found(domain, {}, expected) == expected);
  CHECK(expected.front() > 0.1);
  for (const Cut<D>& cut : cuts_of(domain, 0)) {
    if (cut.blocks.ranks() == 1) continue;
    CAPTURE(cut.what);
    std::vector<double> of_first;
    again.clear();
    on_all_ranks(cut.blocks, [&](const Ranks<D>& ranks) {
      std::vector<double> mine;
      const auto values = found(cut.blocks.domain(ranks.transport->rank()), ranks, mine);
      if (ranks.first()) of_first = values, again = mine;
    });
    CHECK(of_first == expected);
    CHECK(again == expected);
  }
}

}  // namespace

TEST_CASE("the oscillation about a node of a fluid is that of samples of all its nodes") {
  const std::string no_cells = "/cells=[]", none = "/interactions=[]", nodes = "/domain/nodes=[64, 32]";
  check<D2Q9>(four_cells, {shear, no_cells, none, nodes});
  check<D2Q9>(four_cells, {driven, no_cells, none, nodes, "/output={}", "/domain/y=\"periodic\""});
  check<D3Q19>(ROULEAU_SCENES "/capsule-3d.json",
               {no_cells, "/output={}", "/numerics/precision=\"f64\"",
                R"(/domain={"size": ["12 um", "9 um", "7.5 um"], "nodes": [16, 12, 10],
                            "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}})"});
}
