// Blocks of a lattice, as ranks of one process: the same bits as the lattice in one piece.
#include <catch2/catch.hpp>
#include <thread>

#include "core/domain/decomposition.hpp"
#include "core/domain/transport.hpp"
#include "core/fluid/developed_flow.hpp"
#include "unit/flow_fixture.hpp"
#include "unit/random.hpp"
#include "unit/shipped_models.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// A number of either sign that belongs to a node of the lattice, whatever block it lies in.
double noise(int x, int y, int what) { return 1e-3 * ((x * 73 + y * 191 + what * 37) % 101 - 50) / 50; }

/// A block with all that a block may have: noise in every population, force in marked nodes, viscosity in some of them.
template <class T>
std::unique_ptr<Fluid<T>> noisy_fluid(FluidSetting<2> setting, const Domain<2>& domain, const Ranks<2>& ranks) {
  setting.domain = domain;
  auto fluid = std::make_unique<Fluid<T>>(setting, trt(1 / setting.relaxation_rate, true), ranks);
  fluid->set_state([](int x, int y) {
    return typename Fluid<T>::State{
        noise(x, y, 0), {noise(x, y, 1), noise(x, y, 2)}, {noise(x, y, 3), noise(x, y, 4), noise(x, y, 5), 0}};
  });
  for (int y = 0; y < domain.block.size(1) && setting.membranes; ++y) {
    const int row = y + domain.block.begin[1];
    fluid->mask().mark(y, 5 + row, 30 + row);
    for (int x = 0; x < domain.block.size(0) && setting.viscosity_contrast; ++x) {
      const double rate = setting.relaxation_rate * (1 + 100 * noise(x + domain.block.begin[0], row, 6));
      if (fluid->mask().active(x, y)) fluid->relaxation_rate().row(y)[x] = static_cast<T>(rate);
    }
  }
  return fluid;
}

/// Force of this step in marked nodes, as membranes would spread it.
template <class T>
void spread(Fluid<T>& fluid, int step) {
  const Domain<2>& domain = fluid.setting().domain;
  fluid.clear_force(fluid.rows());
  for (int y = 0; y < domain.block.size(1); ++y) {
    for (int x = 0; x < domain.block.size(0); ++x) {
      if (!fluid.mask().active(x, y)) continue;
      fluid.force()[0].row(y)[x] += static_cast<T>(noise(x + domain.block.begin[0], y + domain.block.begin[1], step));
      fluid.force()[1].row(y)[x] += static_cast<T>(noise(x + domain.block.begin[0], y + domain.block.begin[1], -step));
    }
  }
}

template <class T>
void step(Fluid<T>& fluid, int number) {
  if (fluid.setting().membranes) spread(fluid, number);
  fluid.step(fluid.rows());
  fluid.end_step();
  fluid.begin_halo();
  fluid.end_halo();
}

/// Cuts by bisection at random places, down to blocks of one node.
Decomposition<2> random_cuts(const Domain<2>& domain, int cuts, std::mt19937& random) {
  std::vector<Box<2>> blocks{domain.block};
  while (cuts > 0) {
    Box<2>& block = blocks[std::uniform_int_distribution<std::size_t>(0, blocks.size() - 1)(random)];
    const int axis = std::uniform_int_distribution<int>(0, 1)(random);
    if (block.size(axis) < 2) continue;
    const int at = block.begin[axis] + std::uniform_int_distribution<int>(1, block.size(axis) - 1)(random);
    Box<2> upper = block;
    upper.begin[axis] = at;
    block.end[axis] = at;
    blocks.push_back(upper);
    --cuts;
  }
  return {domain, blocks};
}

