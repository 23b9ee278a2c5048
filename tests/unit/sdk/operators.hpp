// The shipped collision operators as tests call them: made with any parameters, for one instruction set.
#pragma once

#include <rouleau/collision.hpp>

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "instruction_sets.hpp"
#include "model_setup.hpp"

namespace rouleau::test {

using NamedValues = std::vector<std::pair<std::string, double>>;

struct Operator {
  std::string id;
  bool inertia;
  Self self;
  void (*f64)(const void*, const rouleau_collision_block_f64*);
  void (*f32)(const void*, const rouleau_collision_block_f32*);
};

/// The model of a shipped operator.
const rouleau_model& collision_model(const std::string& id);
/// Rates of mrt and central-moment that differ from one another and from what a test takes for the shear stress.
NamedValues parameters_of(const std::string& id);

Operator make_operator(const std::string& id, const std::string& set, double relaxation_rate, bool inertia,
                       const NamedValues& parameters);

inline constexpr const char* operator_ids[] = {"bgk", "trt", "mrt", "regularised", "central-moment"};

/// Calls test(operator) for all operators, with and without inertia, for each instruction set; 1/tau is 1.25.
template <class Test>
void for_each_operator(Test test) {
  for (const char* id : operator_ids) {
    for (const bool inertia : {false, true}) {
      for (const auto& set : instruction_sets()) {
        CAPTURE(id, inertia, set);
        test(make_operator(id, set, 1.25, inertia, parameters_of(id)));
      }
    }
  }
}

}  // namespace rouleau::test
