// A fluid with a real collision plugin, stepped by one worker.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/fluid/fluid.hpp"
#include "plugin/catalog.hpp"
#include "plugin/handles.hpp"

namespace rouleau::test {

using namespace core;
using namespace plugin;

inline const Catalog& plugins() {
  static const Catalog catalog({ROULEAU_PLUGINS});
  return catalog;
}

/// Collision model in lattice units; `values` in the manifest's order.
inline core::CollisionOperator make_collision(const std::string& id, const std::vector<double>& values, double tau,
                                              bool inertia, int dimension = 2) {
  return make_collision_operator(plugins().find(ModelKind::collision, id, {}), values,
                                 ModelSetting{{1, 1, 1}, 1 / tau, inertia, dimension});
}

template <class T, class Set>
void advance(Fluid<T, Set>& fluid, long steps) {
  for (long i = 0; i < steps; ++i) {
    fluid.step(fluid.rows());
    fluid.end_step();
  }
}

template <class T>
std::vector<Moments<2>> column(Fluid<T>& fluid, int x) {
  fluid.settle();
  std::vector<Moments<2>> result, row;
  for (int y = 0; y < fluid.setting().domain.size[1]; ++y) {
    fluid.moments(y, row);
    result.push_back(row[static_cast<std::size_t>(x)]);
  }
  return result;
}

}  // namespace rouleau::test
