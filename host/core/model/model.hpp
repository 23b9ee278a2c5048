// Models as the core takes them: a table of C functions, an instance, and what it reads, writes and remembers.
#pragma once

#include <rouleau/plugin.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/foreign_call.hpp"

namespace rouleau::core {

/// What a model remembers of each element from step to step.
struct StateVariable {
  std::string name;
  /// Lattice units: of an element that is new.
  double initial = 0;
  /// SI size of the lattice unit of the values. A stage with another time step goes on with the same state in other
  /// numbers; 1 where units never change.
  double unit = 1;
};

/// A model, compiled in or from a shared library. Copies share the instance, which many threads may use at once.
template <class Table>
struct Model {
  /// For messages, and to find state again.
  std::string id;
  /// The functions; must outlive the model.
  const Table* table = nullptr;
  /// Given to every function as `self`; destroyed with the last copy. May be null.
  std::shared_ptr<const void> self;
  /// Names of its inputs and outputs as in plugin.h ("stretch", "tension").
  std::vector<std::string> needs, gives;
  std::vector<StateVariable> state;

  /// Calls the table's function of that name, of membrane laws and potentials. Throws ForeignException when it
  /// throws, which it must not.
  template <class Block>
  void compute(Block* block) const {
    call_foreign(id, "compute", [&] { table->compute(self.get(), block); });
  }
  [[nodiscard]] bool reads(std::string_view input) const {
    return std::find(needs.begin(), needs.end(), input) != needs.end();
  }
  [[nodiscard]] bool writes(std::string_view output) const {
    return std::find(gives.begin(), gives.end(), output) != gives.end();
  }
};

using CollisionOperator = Model<rouleau_collision>;
using MembraneLaw = Model<rouleau_membrane>;
using Potential = Model<rouleau_interaction>;

}  // namespace rouleau::core
