// In-place streaming across borders, the node mask: against plain two-array streaming and by conservation.
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <rouleau/d2q9.hpp>

#include "unit/flow_fixture.hpp"
#include "unit/shipped_models.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;
namespace d2q9 = rouleau::d2q9;

namespace {

/// The textbook: collide into a copy, then move every population to its neighbour or bounce it back.
struct TwoArrayFluid {
  int nx, ny;
  bool periodic_y;
  WallVelocity walls;
  rouleau::core::CollisionOperator collision;
  std::vector<double> f;  // [y][x][q]

  double& at(std::vector<double>& a, int q, int x, int y) const {
    return a[(static_cast<std::size_t>(y) * nx + static_cast<std::size_t>(x)) * 9 + static_cast<std::size_t>(q)];
  }
  void step() {
    std::vector<double> after = f, streamed = f;
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        const double* in[9];
        double* out[9];
        for (int q = 0; q < 9; ++q) in[q] = &at(f, q, x, y), out[q] = &at(after, q, x, y);
        rouleau_collision_block_f64 block{};
        block.struct_size = sizeof block;
        block.count = 1;
        block.in = in;
        block.out = out;
        collision.table->collide_f64(collision.self.get(), &block);
      }
    }
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        for (int q = 0; q < 9; ++q) {
          const int to_x = (x + d2q9::velocity[q][0] + nx) % nx;
          int to_y = y + d2q9::velocity[q][1];
          if (!periodic_y && (to_y < 0 || to_y >= ny)) {
            const double speed = to_y < 0 ? walls.lower : walls.upper;
            at(streamed, d2q9::opposite[q], x, y) =
                at(after, q, x, y) - 6 * d2q9::weight[q] * d2q9::velocity[q][0] * speed;
          } else {
            to_y = (to_y + ny) % ny;
            at(streamed, q, to_x, to_y) = at(after, q, x, y);
          }
        }
      }
    }
    f = streamed;
  }
};

}  // namespace

TEST_CASE("in-place streaming gives the same populations as two arrays, with walls and without") {
  const bool periodic_y = GENERATE(false, true);
  const bool inertia = GENERATE(false, true);
  const int workers = GENERATE(1, 2, 3);
  const int nx = GENERATE(16, 37), ny = 11;
  const double tau = 0.8;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  const auto collision = trt(tau, inertia);
  FluidSetting<2> setting{
      .domain = {{nx, ny}, {true, periodic_y}}, .relaxation_rate = 1 / tau, .inertia = inertia, .walls = {-0.01, 0.02}};
  if (periodic_y) setting.walls = {};
  Fluid<double> fluid(setting, collision);
  fluid.set_state([&](int, int) {
    return Fluid<double>::State{uniform(random), {uniform(random), uniform(random)}, {}};
  });
  TwoArrayFluid plain{
      nx, ny, periodic_y, setting.walls, collision, std::vector<double>(static_cast<std::size_t>(nx * ny * 9))};
  fluid.settle();
  const auto each = [&](auto function) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        for (int q = 0; q < 9; ++q) function(q, x, y);
      }
    }
  };
  each([&](int q, int x, int y) { plain.at(plain.f, q, x, y) = fluid.population(q, x, y); });
  for (int step = 0; step < 9; ++step) {
    for (int w = workers - 1; w >= 0; --w) fluid.step(Worker{w, workers}.share(ny));
    fluid.end_step();
    plain.step();
    fluid.settle();
    double difference = 0;
    each([&](int q, int x, int y) {
      difference = std::max(difference, std::abs(fluid.population(q, x, y) - plain.at(plain.f, q, x, y)));
    });
    CAPTURE(periodic_y, inertia, workers, nx, step);
    REQUIRE(difference < 1e-16);
  }
}

