#include "block_bench.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "base/error.hpp"
#include "core/fluid/fluid.hpp"
#include "measure.hpp"
#include "plan/estimate.hpp"
#include "plan/ranks/blocks.hpp"
#include "plan/ranks/rank_costs.hpp"
#include "plan/read_scene.hpp"
#include "plan/solver_setup.hpp"
#include "plugin/model.hpp"
#include "rank_bench.hpp"

namespace rouleau::bench {

namespace {

template <class Set>
using Size = std::array<int, Set::dimension>;

template <class Set>
Size<Set> constant(int value) {
  Size<Set> all;
  all.fill(value);
  return all;
}

template <class Set>
core::Domain<Set::dimension> periodic(Size<Set> size, int times = 1) {
  std::array<bool, Set::dimension> everywhere;
  everywhere.fill(true);
  for (int& nodes : size) nodes *= times;
  return {size, everywhere};
}

/// The middle one of 3 x 3 (x 3) equal blocks that go on periodically. What a neighbour would send is what this block
/// sends to the other side.
class Mirror final : public core::Transport {
 public:
  explicit Mirror(int dimension) : sent_(dimension == 2 ? 9 : 27) {}
  [[nodiscard]] int rank() const override { return ranks() / 2; }
  [[nodiscard]] int ranks() const override { return static_cast<int>(sent_.size()); }
  void send(int to, core::Message message) override {
    bytes += static_cast<double>(message.size());
    sent_[ranks() - 1 - to].push_back(std::move(message));
  }
  [[nodiscard]] core::Message receive(int from) override {
    core::Message message = std::move(sent_[from].front());
    sent_[from].pop_front();
    return message;
  }
  void abandon() noexcept override {}
  double bytes = 0;  ///< that were sent so far

