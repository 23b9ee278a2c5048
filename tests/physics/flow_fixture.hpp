// Collision plugins as they are installed, for a fluid that one worker steps.
#pragma once

#include <string>
#include <vector>

#include "plugin/catalog.hpp"
#include "plugin/model.hpp"
#include "unit/flow_fixture.hpp"

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

}  // namespace rouleau::test