template <class T>
void compare(const FluidSetting<2>& setting, const Decomposition<2>& cut, int steps) {
  const auto whole = noisy_fluid<T>(setting, setting.domain, {});
  for (int i = 0; i < steps; ++i) step(*whole, i);
  whole->settle();

  const auto ends = make_loopback(cut.ranks());
  std::vector<std::unique_ptr<Fluid<T>>> blocks(ends.size());
  std::vector<std::thread> threads;
  for (int rank = 0; rank < cut.ranks(); ++rank) {
    threads.emplace_back([&, rank] {
      blocks[rank] = noisy_fluid<T>(setting, cut.domain(rank), {&cut, ends[rank].get()});
      for (int i = 0; i < steps; ++i) step(*blocks[rank], i);
      blocks[rank]->settle();
    });
  }
  for (std::thread& thread : threads) thread.join();

  long different = 0, velocities = 0;
  for (const auto& block : blocks) {
    const Domain<2>& domain = block->setting().domain;
    for (int y = 0; y < domain.block.size(1); ++y) {
      for (int x = 0; x < domain.block.size(0); ++x) {
        const int column = x + domain.block.begin[0], row = y + domain.block.begin[1];
        for (int q = 0; q < 9; ++q)
          different += block->population(q, x, y) != whole->population(q, column, row) ? 1 : 0;
        if (!setting.membranes || !whole->mask().active(column, row)) continue;
        // What a stencil with this base node reads, halo and mirror images beyond walls included.
        for (int j = -1; j <= 2; ++j) {
          for (int i = -1; i <= 2; ++i) {
            const int at_x = setting.domain.wrapped(0, column + i), at_y = setting.domain.wrapped(1, row + j);
            if (at_y >= 0 && !whole->mask().active(at_x, at_y)) continue;
            const int mirror = at_y >= 0 ? at_y : mirrored(row + j, setting.domain.size[1]);
            if (at_y < 0 && !whole->mask().active(at_x, mirror)) continue;
            const VectorField<T, 2>&a = block->velocity(), &b = whole->velocity();
            const int whole_row = at_y >= 0 ? at_y : row + j;
            different += a[0].row(y + j)[x + i] != b[0].row(whole_row)[at_x] ? 1 : 0;
            different += a[1].row(y + j)[x + i] != b[1].row(whole_row)[at_x] ? 1 : 0;
            ++velocities;
          }
        }
      }
    }
  }
  CHECK(different == 0);
  CHECK((velocities > 0) == setting.membranes);
}

}  // namespace

TEMPLATE_TEST_CASE("blocks give the same bits as one lattice, whatever the cuts", "", float, double) {
  const bool periodic_y = GENERATE(false, true);
  const bool membranes = GENERATE(false, true);
  FluidSetting<2> setting{.domain = {{43, 19}, {true, periodic_y}},
                          .relaxation_rate = 1.25,
                          .inertia = true,
                          .walls = {-0.01, 0.02},
                          .body_force = {1e-5},
                          .membranes = membranes,
                          .viscosity_contrast = membranes};
  if (periodic_y) setting.walls = {};
  if (GENERATE(false, true)) setting.viscosity_of_rows = viscosity_of_rows({{3.3, 9, 0.4}, {14, 19, 5}}, 19);
  using Cuts = std::array<int, 2>;
  for (const Cuts parts : {Cuts{1, 1}, Cuts{2, 1}, Cuts{1, 3}, Cuts{4, 4}, Cuts{8, 1}, Cuts{1, 19}}) {
    CAPTURE(parts, periodic_y, membranes);
    compare<TestType>(setting, Decomposition<2>::even(setting.domain, parts), 8);
    compare<TestType>(setting, Decomposition<2>::even(setting.domain, parts), 9);
  }
  auto random = generator(311);
  for (int trial = 0; trial < 6; ++trial) {
    const Decomposition<2> cut = random_cuts(setting.domain, 1 + trial * 2, random);
    CAPTURE(trial, periodic_y, membranes);
    compare<TestType>(setting, cut, 7 + trial % 2);
  }
}

TEST_CASE("blocks must fill the lattice, each node once") {
  const Domain<2> domain({8, 4}, {true, false});
  using Blocks = std::vector<Box<2>>;
  CHECK_NOTHROW(Decomposition<2>(domain, Blocks{{{0, 0}, {3, 4}}, {{3, 0}, {8, 1}}, {{3, 1}, {8, 4}}}));
  CHECK_THROWS_AS(Decomposition<2>(domain, Blocks{{{0, 0}, {3, 4}}, {{3, 0}, {8, 1}}}), std::invalid_argument);
  CHECK_THROWS_AS(Decomposition<2>(domain, Blocks{{{0, 0}, {5, 4}}, {{3, 0}, {6, 4}}}), std::invalid_argument);
  CHECK_THROWS_AS(Decomposition<2>(domain, Blocks{{{0, 0}, {9, 4}}}), std::invalid_argument);
  CHECK_THROWS_AS(Decomposition<2>(domain, Blocks{{{0, 0}, {8, 4}}, {{0, 0}, {0, 4}}}), std::invalid_argument);
}
