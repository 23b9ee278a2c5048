#include "element_state.hpp"

#include <algorithm>

namespace rouleau::core {

std::size_t keep_state(std::vector<ElementState>& states, ElementState variable, double initial, std::size_t count) {
  const auto found = std::find_if(states.begin(), states.end(), [&](const ElementState& other) {
    return other.cell_type == variable.cell_type && other.law == variable.law && other.model == variable.model &&
           other.name == variable.name;
  });
  if (found != states.end()) {
    if (found->unit != variable.unit) {
      const double ratio = found->unit / variable.unit;
      for (double& value : found->value) value *= ratio;
      found->unit = variable.unit;
    }
    found->initial = initial;
    return static_cast<std::size_t>(found - states.begin());
  }
  variable.value.assign(count, initial);
  variable.initial = initial;
  states.push_back(std::move(variable));
  return states.size() - 1;
}

std::size_t ContactMemory::keep(const ContactVariable& wanted) {
  const auto found = std::find_if(variables.begin(), variables.end(), [&](const ContactVariable& v) {
    return v.potential == wanted.potential && v.name == wanted.name;
  });
  const auto variable = static_cast<std::size_t>(found - variables.begin());
  if (found == variables.end())
    variables.push_back(wanted);
  else
    change_unit(variable, wanted.unit);
  return variable;
}

void ContactMemory::change_unit(std::size_t variable, double unit) {
  ContactVariable& changed = variables[variable];
  if (changed.unit == unit) return;
  const double ratio = changed.unit / unit;
  changed.unit = unit;
  changed.initial *= ratio;
  for (std::vector<ContactState>& states : of_cell) {
    for (ContactState& state : states) {
      if (state.variable != variable) continue;
      for (double& value : state.value) value *= ratio;
    }
  }
}

}  // namespace rouleau::core
