// The same bits from any number of ranks: cells that attract each other in shear, the lattice cut into blocks. unit_run
// cuts scenes with all that a scene may have (tests/unit/run/solver_blocks.cpp).
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <optional>
#include <vector>

#include "core/solver/solver.hpp"
#include "unit/cell_fixture.hpp"
#include "unit/rank_threads.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

template <int D>
Cells<D> cells() {
  if constexpr (D == 2)
    return biconcave_cells({{30, 42, 0.1}, {33, 60, 0.3}, {90, 50, 1.2}});
  else {
    Surfaces all;
    all.types = {std::make_shared<const RestSurface>(rest_surface(biconcave_disc(4, 6)))};
    add_cell(all, 0, {9, 12, 11}), add_cell(all, 0, {10, 19, 12}), add_cell(all, 0, {27, 15, 1});
    return all;
  }
}

template <int D>
BasicSolverSetup<D> setup_in(const Domain<D>& domain) {
  BasicSolverSetup<D> setup;
  setup.domain = domain;
  setup.walls = {-0.02, 0.02};
  setup.developed = true;
  setup.collision = trt(setup.tau, false, D);
  const auto of = D == 2 ? law : surface_law;
  setup.cell_types.resize(D == 2 ? 4 : 1, {{of("neo-hookean", {0.01, 0}), of("bending", {0.02, 0, 0})}, 3});
  setup.interactions = {{{0, 0}, morse(0.002, 0.75, 1.5, 6)}};
  setup.area_correction = true;
  return setup;
}

/// Populations of the block, node after node, and what the rank's own cells have come to.
struct End {
  std::vector<double> populations;
  std::vector<int> owned;
  std::array<std::vector<double>, 3> position, velocity;
};

template <class Set>
End simulate(const Domain<Set::dimension>& domain, const Ranks<Set::dimension>& ranks, int steps) {
  constexpr int D = Set::dimension;
  Cells<D> all = cells<D>();
  BasicSolverSetup<D> setup = setup_in(domain);
  std::optional<GhostCells<D>> ghosts;
  if (ranks.several()) ghosts.emplace(ranks, boxes_of<D>(all), ghost_reach(setup));
  Solver<double, Set> solver(std::move(setup), all, ranks, std::move(ghosts));
  solver.start();
  solver.step(steps);
  solver.fluid().settle();
  End end{.populations = {}, .owned = {}, .position = all.position, .velocity = all.velocity};
  std::vector<double> values;
  for (int q = 0; q < Set::velocity_count; ++q) {
    solver.fluid().copy_populations(q, values);
    end.populations.insert(end.populations.end(), values.begin(), values.end());
  }
  for (int c = 0; c < all.cell_count(); ++c) {
    if (all.owns(c)) end.owned.push_back(c);
  }
  return end;
}

/// The populations that a block has of the whole lattice's.
template <class Set>
std::vector<double> part(const std::vector<double>& whole, const Domain<Set::dimension>& domain) {
  constexpr int D = Set::dimension;
  const Box<D>& block = domain.block;
  std::vector<double> found;
  std::ptrdiff_t nodes = 1;
  for (const int n : domain.size) nodes *= n;
  for (int q = 0; q < Set::velocity_count; ++q) {
    for (int i = 0; i < row_count(block); ++i) {
      const auto row = row_of(block, i);
      std::ptrdiff_t at = 0;
      for (int k = D - 1; k > 0; --k) at = at * domain.size[k] + block.begin[k] + row[k - 1];
      const auto first = whole.begin() + q * nodes + at * domain.size[0] + block.begin[0];
      found.insert(found.end(), first, first + block.size(0));
    }
  }
  return found;
}

}  // namespace

TEMPLATE_TEST_CASE("a solver cut into blocks comes to the bits of the one in one piece", "", D2Q9, D3Q19) {
  constexpr int D = TestType::dimension;
  Domain<D> domain;
  std::array<int, D> parts;
  parts.fill(2);
  if constexpr (D == 2)
    domain = {{120, 100}, {true, false}};
  else
    domain = {{36, 30, 24}, {true, false, true}};
  parts[0] = GENERATE(1, 3);
  const int steps = 40;
  const End whole = simulate<TestType>(domain, {}, steps);
  const auto blocks = Decomposition<D>::even(domain, parts);
  std::vector<End> ends(static_cast<std::size_t>(blocks.ranks()));
  on_all_ranks(blocks, [&](const Ranks<D>& ranks) {
    ends[ranks.transport->rank()] = simulate<TestType>(blocks.domain(ranks.transport->rank()), ranks, steps);
  });
  const Cells<D> at_first = cells<D>();
  CHECK(whole.position[0] != at_first.position[0]);
  std::vector<int> owned;
  for (int rank = 0; rank < blocks.ranks(); ++rank) {
    const End& end = ends[rank];
    CHECK((end.populations == part<TestType>(whole.populations, blocks.domain(rank))));
    for (const int c : end.owned) {
      owned.push_back(c);
      const CellRange& cell = at_first.cells[c];
      for (int k = 0; k < D; ++k) {
        for (int i = cell.first; i < cell.end(); ++i) {
          REQUIRE(end.position[k][i] == whole.position[k][i]);
          REQUIRE(end.velocity[k][i] == whole.velocity[k][i]);
        }
      }
    }
  }
  std::sort(owned.begin(), owned.end());
  CHECK(owned == std::vector<int>{0, 1, 2});
}
