#include "contact_law.hpp"

#include <algorithm>
#include <cstdint>

namespace rouleau::core {

namespace {

/// Index of a contact's values in a list of states; `hint` is looked at first. The list's size: there are none.
/// A node's value is found by the other cell and its image, for the closest place moves along that cell as it likes.
std::size_t find(const std::vector<ContactState>& states, std::size_t variable, const ContactKey& key,
                 std::size_t hint) {
  const auto is = [&](const ContactState& state) {
    return state.variable == variable && state.other == key.other && state.shift == key.shift;
  };
  if (hint < states.size() && is(states[hint])) return hint;
  return static_cast<std::size_t>(std::find_if(states.begin(), states.end(), is) - states.begin());
}

}  // namespace

double cutoff_of(const Potential& potential) {
  return call_foreign(potential.id, "cutoff", [&] { return potential.table->cutoff(potential.self.get()); });
}

bool reads_sliding(const Potential& potential) {
  return potential.reads("tangential_velocity") || potential.reads("sliding_speed");
}

const std::vector<ContactState>& states_of(const ContactMemory& memory, int cell) {
  static const std::vector<ContactState> none;
  return memory.of_cell.empty() ? none : memory.of_cell[cell];
}

void ContactValues::clear() {
  for (auto* values : {&distance, &normal_velocity, &tangential_velocity, &sliding_speed}) values->clear();
  key.clear();
}

double Course::at(double time) const {
  if (values.empty()) return 1;
  const double share = changes() ? std::clamp(time / length, 0.0, 1.0) : 0;
  if (!steps) return values.front() + share * (values.back() - values.front());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

ContactLaw::ContactLaw(Potential potential, std::size_t place, ContactMemory& memory, std::size_t cells,
                       Course strength)
    : potential_(std::move(potential)),
      course_(std::move(strength)),
      strength_(course_.at(0)),
      cutoff_(cutoff_of(potential_)),
      reads_normal_velocity_(potential_.reads("normal_velocity")),
      reads_tangential_velocity_(potential_.reads("tangential_velocity")),
      reads_sliding_speed_(potential_.reads("sliding_speed")),
      has_energy_(potential_.writes("energy")) {
  for (const StateVariable& declared : potential_.state) {
    memory.of_cell.resize(cells);
    const std::size_t kept =
        memory.keep({static_cast<int>(place), potential_.id, declared.name, declared.unit, declared.initial});
    variables_.push_back({kept, memory.variables[kept].initial});
  }
}

void ContactLaw::choose(const ContactValues& from, const std::vector<int>& contacts, ContactValues& chosen) const {
  const auto take = [&](bool wanted, const std::vector<double>& values, std::vector<double>& to) {
    if (!wanted) return;
    to.resize(contacts.size());
    for (std::size_t k = 0; k < contacts.size(); ++k) to[k] = values[contacts[k]];
  };
  take(true, from.distance, chosen.distance);
  take(reads_normal_velocity_, from.normal_velocity, chosen.normal_velocity);
  take(reads_tangential_velocity_, from.tangential_velocity, chosen.tangential_velocity);
  take(reads_sliding_speed_, from.sliding_speed, chosen.sliding_speed);
}

void ContactLaw::evaluate(int nodes, const std::vector<ContactState>& known, const ContactValues& values,
                          Range contacts, bool energy, std::vector<ContactState>* next, double* law) const {
  const auto count = static_cast<std::size_t>(contacts.end - contacts.begin);
  const ContactKey* const key = values.key.data() + contacts.begin;  // read by those that remember
  std::vector<double> remembered(variables_.size() * count);
  std::vector<const double*> state;
  std::vector<double*> new_state;
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    double* const of_variable = remembered.data() + v * count;
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      at = find(known, variables_[v].place, key[i], at);
      of_variable[i] = at < known.size() ? known[at].value[key[i].node] : variables_[v].initial;
    }
    state.push_back(of_variable);
    new_state.push_back(of_variable);
  }
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(count);
  block.time_step = remembers() && next == nullptr ? 0 : 1;
  block.distance = values.distance.data() + contacts.begin;
  if (reads_normal_velocity_) block.normal_velocity = values.normal_velocity.data() + contacts.begin;
  if (reads_tangential_velocity_) block.tangential_velocity = values.tangential_velocity.data() + contacts.begin;
  if (reads_sliding_speed_) block.sliding_speed = values.sliding_speed.data() + contacts.begin;
  (energy ? block.energy : block.force) = law;
  if (remembers()) block.state = state.data();
  if (remembers() && next != nullptr) block.new_state = new_state.data();
  potential_.compute(&block);
  for (std::size_t i = 0; strength_ != 1 && i < count; ++i) law[i] *= strength_;
  if (next == nullptr) return;
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    const auto& [variable, initial] = variables_[v];
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      at = find(*next, variable, key[i], at);
      if (at == next->size())
        next->push_back({variable, key[i].other, key[i].shift, std::vector<double>(nodes, initial)});
      (*next)[at].value[key[i].node] = new_state[v][i];
    }
  }
}

}  // namespace rouleau::core
