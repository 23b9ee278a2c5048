// A shipped collision operator of which a test holds the source, to reach its loops for each instruction set. Each has
// a file of its own in this folder: the loops are most of what there is to compile.
#pragma once

#include "unit/sdk/operators.hpp"

namespace rouleau::test {

struct OperatorSource {
  const char* id;
  const rouleau_plugin* (*open)(std::uint32_t);
  Operator (*with_loops)(Self, const std::string&, const std::string&, bool);
  NamedValues parameters;
};

OperatorSource bgk();
OperatorSource central_moment();
OperatorSource mrt();
OperatorSource regularised();
OperatorSource trt();

template <class Model>
Operator with_loops(Self self, const std::string& id, const std::string& set, bool inertia) {
  return {id, inertia, std::move(self),
          pick_for<detail::CollisionLoop<Model, double>, const void*, const rouleau_collision_block_f64*>(set),
          pick_for<detail::CollisionLoop<Model, float>, const void*, const rouleau_collision_block_f32*>(set)};
}

}  // namespace rouleau::test
