// A fluid stepped by one worker.
#pragma once

#include <vector>

#include "core/fluid/fluid.hpp"

namespace rouleau::test {

template <class T, class Set>
void advance(core::Fluid<T, Set>& fluid, long steps) {
  for (long i = 0; i < steps; ++i) {
    fluid.step(fluid.rows());
    fluid.end_step();
  }
}

template <class T>
std::vector<core::Moments<2>> column(core::Fluid<T>& fluid, int x) {
  fluid.settle();
  std::vector<core::Moments<2>> result, row;
  for (int y = 0; y < fluid.setting().domain.size[1]; ++y) {
    fluid.moments(y, row);
    result.push_back(row[static_cast<std::size_t>(x)]);
  }
  return result;
}

}  // namespace rouleau::test