TEST_CASE("the number of workers does not change a bit") {
  const auto run = [](int workers) {
    FluidSetting<2> setting{.domain = {{40, 23}, {true, false}}, .relaxation_rate = 1.1, .walls = {-0.02, 0.02}};
    Fluid<float> fluid(setting, trt(1 / 1.1, true));
    fluid.set_state([](int x, int y) {
      return Fluid<float>::State{0, {1e-3 * ((x * 7 + y * 3) % 11), 1e-3 * ((x * 5 + y) % 7)}, {}};
    });
    for (int step = 0; step < 51; ++step) {
      for (int w = 0; w < workers; ++w) fluid.step(Worker{w, workers}.share(23));
      fluid.end_step();
    }
    fluid.settle();
    std::vector<double> f;
    for (int y = 0; y < 23; ++y) {
      for (int x = 0; x < 40; ++x) {
        for (int q = 0; q < 9; ++q) f.push_back(fluid.population(q, x, y));
      }
    }
    return f;
  };
  const auto one = run(1);
  CHECK(run(2) == one);
  CHECK(run(5) == one);
}

TEST_CASE("mass does not drift between walls or in a periodic box") {
  const bool periodic_y = GENERATE(false, true);
  FluidSetting<2> setting{
      .domain = {{32, 16}, {true, periodic_y}}, .relaxation_rate = 0.9, .inertia = true, .walls = {-0.05, 0.05}};
  if (periodic_y) setting.walls = {};
  Fluid<double> fluid(setting, shipped_collision("bgk", {}, 1 / 0.9, true));
  fluid.set_state([](int x, int y) {
    return Fluid<double>::State{1e-3 * (x % 3), {1e-2 * (y % 2), 1e-2 * (x % 5)}, {}};
  });
  fluid.settle();
  const double before = fluid.mass();
  advance(fluid, 2001);
  fluid.settle();
  CHECK(fluid.mass() == Approx(before).margin(1e-13 * 32 * 16));
}

TEMPLATE_TEST_CASE("mass and largest speed are those of the moments, and a value that is no number shows", "", float,
                   double) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  const int nx = 37, ny = 11;
  const FluidSetting<2> setting{
      .domain = {{nx, ny}, {true, false}}, .relaxation_rate = 1.0, .body_force = {1e-3, -2e-3}};
  Fluid<TestType> fluid(setting, trt(1, false));
  const int bad = GENERATE(-1, 0, 20, 36);
  fluid.set_state([&](int x, int y) {
    const double density = x == bad && y == 5 ? std::nan("") : uniform(random);
    return typename Fluid<TestType>::State{density, {uniform(random), uniform(random)}, {}};
  });
  fluid.settle();
  double mass = 0, square = 0;
  std::vector<Moments<2>> row;
  for (int y = 0; y < ny; ++y) {
    fluid.moments(y, row);
    for (const Moments<2>& m : row)
      mass += m.density, square = std::max(square, m.velocity[0] * m.velocity[0] + m.velocity[1] * m.velocity[1]);
  }
  const auto found = fluid.mass_and_speed();
  if (bad >= 0) {
    CHECK(std::isnan(found.mass));
    CHECK(std::isnan(found.speed));
  } else {
    const double rounding = std::numeric_limits<TestType>::epsilon();
    CHECK(found.mass == Approx(mass).margin(nx * ny * 0.01 * rounding));
    CHECK(found.speed == Approx(std::sqrt(square)).epsilon(10 * rounding));
  }
}

TEST_CASE("runs cover every row once and follow the marks, periodic along x") {
  NodeMask mask(Domain<2>({100, 4}, {true, false}));
  mask.mark(1, 90, 105);
  mask.mark(2, -3, 2);
  mask.mark(7, 0, 5);
  int runs_of_first = 0;
  mask.for_spans(0, [&](const MaskSpan&) { ++runs_of_first; });
  CHECK(runs_of_first == 1);
  for (int y = 0; y < 4; ++y) {
    int x = 0;
    bool any = false;
    mask.for_spans(y, [&](const MaskSpan& run) {
      CHECK(run.begin == x);
      if (x > 0) CHECK(run.active != mask.active(x - 1, y));
      x = run.end;
      any = any || run.active;
      for (int i = run.begin; i < run.end; ++i) CHECK(mask.active(i, y) == run.active);
    });
    CHECK(x == 100);
    CHECK(mask.any(y) == any);
  }
  for (int x : {0, 4, 90, 99}) CHECK(mask.active(x, 1));
  CHECK(mask.active(97, 2));
  CHECK(mask.active(1, 2));
  CHECK_FALSE(mask.active(50, 2));
  CHECK_FALSE(mask.active(0, 3));
}