 private:
  std::vector<std::deque<core::Message>> sent_;
};

/// A fluid that fills the middle block.
template <class T, class Set>
class Block {
 public:
  Block(core::FluidSetting<Set::dimension> setting, core::CollisionOperator collision, Size<Set> size)
      : mirror_(Set::dimension),
        blocks_(core::Decomposition<Set::dimension>::even(periodic<Set>(size, 3), constant<Set>(3))),
        ranks_{&blocks_, &mirror_} {
    setting.domain = blocks_.domain(mirror_.rank());
    fluid.emplace(setting, std::move(collision), ranks_);
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  void exchange() { fluid->begin_halo(), fluid->end_halo(); }
  [[nodiscard]] double sent() const { return mirror_.bytes; }

  std::optional<core::Fluid<T, Set>> fluid;

 private:
  Mirror mirror_;
  core::Decomposition<Set::dimension> blocks_;
  core::Ranks<Set::dimension> ranks_;
};

/// Waves along all axes, one in each block.
template <class T, class Set>
void set_waves(core::Fluid<T, Set>& fluid, Size<Set> size) {
  using State = typename core::Fluid<T, Set>::State;
  const auto wave = [size](std::array<int, 3> at, int axis) {
    return 2 * std::numbers::pi * (at[axis] % size[axis]) / size[axis];
  };
  if constexpr (Set::dimension == 2) {
    fluid.set_state([wave](int x, int y) {
      const double a = wave({x, y, 0}, 0), b = wave({x, y, 0}, 1);
      return State{1e-3 * std::sin(a + b), {0.01 * std::cos(b), 0.02 * std::sin(a)}, {}};
    });
  } else {
    fluid.set_state([wave](int x, int y, int z) {
      const double a = wave({x, y, z}, 0), b = wave({x, y, z}, 1), c = wave({x, y, z}, 2);
      return State{1e-3 * std::sin(a + b + c), {0.01 * std::cos(b), 0.02 * std::sin(c), 0.01 * std::sin(a)}, {}};
    });
  }
}

template <class T, class Set>
void table(const plan::Plan& plan, const core::Decomposition<Set::dimension>& blocks, int rank,
           const plan::RankCost& cost, double seconds) {
  constexpr int D = Set::dimension;
  const auto setup = plan::make_solver_setup<D>(plan, 0);
  const core::Box<D> box = blocks.domain(rank).block;
  Size<Set> size;
  double nodes = 1;
  std::string sides;
  for (int k = 0; k < D; ++k) {
    size[k] = box.size(k);
    nodes *= size[k];
    sides += (k > 0 ? " x " : "") + std::to_string(size[k]);
  }
  core::FluidSetting<D> setting{.domain = periodic<Set>(size),
                                .relaxation_rate = 1 / setup.tau,
                                .inertia = setup.inertia,
                                .membranes = plan.has_cells};
  Block<T, Set> block(setting, setup.collision, size);
  core::Fluid<T, Set> alone(setting, setup.collision);
  set_waves<T, Set>(*block.fluid, size);
  set_waves<T, Set>(alone, size);
  const auto step = [](core::Fluid<T, Set>& fluid) {
    fluid.step(fluid.rows());
    fluid.end_step();
  };
  const double before = block.sent();
  long steps = 0;
  const auto timings = measure({{"with messages", [&](Worker) { step(*block.fluid), block.exchange(), ++steps; }, {}},
                                {"alone", [&](Worker) { step(alone); }, {}}},
                               1, seconds);
  const double with = timings[0].median_s, without = timings[1].median_s;
  std::printf("\nRank %d of %d: %s nodes, its neighbours replaced by itself, no walls; the fluid of a step\n", rank,
              blocks.ranks(), sides.c_str());
  std::printf("  %-46s %12.2f us, %.0f million nodes/s\n", "collide and stream", without * 1e6, nodes / without / 1e6);
  std::printf("  %-46s %12.2f us (%.1f %%)\n", "pack and unpack messages, no network", (with - without) * 1e6,
              (with / without - 1) * 100);
  std::printf("  %-46s %12.2f us\n", "rouleau plan expects of collide and stream",
              plan::step_cost(nodes, 0, plan.scene->numerics.precision, D) * 1e6);
  std::printf("  %-46s %12.2f kB; rouleau plan: %.2f, walls left out\n", "sent in a step",
              (block.sent() - before) / static_cast<double>(steps) / 1e3, cost.lattice_bytes() / 1e3);
}

template <class Set>
void table(const plan::Plan& plan, const core::Decomposition<Set::dimension>& blocks, int rank,
           const plan::RankCost& cost, double seconds) {
  if (plan.scene->numerics.precision == scene::Precision::f64)
    return table<double, Set>(plan, blocks, rank, cost, seconds);
  table<float, Set>(plan, blocks, rank, cost, seconds);
}

/// Throws unless a block whose neighbours are itself computes what a periodic lattice does.
template <class Set>
void check_block(const core::CollisionOperator& collision, Size<Set> size) {
  constexpr int D = Set::dimension;
  const core::FluidSetting<D> setting{.domain = periodic<Set>(size), .relaxation_rate = 1.2, .inertia = true};
  Block<double, Set> block(setting, collision, size);
  core::Fluid<double, Set> alone(setting, collision);
  set_waves<double, Set>(*block.fluid, size);
  set_waves<double, Set>(alone, size);
  for (int i = 0; i < 8; ++i) {
    for (core::Fluid<double, Set>* fluid : {&*block.fluid, &alone}) fluid->step(fluid->rows()), fluid->end_step();
    block.exchange();
  }
  block.fluid->settle();
  alone.settle();
  std::vector<core::Moments<D>> one, other;
  for (int row = 0; row < alone.rows().end; ++row) {
    block.fluid->moments(row, one);
    alone.moments(row, other);
    for (int x = 0; x < size[0]; ++x) {
      if (one[x].density != other[x].density || one[x].velocity != other[x].velocity)
        throw std::runtime_error("a block with itself for neighbours is no periodic lattice");
    }
  }
}

}  // namespace

void block_table(const std::string& file, int ranks, int rank, double seconds) {
  const scene::Scene scene = plan::read_scene(file, {});
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const plan::Plan plan = plan::make_plan(scene, catalog);
  const plan::Blocks blocks = plan::make_blocks(plan, ranks);
  if (rank < 0 || rank >= ranks)
    throw Error(Cause::bad_input, "--rank " + std::to_string(rank) + ": there is no such rank",
                {"ranks count from 0 to " + std::to_string(ranks - 1)});
  const plan::RankCost cost = plan::rank_costs(plan, blocks)[rank];
  if (const auto* plane = std::get_if<core::Decomposition<2>>(&blocks)) {
    table<core::D2Q9>(plan, *plane, rank, cost, seconds);
  } else {
    table<core::D3Q19>(plan, std::get<core::Decomposition<3>>(blocks), rank, cost, seconds);
  }
  std::fflush(stdout);
  if (plan.has_cells) rank_table(plan, blocks, rank, cost, seconds);
}

void check_block() {
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const auto trt = [&](int dimension) {
    return plugin::make_collision_operator(catalog.find(plugin::ModelKind::collision, "trt", {}), {0.1875},
                                           plugin::ModelSetting{{1, 1, 1}, 1.2, true, dimension});
  };
  check_block<core::D2Q9>(trt(2), {32, 12});
  check_block<core::D3Q19>(trt(3), {32, 12, 6});
  std::printf("  a block with itself for neighbours computes what a periodic lattice of its size does, bit by bit\n");
}

}  // namespace rouleau::bench
