// Random numbers that a failing test can have again.
#pragma once

#include <iostream>
#include <random>

namespace rouleau::test {

/// Seed of a test's random numbers, shown when the test fails.
inline std::mt19937 generator(unsigned seed) {
  std::cout << "seed " << seed << '\n';
  return std::mt19937(seed);
}

}  // namespace rouleau::test
