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
#include "plan/blocks.hpp"
#include "plan/estimate.hpp"
#include "plan/rank_costs.hpp"
#include "plan/read_scene.hpp"
#include "plan/solver_setup.hpp"
#include "plugin/handles.hpp"

namespace rouleau::bench {

namespace {

/// The middle one of 3 x 3 equal blocks that go on periodically. What a neighbour would send is what this block sends to
/// the other side.
class Mirror final : public core::Transport {
 public:
  [[nodiscard]] int rank() const override { return middle; }
  [[nodiscard]] int ranks() const override { return 9; }
  void send(int to, core::Message message) override {
    bytes += static_cast<double>(message.size());
    sent_[2 * middle - to].push_back(std::move(message));
  }
  [[nodiscard]] core::Message receive(int from) override {
    core::Message message = std::move(sent_[from].front());
    sent_[from].pop_front();
    return message;
  }
  void abandon() noexcept override {}
  double bytes = 0;  ///< that were sent so far

 private:
  static constexpr int middle = 4;
  std::array<std::deque<core::Message>, 9> sent_;
};

/// A fluid that fills the middle block.
template <class T>
class Block {
 public:
  Block(core::FluidSetting<2> setting, core::CollisionOperator collision, std::array<int, 2> size)
      : blocks_(core::Decomposition<2>::even({{3 * size[0], 3 * size[1]}, {true, true}}, {3, 3})),
        ranks_{&blocks_, &mirror_} {
    setting.domain = blocks_.domain(mirror_.rank());
    fluid.emplace(setting, std::move(collision), ranks_);
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  void exchange() { fluid->begin_halo(), fluid->end_halo(); }
  [[nodiscard]] double sent() const { return mirror_.bytes; }

  std::optional<core::Fluid<T>> fluid;

 private:
  Mirror mirror_;
  core::Decomposition<2> blocks_;
  core::Ranks<2> ranks_;
};

template <class T>
void set_waves(core::Fluid<T>& fluid, std::array<int, 2> size) {
  fluid.set_state([size](int x, int y) {
    const double a = 2 * std::numbers::pi * (x % size[0]) / size[0], b = 2 * std::numbers::pi * (y % size[1]) / size[1];
    return typename core::Fluid<T>::State{1e-3 * std::sin(a + b), {0.01 * std::cos(b), 0.02 * std::sin(a)}, {}};
  });
}

template <class T>
void table(const plan::Plan& plan, const core::Decomposition<2>& blocks, int rank, double seconds) {
  const core::SolverSetup setup = plan::make_solver_setup(plan, 0);
  const core::Box<2> box = blocks.domain(rank).block;
  const std::array<int, 2> size{box.size(0), box.size(1)};
  core::FluidSetting<2> setting{.domain = {size, {true, true}},
                                .relaxation_rate = 1 / setup.tau,
                                .inertia = setup.inertia,
                                .membranes = plan.has_cells};
  Block<T> block(setting, setup.collision, size);
  core::Fluid<T> alone(setting, setup.collision);
  set_waves(*block.fluid, size);
  set_waves(alone, size);
  const auto step = [](core::Fluid<T>& fluid) {
    fluid.step(fluid.rows());
    fluid.end_step();
  };
  const double before = block.sent();
  long steps = 0;
  const auto timings = measure({{"with messages", [&](Worker) { step(*block.fluid), block.exchange(), ++steps; }, {}},
                                {"alone", [&](Worker) { step(alone); }, {}}},
                               1, seconds);
  const double nodes = static_cast<double>(size[0]) * size[1];
  const plan::RankCost cost = plan::rank_costs(plan, blocks)[rank];
  const double with = timings[0].median_s, without = timings[1].median_s;
  std::printf("\nRank %d of %d: %d x %d nodes, its neighbours replaced by itself, no walls; the fluid of a step\n",
              rank, blocks.ranks(), size[0], size[1]);
  std::printf("  %-46s %12.2f us, %.0f million nodes/s\n", "collide and stream", without * 1e6, nodes / without / 1e6);
  std::printf("  %-46s %12.2f us (%.1f %%)\n", "pack and unpack messages, no network", (with - without) * 1e6,
              (with / without - 1) * 100);
  std::printf("  %-46s %12.2f us\n", "rouleau plan expects of collide and stream",
              plan::step_cost(nodes, 0, plan.scene->numerics.precision) * 1e6);
  std::printf("  %-46s %12.2f kB; rouleau plan: %.2f, walls left out\n", "sent in a step",
              (block.sent() - before) / static_cast<double>(steps) / 1e3, cost.lattice_bytes() / 1e3);
}

}  // namespace

void block_table(const std::string& file, int ranks, int rank, double seconds) {
  const scene::Scene scene = plan::read_scene(file, {});
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const plan::Plan plan = plan::make_plan(scene, catalog);
  if (scene.domain.depth) {
    throw Error(Cause::bad_input, scene.place("/domain/size"), "blocks of three dimensions are not measured",
                {"give a scene of two dimensions"});
  }
  const auto blocks = std::get<core::Decomposition<2>>(plan::make_blocks(plan, ranks));
  if (rank < 0 || rank >= ranks)
    throw Error(Cause::bad_input, "--rank " + std::to_string(rank) + ": there is no such rank",
                {"ranks count from 0 to " + std::to_string(ranks - 1)});
  if (scene.numerics.precision == scene::Precision::f64) {
    table<double>(plan, blocks, rank, seconds);
  } else {
    table<float>(plan, blocks, rank, seconds);
  }
}

void check_block() {
  const plugin::Catalog catalog({ROULEAU_PLUGINS});
  const core::CollisionOperator trt = plugin::make_collision_operator(
      catalog.find(plugin::ModelKind::collision, "trt", {}), {0.1875}, plugin::ModelSetting{{1, 1, 1}, 1.2, true, 2});
  const std::array<int, 2> size{32, 12};
  const core::FluidSetting<2> setting{.domain = {size, {true, true}}, .relaxation_rate = 1.2, .inertia = true};
  Block<double> block(setting, trt, size);
  core::Fluid<double> alone(setting, trt);
  set_waves(*block.fluid, size);
  set_waves(alone, size);
  for (int i = 0; i < 8; ++i) {
    for (core::Fluid<double>* fluid : {&*block.fluid, &alone}) fluid->step(fluid->rows()), fluid->end_step();
    block.exchange();
  }
  block.fluid->settle();
  alone.settle();
  std::vector<core::Moments<2>> one, other;
  for (int y = 0; y < size[1]; ++y) {
    block.fluid->moments(y, one);
    alone.moments(y, other);
    for (int x = 0; x < size[0]; ++x) {
      if (one[x].density != other[x].density || one[x].velocity != other[x].velocity)
        throw std::runtime_error("a block with itself for neighbours is no periodic lattice");
    }
  }
  std::printf("  a block with itself for neighbours computes what a periodic lattice of its size does, bit by bit\n");
}

}  // namespace rouleau::bench
