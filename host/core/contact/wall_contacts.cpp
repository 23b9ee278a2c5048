#include "wall_contacts.hpp"

#include <algorithm>
#include <stdexcept>

#include "contact.hpp"
#include "distance_law.hpp"

namespace rouleau::core {

namespace {

int wall_of(double outward) { return outward > 0 ? 0 : 1; }

}  // namespace

WallContacts::WallContacts(Membranes& membranes, std::vector<WallInteraction> interactions, const Domain<2>& domain)
    : interactions_(std::move(interactions)),
      lower_(-0.5),
      upper_(domain.size[1] - 0.5),
      contacts_(membranes.cells.size()) {
  if (!domain.walled(1)) throw std::invalid_argument("a potential between cells and walls needs walls along y");
  for (std::size_t k = 0; k < interactions_.size(); ++k) {
    const Potential& potential = interactions_[k].potential;
    // Friction would be part of the walls' stress and power.
    if (reads_sliding(potential))
      throw std::invalid_argument("a potential with walls does not read how surfaces slide: " + potential.id);
    traits_.push_back({cutoff_of(potential), potential.reads("normal_velocity"), potential.writes("energy")});
    variables_.push_back(keep_state(potential, k, membranes.wall_contacts, membranes.cells.size()));
  }
}

void WallContacts::run(Worker worker, Membranes& membranes) {
  const CellNumbers cells = membranes.own_cells(worker);
  double* force = membranes.force[1].data();
  for (const int cell : cells) {
    Contacts& contacts = contacts_.of(cells.first_place());
    const CellRange& range = membranes.cells[cell];
    const double* weight = membranes.type_of(range).rest_weight.data();
    for (std::size_t k = 0; k < interactions_.size(); ++k) {
      if (interactions_[k].type != range.type) continue;
      measure(k, cell, membranes, Wanted::step, contacts);
      if (!variables_[k].empty()) remember(k, cell, membranes, contacts);
      for (int i = 0; i < contacts.count; ++i) {
        const int node = contacts.node[i];
        force[node] += weight[node - range.first] * contacts.law[i] * contacts.outward[i];
      }
    }
  }
}

void WallContacts::find(int cell, double cutoff, const Membranes& membranes, Contacts& contacts) const {
  contacts.count = 0;
  const CellRange& range = membranes.cells[cell];
  const double* y = membranes.position[1].data();
  double lowest = y[range.first], highest = lowest;
  for (int i = range.first; i < range.end(); ++i) {
    lowest = y[i] < lowest ? y[i] : lowest;
    highest = y[i] > highest ? y[i] : highest;
  }
  if (lowest - lower_ > cutoff && upper_ - highest > cutoff) return;

  const auto most = 2 * static_cast<std::size_t>(range.count);
  if (contacts.node.size() < most) {
    contacts.node.resize(most);
    for (auto* values : {&contacts.distance, &contacts.outward, &contacts.normal_velocity, &contacts.law})
      values->resize(most);
  }
  const auto add = [&](int node, double distance, double outward) {
    if (!(distance <= cutoff)) return;
    const int at = contacts.count++;
    contacts.node[at] = node;
    contacts.distance[at] = std::max(distance, ContactList::least_distance);
    contacts.outward[at] = outward;
    contacts.normal_velocity[at] = outward * membranes.velocity[1][node];  // the wall moves along itself
  };
  for (int i = range.first; i < range.end(); ++i) {
    add(i, y[i] - lower_, 1);
    add(i, upper_ - y[i], -1);
  }
}

void WallContacts::measure(std::size_t interaction, int cell, const Membranes& membranes, Wanted wanted,
                           Contacts& contacts) const {
  find(cell, traits_[interaction].cutoff, membranes, contacts);
  if (contacts.count == 0) return;
  const std::vector<std::size_t>& variables = variables_[interaction];
  const auto count = static_cast<std::size_t>(contacts.count);
  std::vector<const double*> state;
  std::vector<double*> new_state;
  if (!variables.empty()) contacts.state.resize(count * variables.size());
  for (std::size_t v = 0; v < variables.size(); ++v) {
    double* values = contacts.state.data() + v * count;
    std::fill(values, values + count, membranes.wall_contacts.variables[variables[v]].initial);
    for (const ContactState& known : membranes.wall_contacts.of_cell[cell]) {
      if (known.variable != variables[v]) continue;
      for (std::size_t i = 0; i < count; ++i) {
        if (wall_of(contacts.outward[i]) != known.other) continue;
        values[i] = known.value[contacts.node[i] - membranes.cells[cell].first];
      }
    }
    state.push_back(values);
    new_state.push_back(values);
  }
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(contacts.count);
  block.time_step = wanted == Wanted::step || variables.empty() ? 1 : 0;
  block.distance = contacts.distance.data();
  if (traits_[interaction].normal_velocity) block.normal_velocity = contacts.normal_velocity.data();
  (wanted == Wanted::energy ? block.energy : block.force) = contacts.law.data();
  if (!variables.empty()) block.state = state.data();
  if (!variables.empty() && wanted == Wanted::step) block.new_state = new_state.data();
  interactions_[interaction].potential.compute(&block);
}

void WallContacts::remember(std::size_t interaction, int cell, Membranes& membranes, Contacts& contacts) const {
  const CellRange& range = membranes.cells[cell];
  std::vector<ContactState>& states = membranes.wall_contacts.of_cell[cell];
  for (std::size_t v = 0; v < variables_[interaction].size(); ++v) {
    const std::size_t variable = variables_[interaction][v];
    const double* values = contacts.state.data() + v * static_cast<std::size_t>(contacts.count);
    for (const int wall : {0, 1}) {
      contacts.fresh.assign(static_cast<std::size_t>(range.count), membranes.wall_contacts.variables[variable].initial);
      bool touches = false;
      for (int i = 0; i < contacts.count; ++i) {
        if (wall_of(contacts.outward[i]) != wall) continue;
        contacts.fresh[contacts.node[i] - range.first] = values[i];
        touches = true;
      }
      auto found = std::find_if(states.begin(), states.end(), [&](const ContactState& state) {
        return state.variable == variable && state.other == wall;
      });
      if (touches) {
        if (found == states.end()) found = states.insert(found, {variable, wall, {}, {}});
        found->value.swap(contacts.fresh);
      } else if (found != states.end()) {
        states.erase(found);
      }
    }
  }
}

double WallContacts::energy(const Membranes& membranes, const Ranks<2>& ranks) const {
  std::vector<ExactSum> sum(1);
  Contacts contacts;
  for (const int cell : membranes.own_cells()) {
    const CellRange& range = membranes.cells[cell];
    const double* weight = membranes.type_of(range).rest_weight.data();
    for (std::size_t k = 0; k < interactions_.size(); ++k) {
      if (interactions_[k].type != range.type || !traits_[k].energy) continue;
      measure(k, cell, membranes, Wanted::energy, contacts);
      for (int i = 0; i < contacts.count; ++i)
        sum.front().add(weight[contacts.node[i] - range.first] * contacts.law[i]);
    }
  }
  add_up(ranks, sum);
  return sum.front().value();
}

double WallContacts::net_force(const Membranes& membranes, const Ranks<2>& ranks) const {
  std::vector<ExactSum> sum(1);
  Contacts contacts;
  for (const int cell : membranes.own_cells()) {
    const CellRange& range = membranes.cells[cell];
    const double* weight = membranes.type_of(range).rest_weight.data();
    for (std::size_t k = 0; k < interactions_.size(); ++k) {
      if (interactions_[k].type != range.type) continue;
      measure(k, cell, membranes, Wanted::force, contacts);
      for (int i = 0; i < contacts.count; ++i)
        sum.front().add(weight[contacts.node[i] - range.first] * contacts.law[i] * contacts.outward[i]);
    }
  }
  add_up(ranks, sum);
  return sum.front().value();
}

std::string WallContacts::without_energy() const {
  for (std::size_t k = 0; k < interactions_.size(); ++k)
    if (!traits_[k].energy) return interactions_[k].potential.id;
  return {};
}

}  // namespace rouleau::core
