// The shipped collision operators: conservation, fixed points, and results that do not depend on how they are computed.
#include <catch2/catch.hpp>
#include <cmath>

#include "nodes.hpp"
#include "operators.hpp"

namespace {

using namespace rouleau::test;
namespace d2q9 = rouleau::d2q9;

constexpr std::size_t node_count = 203;

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

/// By what part of it the momentum that odd_gain() gives differs from the one it should give, on the mean over nodes
/// whose momentum has one sign.
template <class Set, bool Forced>
double mean_gain_error(float rate, unsigned seed) {
  using S = rouleau::Pack<float, 1>;
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> with(0.01F, 0.02F), against(0, 0.005F), force(1e-4F, 1e-3F);
  constexpr int nodes = 20'000;
  double sum = 0;
  for (int i = 0; i < nodes; ++i) {
    rouleau::Node<Set, S, Forced, false> node;
    Set::for_each_velocity([&](auto q) { node.f[q] = Set::velocity[q][0] > 0 ? with(engine) : against(engine); });
    for (S& component : node.force) component = force(engine);
    node.compute_moments();
    double gained = 0, due = static_cast<double>(rate) * node.momentum[0].vector[0];
    if (Forced) due += node.force[0].vector[0];
    Set::for_each_pair([&](auto q) { gained += 2.0 * Set::velocity[q][0] * node.odd_gain(q, S(rate)).vector[0]; });
    sum += gained / due - 1;
  }
  return sum / nodes;
}

}  // namespace

TEST_CASE("a collision conserves mass and adds the force to the momentum") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  for_each_operator([&](const Operator& op) {
    const auto forced = collide(op.f64, op.self.get(), before);
    const auto free = collide(op.f64, op.self.get(), before, {.forced = false});
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

TEST_CASE("rounding to single precision does not make momentum grow or decay") {
  // What is gained of the momentum in each step changes the stress on a channel's walls by rows^2 / (12 viscosity) of
  // it: 8e-9 by 7e-5 at 128 rows. With 1/3 and 1/12 each rounded on its own it is 2.5e-8 to 5e-8, and now at most 4e-9.
  const unsigned seed = new_seed();
  const float rate = GENERATE(0.6F, 8.0F / 9, 1.0F, 8.0F / 7, 1.6F);
  CAPTURE(seed, rate);
  CHECK(std::abs(mean_gain_error<rouleau::D2Q9, false>(rate, seed)) < 8e-9);
  CHECK(std::abs(mean_gain_error<rouleau::D2Q9, true>(rate, seed)) < 8e-9);
  CHECK(std::abs(mean_gain_error<rouleau::D3Q19, false>(rate, seed)) < 8e-9);
  CHECK(std::abs(mean_gain_error<rouleau::D3Q19, true>(rate, seed)) < 8e-9);
}

TEST_CASE("the velocity that a collision writes is the momentum before it plus half of the force") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  for_each_operator([&](const Operator& op) {
    const auto forced = collide(op.f64, op.self.get(), before);
    const auto free = collide(op.f64, op.self.get(), before, {.forced = false});
    for (std::size_t x = 0; x < node_count; ++x) {
      for (std::size_t k = 0; k < 2; ++k) {
        const double momentum = moment(before, x, static_cast<int>(k));
        REQUIRE(std::abs(forced.velocity[k][x] - momentum - 0.5 * before.force[k][x]) < rounding);
        REQUIRE(std::abs(free.velocity[k][x] - momentum) < rounding);
      }
    }
  });
}

TEST_CASE("a force of zero gives what no force gives, and the setup's rate what an array of it gives") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  auto before = Nodes<double>::random(node_count, seed);
  for (std::size_t x = 0; x < node_count; ++x) {
    before.force[0][x] = before.force[1][x] = 0;
    before.rate[x] = 1.25;
  }
  for_each_operator([&](const Operator& op) {
    const auto zero = collide(op.f64, op.self.get(), before);
    CHECK(largest_difference(zero, collide(op.f64, op.self.get(), before, {.forced = false})) < rounding);
    CHECK(largest_difference(zero, collide(op.f64, op.self.get(), before, {.own_rates = false})) < rounding);
  });
}

TEST_CASE("single precision agrees with double precision") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto narrow = Nodes<float>::random(node_count, seed);
  const auto wide = narrow.as<double>();
  for_each_operator([&](const Operator& op) {
    const auto exact = collide(op.f64, op.self.get(), wide).as<float>();
    auto rounded = collide(op.f32, op.self.get(), narrow);
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
  for_each_operator([&](const Operator& op) {
    for (const bool forced : {false, true}) {
      const auto whole = collide(op.f64, op.self.get(), before, {.forced = forced});
      const auto whole_narrow = collide(op.f32, op.self.get(), narrow, {.forced = forced});
      for (std::size_t size = 1; size <= 37; ++size) {
        CAPTURE(forced, size);
        for (const Place place : {Place::apart, Place::same, Place::opposite}) {
          REQUIRE(same_bits(collide(op.f64, op.self.get(), before, {.forced = forced, .place = place, .block = size}),
                            whole));
          REQUIRE(same_bits(collide(op.f64, op.self.get(), before,
                                    {.forced = forced, .place = place, .velocity_over_force = true, .block = size}),
                            whole));
          REQUIRE(same_bits(collide(op.f32, op.self.get(), narrow, {.forced = forced, .place = place, .block = size}),
                            whole_narrow));
        }
      }
    }
  });
}

TEST_CASE("all instruction sets give the same collision but for rounding") {
  const unsigned seed = new_seed();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  for (const char* id : operator_ids) {
    const Operator baseline = make_operator(id, "baseline", 1, true, parameters_of(id));
    const auto expected = collide(baseline.f64, baseline.self.get(), before);
    for (const auto& set : instruction_sets()) {
      CAPTURE(id, set);
      const Operator op = make_operator(id, set, 1, true, parameters_of(id));
      CHECK(largest_difference(collide(op.f64, op.self.get(), before), expected) < rounding);
    }
  }
}

TEST_CASE("an operator refuses a lattice that it is not written for, a missing parameter, and a rate beside magic") {
  void* self = nullptr;
  Setup neither;  // nine velocities in space
  neither.dimension = 3;
  for (const char* id : operator_ids) {
    const auto [code, error] = create(collision_model(id), neither, &self);
    CHECK(code != 0);
    CHECK(error == "this operator is written for D2Q9 and D3Q19");
  }
  const auto [missing, text] = create(collision_model("trt"), {}, &self);
  CHECK(missing != 0);
  CHECK_THAT(text, Catch::Matchers::Contains("magic"));
  for (const auto& [id, rate] : {std::pair{"mrt", "heat_flux_rate"}, std::pair{"central-moment", "third_order_rate"}}) {
    NamedValues both = parameters_of(id);
    for (auto& [name, value] : both) {
      if (name == rate) value = 1.9;
    }
    const auto [refused, why] = create(collision_model(id), {both, 1, false}, &self);
    CHECK(refused != 0);
    CHECK_THAT(why, Catch::Matchers::Contains(rate) && Catch::Matchers::Contains("magic"));
  }
}
