// Runs a test once for each instruction set that this processor has.
#pragma once

#include <cstdlib>
#include <rouleau/dispatch.hpp>
#include <string>
#include <vector>

namespace rouleau::test {

/// Names for ROULEAU_INSTRUCTION_SET that this processor can follow.
inline std::vector<std::string> instruction_sets() {
  unsetenv("ROULEAU_INSTRUCTION_SET");
  std::vector<std::string> names = {"baseline"};
  if (instruction_set() != InstructionSet::baseline) names.emplace_back("avx2");
  if (instruction_set() == InstructionSet::avx512) names.emplace_back("avx512");
  return names;
}

/// The function that Dispatch picks when the environment asks for one set.
template <class Loop, class... Arguments>
auto pick_for(const std::string& set) {
  setenv("ROULEAU_INSTRUCTION_SET", set.c_str(), 1);
  const auto function = Dispatch<Loop, Arguments...>::pick();
  unsetenv("ROULEAU_INSTRUCTION_SET");
  return function;
}

}  // namespace rouleau::test
