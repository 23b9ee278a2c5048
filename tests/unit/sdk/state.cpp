// Models with state: blocks of any size, state in place or apart, steps of length zero.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#define rouleau_open_v1 open_standard_linear_solid
#include "membrane/standard-linear-solid/standard-linear-solid.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_bridging
#include "interaction/bridging/bridging.cpp"
#undef rouleau_open_v1

#include "instruction_sets.hpp"
#include "model_setup.hpp"

namespace {

using namespace rouleau::test;

struct Elements {
  std::vector<double> stretch, rate, dashpot, tension;
};

Elements some(std::size_t count) {
  Elements e;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i);
    e.stretch.push_back(1 + 0.2 * std::sin(x));
    e.rate.push_back(0.01 * std::cos(3 * x));
    e.dashpot.push_back(1 + 0.1 * std::sin(5 * x));
  }
  e.tension.assign(count, 0);
  return e;
}

/// One step of all elements in blocks of at most `size`; `apart`: the new state goes to other memory than the old.
template <class Function>
void step(Function function, const void* self, Elements& e, std::size_t size, double time_step, bool apart = false) {
  std::vector<double> other(e.dashpot.size(), -7);
  for (std::size_t first = 0; first < e.stretch.size(); first += size) {
    const double* state[] = {e.dashpot.data() + first};
    double* new_state[] = {(apart ? other.data() : e.dashpot.data()) + first};
    rouleau_membrane_block block{};
    block.struct_size = sizeof block;
    block.count = static_cast<std::uint32_t>(std::min(size, e.stretch.size() - first));
    block.time_step = time_step;
    block.stretch = e.stretch.data() + first;
    block.stretch_rate = e.rate.data() + first;
    block.tension = e.tension.data() + first;
    block.state = state;
    block.new_state = new_state;
    function(self, &block);
  }
  if (apart) e.dashpot = other;
}

Self solid() { return make(*open_standard_linear_solid(0)->models[0], {{{"modulus", 0.7}, {"relaxation_time", 4}}}); }

using Loop = rouleau::detail::MembraneLoop<StandardLinearSolid>;

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("state is the same to the last bit for any size of block, in place or apart") {
  const Self self = solid();
  for (const auto& set : instruction_sets()) {
    const auto function = pick_for<Loop, const void*, const rouleau_membrane_block*>(set);
    Elements whole = some(61);
    for (int k = 0; k < 3; ++k) step(function, self.get(), whole, 100, 1);
    for (std::size_t size = 1; size <= 19; ++size) {
      for (const bool apart : {false, true}) {
        CAPTURE(set, size, apart);
        Elements cut = some(61);
        for (int k = 0; k < 3; ++k) step(function, self.get(), cut, size, 1, apart);
        REQUIRE(same_bits(cut.dashpot, whole.dashpot));
        REQUIRE(same_bits(cut.tension, whole.tension));
      }
    }
  }
}

TEST_CASE("a Maxwell branch follows its differential equation exactly while the stretch changes evenly") {
  const Self self = solid();
  const auto function = pick_for<Loop, const void*, const rouleau_membrane_block*>("baseline");
  // Many small steps and one large one end at the same state, which is that of the closed solution.
  for (const double dt : {0.5, 8.0}) {
    Elements e = some(20);
    const Elements start = e;
    for (std::size_t i = 0; i < e.stretch.size(); ++i) e.rate[i] = 0.01 * std::cos(static_cast<double>(i));
    for (double t = dt; t <= 8; t += dt) {
      for (std::size_t i = 0; i < e.stretch.size(); ++i) e.stretch[i] = start.stretch[i] + e.rate[i] * t;
      step(function, self.get(), e, 20, dt);
    }
    for (std::size_t i = 0; i < e.stretch.size(); ++i) {
      const double strain =
          (start.stretch[i] - start.dashpot[i]) * std::exp(-8 / 4.0) + e.rate[i] * 4 * (1 - std::exp(-8 / 4.0));
      REQUIRE(e.tension[i] == Approx(0.7 * strain).margin(1e-15));
      REQUIRE(e.dashpot[i] == Approx(e.stretch[i] - strain));
    }
  }
}

TEST_CASE("a step of length zero gives the tension of the present state and leaves the state as it is") {
  const Self self = solid();
  for (const auto& set : instruction_sets()) {
    const auto function = pick_for<Loop, const void*, const rouleau_membrane_block*>(set);
    Elements e = some(13);
    step(function, self.get(), e, 13, 1);
    const Elements after = e;
    step(function, self.get(), e, 13, 0);
    for (std::size_t i = 0; i < e.stretch.size(); ++i) {
      REQUIRE(e.dashpot[i] == Approx(after.dashpot[i]).epsilon(1e-15));
      REQUIRE(e.tension[i] == Approx(after.tension[i]).margin(1e-15));
    }
  }
}

TEST_CASE("the force of bonds is minus the derivative of their energy at a given density, and its derivative its own") {
  const Self self = make(*open_bridging(0)->models[0], {{{"site_density", 1},
                                                         {"bond_stiffness", 0.3},
                                                         {"zero_force_distance", 2.5},
                                                         {"on_rate", 0.1},
                                                         {"off_rate", 0.2},
                                                         {"transition_share", 0.5},
                                                         {"thermal_energy", 0.8},
                                                         {"cutoff", 30}}});
  for (const auto& set : instruction_sets()) {
    const auto function =
        pick_for<rouleau::detail::InteractionLoop<Bridging>, const void*, const rouleau_interaction_block*>(set);
    constexpr double h = 1e-5;
    for (const double r : {0.4, 1.0, 2.5, 3.7, 12.0, 29.0}) {  // at 29 the breaking rate is far beyond its bound
      const double distance[3] = {r - h, r, r + h};
      double bonds[3] = {0.6, 0.6, 0.6}, energy[3], force[3], slope[3];
      const double* state[] = {bonds};
      double* new_state[] = {bonds};
      rouleau_interaction_block block{};
      block.struct_size = sizeof block;
      block.count = 3;
      block.distance = distance;
      block.energy = energy, block.force = force, block.force_by_distance = slope;
      block.state = state, block.new_state = new_state;
      function(self.get(), &block);
      CAPTURE(set, r);
      for (const double n : bonds) CHECK(n == Approx(0.6).epsilon(1e-15));
      CHECK(force[1] == Approx((energy[0] - energy[2]) / (2 * h)).epsilon(1e-8).margin(1e-8));
      CHECK(slope[1] == Approx((force[2] - force[0]) / (2 * h)).epsilon(1e-8));
    }
  }
}
