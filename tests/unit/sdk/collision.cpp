// The shipped collision operators: conservation, fixed points, and results that do not depend on how they are computed.
#include <catch2/catch.hpp>
#include <cmath>

#define rouleau_open_v1 open_bgk
#include "collision/bgk/bgk.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_trt
#include "collision/trt/trt.cpp"
#undef rouleau_open_v1

#include "instruction_sets.hpp"
#include "model_setup.hpp"
#include "nodes.hpp"

namespace {

using namespace rouleau::test;
namespace d2q9 = rouleau::d2q9;

constexpr std::size_t node_count = 203;

template <class T, class Model>
auto function_for(const std::string& set) {
  return pick_for<rouleau::detail::CollisionLoop<Model, T>, const void*, const rouleau::detail::CollisionBlock<T>*>(
      set);
}

/// Calls test(self, f64 function, f32 function) for both operators, with and without inertia, for each instruction set.
template <class Test>
void for_each_operator(Test test) {
  for (const bool inertia : {false, true}) {
    for (const auto& set : instruction_sets()) {
      CAPTURE(inertia, set);
      const Self bgk = make(*open_bgk(0)->models[0], {{}, 1.25, inertia});
      test(bgk.get(), function_for<double, Bgk>(set), function_for<float, Bgk>(set), inertia);
      const Self trt = make(*open_trt(0)->models[0], {{{"magic", 0.1875}}, 1.25, inertia});
      test(trt.get(), function_for<double, Trt>(set), function_for<float, Trt>(set), inertia);
    }
  }
}

/// Sum of one node's populations times 1 (k < 0) or component k of their velocities.
template <class T>
double moment(const Nodes<T>& nodes, std::size_t x, int k) {
  double sum = 0;
  for (std::size_t q = 0; q < 9; ++q) {
    sum += (k < 0 ? 1 : d2q9::velocity[q][k]) * static_cast<double>(nodes.f[q][x]);
  }
  return sum;
}

template <class T>
double largest_difference(const Nodes<T>& a, const Nodes<T>& b) {
  double largest = 0;
  for (std::size_t x = 0; x < a.count; ++x) {
    for (std::size_t q = 0; q < 9; ++q) {
      largest = std::max(largest, std::abs(static_cast<double>(a.f[q][x]) - static_cast<double>(b.f[q][x])));
    }
    for (std::size_t k = 0; k < 2; ++k) {
      largest =
          std::max(largest, std::abs(static_cast<double>(a.velocity[k][x]) - static_cast<double>(b.velocity[k][x])));
    }
  }
  return largest;
}

template <class T>
bool same_bits(const Nodes<T>& a, const Nodes<T>& b) {
  return a.f == b.f && a.velocity == b.velocity;
}

// Populations are about 0.01; a collision adds about thirty such terms, each rounded once, with factors of order one.
constexpr double rounding = 32 * 0.02 * 2.3e-16;

unsigned new_seed() { return std::random_device{}(); }

}  // namespace

TEST_CASE("a collision conserves mass and adds the force to the momentum") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  for_each_operator([&](const void* self, auto f64, auto, bool) {
    const auto forced = collide(f64, self, before);
    const auto free = collide(f64, self, before, {.forced = false});
    for (std::size_t x = 0; x < node_count; ++x) {
      REQUIRE(std::abs(moment(forced, x, -1) - moment(before, x, -1)) < 9 * rounding);
      REQUIRE(std::abs(moment(free, x, -1) - moment(before, x, -1)) < 9 * rounding);
      for (int k = 0; k < 2; ++k) {
        const double force = before.force[static_cast<std::size_t>(k)][x];
        REQUIRE(std::abs(moment(forced, x, k) - moment(before, x, k) - force) < 9 * rounding);
        REQUIRE(std::abs(moment(free, x, k) - moment(before, x, k)) < 9 * rounding);
      }
    }
  });
}

TEST_CASE("the velocity that a collision writes is the momentum before it plus half of the force") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  for_each_operator([&](const void* self, auto f64, auto, bool) {
    const auto forced = collide(f64, self, before);
    const auto free = collide(f64, self, before, {.forced = false});
    for (std::size_t x = 0; x < node_count; ++x) {
      for (std::size_t k = 0; k < 2; ++k) {
        const double momentum = moment(before, x, static_cast<int>(k));
        REQUIRE(std::abs(forced.velocity[k][x] - momentum - 0.5 * before.force[k][x]) < rounding);
        REQUIRE(std::abs(free.velocity[k][x] - momentum) < rounding);
      }
    }
  });
}

