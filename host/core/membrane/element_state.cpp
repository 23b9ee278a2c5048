#include "element_state.hpp"

#include <algorithm>

namespace rouleau::membrane {

std::size_t keep_state(std::vector<ElementState>& states, ElementState variable, double initial, std::size_t count) {
  const auto found = std::find_if(states.begin(), states.end(), [&](const ElementState& other) {
    return other.cell_type == variable.cell_type && other.law == variable.law && other.model == variable.model &&
           other.name == variable.name;
  });
  if (found != states.end()) return static_cast<std::size_t>(found - states.begin());
  variable.value.assign(count, initial);
  states.push_back(std::move(variable));
  return states.size() - 1;
}

const ElementState* find_state(const std::vector<ElementState>& states, int cell_type, const std::string& name) {
  const auto found = std::find_if(states.begin(), states.end(), [&](const ElementState& state) {
    return state.cell_type == cell_type && state.name == name;
  });
  return found != states.end() ? &*found : nullptr;
}

void change_units(std::vector<ElementState>& states, const units::LatticeUnits& from, const units::LatticeUnits& to) {
  for (ElementState& state : states) {
    const double ratio = from.unit(state.dimension) / to.unit(state.dimension);
    for (double& value : state.value) value *= ratio;
  }
}

void change_units(ContactMemory& memory, const units::LatticeUnits& from, const units::LatticeUnits& to) {
  const auto ratio = [&](const ContactVariable& variable) {
    return from.unit(variable.dimension) / to.unit(variable.dimension);
  };
  for (std::vector<ContactState>& states : memory.of_cell) {
    for (ContactState& state : states) {
      for (double& value : state.value) value *= ratio(memory.variables[state.variable]);
    }
  }
  for (ContactVariable& variable : memory.variables) variable.initial *= ratio(variable);
}

}  // namespace rouleau::membrane
