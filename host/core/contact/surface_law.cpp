#include "surface_law.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "distance_law.hpp"

namespace rouleau::core {

namespace {

/// Index of a contact's values in a list of states; `hint` is looked at first. The list's size: there are none.
std::size_t find(const std::vector<ContactState>& states, std::size_t variable, const SurfaceLawInputs::Key& key,
                 std::size_t hint) {
  const auto is = [&](const ContactState& state) {
    return state.variable == variable && state.other == key.other && state.shift == key.shift;
  };
  if (hint < states.size() && is(states[hint])) return hint;
  return static_cast<std::size_t>(std::find_if(states.begin(), states.end(), is) - states.begin());
}

}  // namespace

SurfaceLaw::SurfaceLaw(Potential potential, std::size_t place, ContactMemory& memory, std::size_t cells)
    : potential_(std::move(potential)),
      cutoff_(cutoff_of(potential_)),
      reads_normal_velocity_(potential_.reads("normal_velocity")),
      reads_sliding_speed_(potential_.reads("sliding_speed")),
      has_energy_(potential_.writes("energy")) {
  if (potential_.reads("tangential_velocity"))
    throw std::invalid_argument("\"" + potential_.id + "\" reads a tangential velocity, which has no sign on surfaces");
  for (const std::size_t kept : keep_state(potential_, place, memory, cells))
    variables_.push_back({kept, memory.variables[kept].initial});
}

void SurfaceLaw::evaluate(const CellRange& cell, const std::vector<ContactState>& known, const SurfaceLawInputs& inputs,
                          bool energy, std::vector<ContactState>* next, std::vector<double>& law) const {
  const std::size_t count = inputs.distance.size();
  law.resize(count);
  std::vector<double> values(variables_.size() * count);
  std::vector<const double*> state;
  std::vector<double*> new_state;
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    double* const of_variable = values.data() + v * count;
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      at = find(known, variables_[v].place, inputs.key[i], at);
      of_variable[i] = at < known.size() ? known[at].value[inputs.key[i].node] : variables_[v].initial;
    }
    state.push_back(of_variable);
    new_state.push_back(of_variable);
  }
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(count);
  block.time_step = remembers() && next == nullptr ? 0 : 1;
  block.distance = inputs.distance.data();
  if (reads_normal_velocity_) block.normal_velocity = inputs.normal_velocity.data();
  if (reads_sliding_speed_) block.sliding_speed = inputs.sliding_speed.data();
  (energy ? block.energy : block.force) = law.data();
  if (remembers()) block.state = state.data();
  if (remembers() && next != nullptr) block.new_state = new_state.data();
  potential_.compute(&block);
  if (next == nullptr) return;
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    const auto& [variable, initial] = variables_[v];
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const SurfaceLawInputs::Key& key = inputs.key[i];
      at = find(*next, variable, key, at);
      if (at == next->size())
        next->push_back({variable, key.other, key.shift, std::vector<double>(cell.count, initial)});
      (*next)[at].value[key.node] = new_state[v][i];
    }
  }
}

}  // namespace rouleau::core
