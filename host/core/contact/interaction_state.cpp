// Interactions that remember: where a contact's state is found, and how it is stepped.
#include <algorithm>

#include "interaction_forces.hpp"

namespace rouleau::core {

// A node's value is found by the other cell and its image, for the closest place moves along that cell as it likes.
void InteractionForces::apply_with_state(std::size_t potential, int cell, std::size_t pair, const Membranes& membranes,
                                         double* result, bool energy, NextState* next, Scratch& scratch) const {
  const ContactList& list = scratch.contacts;
  const NeighbourList::Pair& other = contacts_.neighbours().list(cell).pairs[pair];
  const CellRange& own = membranes.cells[cell];
  const ContactMemory& memory = membranes.contacts;
  std::size_t count = 0;
  for (int i = list.ranges[pair].begin; i < list.ranges[pair].end; ++i) {
    const double distance = list.distance[i];
    if (distance > cutoffs_[potential]) continue;
    scratch.distance[count] = distance;
    scratch.contact[count++] = i;
  }
  if (count == 0) return;
  const auto node = [&](std::size_t k) { return static_cast<std::size_t>(list.node[scratch.contact[k]] - own.first); };
  const std::vector<std::size_t>& variables = variables_[potential];
  const std::vector<ContactState>& known = memory.of_cell[cell];
  const auto find = [&](std::size_t variable, std::size_t from) {
    const auto found = std::find_if(known.begin() + static_cast<std::ptrdiff_t>(from), known.end(), [&](const auto& s) {
      return s.variable == variable && s.other == other.other && s.shift == other.shift;
    });
    return static_cast<std::size_t>(found - known.begin());
  };
  scratch.state.resize(count * variables.size());
  std::vector<const double*> state;
  std::vector<double*> new_state;
  for (std::size_t v = 0; v < variables.size(); ++v) {
    double* values = scratch.state.data() + v * count;
    const std::size_t at = find(variables[v], 0);
    for (std::size_t k = 0; k < count; ++k) {
      values[k] = at < known.size() ? known[at].value[node(k)] : memory.variables[variables[v]].initial;
    }
    state.push_back(values);
    new_state.push_back(values);
  }
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(count);
  block.time_step = next != nullptr ? 1 : 0;
  block.distance = scratch.distance.data();
  give_velocities(potential, 0, static_cast<int>(count), false, scratch, block);
  (energy ? block.energy : block.force) = scratch.law.data();
  block.state = state.data();
  if (next != nullptr) block.new_state = new_state.data();
  const Potential& model = interactions_[potential].potential;
  model.compute(&block);
  for (std::size_t k = 0; k < count; ++k) result[scratch.contact[k]] += scratch.law[k];
  if (next == nullptr) return;

  for (std::size_t v = 0; v < variables.size(); ++v) {
    scratch.fresh.assign(static_cast<std::size_t>(own.count), memory.variables[variables[v]].initial);
    for (std::size_t k = 0; k < count; ++k) scratch.fresh[node(k)] = new_state[v][k];
    const std::size_t at = find(variables[v], next->kept);
    if (at == next->states.size()) next->states.push_back({variables[v], other.other, other.shift, {}});
    next->states[at].value.swap(scratch.fresh);
    std::swap(next->states[at], next->states[next->kept++]);
  }
}

}  // namespace rouleau::core
