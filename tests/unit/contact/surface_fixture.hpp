// What tests of contacts between and within surfaces do to them.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/contact/interactions.hpp"

namespace rouleau::test {

/// The interactions alone, a phase at a time, each by all workers, as barriers would have it.
inline void run(core::Interactions<3>& forces, core::Surfaces& s, int workers = 1) {
  for (auto& force : s.force) std::fill(force.begin(), force.end(), 0.0);
  for (int phase = 0; phase < 3; ++phase) {
    for (int worker = 0; worker < workers; ++worker) forces.run({worker, workers}, phase, s);
  }
}

/// Forces of run() on 40 nodes against differences of the energy, to 1e-7 of the `largest` force.
inline void check_gradient(core::Interactions<3>& forces, core::Surfaces& s, double largest, std::mt19937& random) {
  run(forces, s);
  const core::Surfaces at = s;
  const auto& found = at.force;
  auto& places = s.position;
  std::uniform_int_distribution<int> node(0, s.node_count() - 1);
  for (int check = 0; check < 40; ++check) {
    const int i = node(random);
    constexpr double h = 1e-5;
    for (int k = 0; k < 3; ++k) {
      const double here = places[k][i];
      double energy[2];
      for (int side = 0; side < 2; ++side) {
        places[k][i] = here + (side == 0 ? -h : h);
        run(forces, s);
        energy[side] = forces.energy(s);
      }
      places[k][i] = here;
      CHECK(std::abs(-(energy[1] - energy[0]) / (2 * h) - found[k][i]) < 1e-7 * largest);
    }
  }
}

}  // namespace rouleau::test