TEST_CASE("equilibrium is a fixed point") {
  for_each_operator([&](const void* self, auto f64, auto, bool inertia) {
    auto equilibrium = Nodes<double>::random(node_count, 1);
    for (std::size_t x = 0; x < node_count; ++x) {
      const double s = static_cast<double>(x) / node_count, density = 0.01 * std::sin(7 * s);
      const double u = 0.05 * std::cos(5 * s), v = 0.05 * std::sin(3 * s);
      for (std::size_t q = 0; q < 9; ++q) {
        const double along = d2q9::velocity[q][0] * u + d2q9::velocity[q][1] * v;
        const double quadratic = inertia ? 4.5 * along * along - 1.5 * (u * u + v * v) : 0;
        equilibrium.f[q][x] = d2q9::weight[q] * (density + 3 * along + quadratic);
      }
    }
    auto after = collide(f64, self, equilibrium, {.forced = false});
    after.velocity = equilibrium.velocity;
    CHECK(largest_difference(after, equilibrium) < rounding);
  });
}

TEST_CASE("two relaxation times that are equal give the single relaxation time") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  const double rate = 1.25, half = 1 / rate - 0.5;
  for (const bool inertia : {false, true}) {
    for (const auto& set : instruction_sets()) {
      CAPTURE(inertia, set);
      const Self bgk = make(*open_bgk(0)->models[0], {{}, rate, inertia});
      const Self trt = make(*open_trt(0)->models[0], {{{"magic", half * half}}, rate, inertia});
      const Collide how{.own_rates = false};
      const auto one = collide(function_for<double, Bgk>(set), bgk.get(), before, how);
      const auto two = collide(function_for<double, Trt>(set), trt.get(), before, how);
      CHECK(largest_difference(one, two) < rounding);
    }
  }
}

TEST_CASE("a force of zero gives what no force gives, and the setup's rate what an array of it gives") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  auto before = Nodes<double>::random(node_count, seed);
  for (std::size_t x = 0; x < node_count; ++x) {
    before.force[0][x] = before.force[1][x] = 0;
    before.rate[x] = 1.25;
  }
  for_each_operator([&](const void* self, auto f64, auto, bool) {
    const auto zero = collide(f64, self, before);
    CHECK(largest_difference(zero, collide(f64, self, before, {.forced = false})) < rounding);
    CHECK(largest_difference(zero, collide(f64, self, before, {.own_rates = false})) < rounding);
  });
}

TEST_CASE("single precision agrees with double precision") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto narrow = Nodes<float>::random(node_count, seed);
  const auto wide = narrow.as<double>();
  for_each_operator([&](const void* self, auto f64, auto f32, bool) {
    const auto exact = collide(f64, self, wide).template as<float>();
    auto rounded = collide(f32, self, narrow);
    rounded.velocity = exact.velocity;
    // The same bound as above with the epsilon of float.
    CHECK(largest_difference(rounded, exact) < rounding / 2.3e-16 * 1.2e-7);
  });
}

TEST_CASE("a collision gives the same bits for any size of block, in place or not, over the force or not") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  const auto narrow = Nodes<float>::random(node_count, seed);
  for_each_operator([&](const void* self, auto f64, auto f32, bool) {
    for (const bool forced : {false, true}) {
      const auto whole = collide(f64, self, before, {.forced = forced});
      const auto whole_narrow = collide(f32, self, narrow, {.forced = forced});
      for (std::size_t size = 1; size <= 37; ++size) {
        CAPTURE(forced, size);
        REQUIRE(same_bits(collide(f64, self, before, {.forced = forced, .block = size}), whole));
        REQUIRE(same_bits(collide(f64, self, before, {.forced = forced, .in_place = true, .block = size}), whole));
        REQUIRE(same_bits(collide(f64, self, before,
                                  {.forced = forced, .in_place = true, .velocity_over_force = true, .block = size}),
                          whole));
        REQUIRE(same_bits(collide(f32, self, narrow, {.forced = forced, .block = size}), whole_narrow));
      }
    }
  });
}

TEST_CASE("all instruction sets give the same collision but for rounding") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  const Self trt = make(*open_trt(0)->models[0], {{{"magic", 0.25}}, 1, true});
  const auto baseline = collide(function_for<double, Trt>("baseline"), trt.get(), before);
  for (const auto& set : instruction_sets()) {
    CAPTURE(set);
    CHECK(largest_difference(collide(function_for<double, Trt>(set), trt.get(), before), baseline) < rounding);
  }
}

TEST_CASE("an operator for D2Q9 refuses another lattice, and a missing parameter is named") {
  void* self = nullptr;
  Setup cube;
  cube.dimension = 3;
  const auto [code, error] = create(*open_bgk(0)->models[0], cube, &self);
  CHECK(code != 0);
  CHECK(error == "this operator is written for D2Q9");
  const auto [missing, text] = create(*open_trt(0)->models[0], {}, &self);
  CHECK(missing != 0);
  CHECK_THAT(text, Catch::Matchers::Contains("magic"));
}
