#include "wall_contacts.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/domain/exact_sum.hpp"
#include "core/geometry/formulas.hpp"

namespace rouleau::core {

template <int D>
WallContacts<D>::WallContacts(Cells& cells, const std::vector<WallInteraction>& interactions, const Domain<D>& domain,
                              RegionPointer<D> region) {
  for (int axis = 1; axis < D && !region; ++axis) {
    if (!domain.walled(axis)) continue;
    walls_.push_back({axis, -0.5, 1});
    walls_.push_back({axis, domain.size[axis] - 0.5, -1});
  }
  if (walls_.empty() && !region) throw std::invalid_argument("a potential between cells and walls needs walls");
  double reach = 0;
  for (const auto& [type, potential, strength] : interactions) {
    // Friction would be part of the walls' stress and power.
    if (reads_sliding(potential))
      throw std::invalid_argument("a potential with walls does not read how surfaces slide: " + potential.id);
    laws_.push_back({type, ContactLaw(potential, laws_.size(), cells.wall_contacts, cells.cells.size(), strength)});
    remembers_ = remembers_ || laws_.back().law.remembers();
    reach = std::max(reach, laws_.back().law.cutoff());
  }
  if (!region) return;
  const RegionPointer<D> all = intersection<D>({std::move(region), between_walls(domain)});
  walls_.push_back({.axis = 0, .border = std::make_shared<const NearBorder<D>>(all, domain, reach)});
}

template <int D>
void WallContacts<D>::find(const ContactLaw& law, int cell, int wall, const Cells& cells, Contacts& contacts) const {
  contacts.node.clear();
  contacts.away.clear();
  contacts.values.clear();
  const CellRange& range = cells.cells[cell];
  for (int i = range.first; i < range.end(); ++i) {
    const auto [distance, away] = walls_[wall](vector_at<D>(cells.position, i));
    if (!(distance <= law.cutoff())) continue;
    contacts.node.push_back(i);
    contacts.away.push_back(away);
    contacts.values.distance.push_back(std::max(distance, least_distance));
    if (law.remembers()) contacts.values.key.push_back({i - range.first, wall, {}});
    if (law.reads_normal_velocity())  // the wall moves along itself
      contacts.values.normal_velocity.push_back(away.dot(vector_at<D>(cells.velocity, i)));
  }
}

template <int D>
template <class Act>
void WallContacts<D>::for_each(int cell, const Cells& cells, bool energy, std::vector<ContactState>* next,
                               Contacts& contacts, Act act) const {
  const CellRange& range = cells.cells[cell];
  const std::vector<double>& weight = cells.types[range.type]->node_measure();
  for (const auto& [type, law] : laws_) {
    if (type != range.type || (energy && !law.has_energy())) continue;
    for (int wall = 0; wall < static_cast<int>(walls_.size()); ++wall) {
      find(law, cell, wall, cells, contacts);
      const auto count = static_cast<int>(contacts.node.size());
      if (count == 0) continue;
      contacts.law.resize(contacts.node.size());
      law.evaluate(range.count, states_of(cells.wall_contacts, cell), contacts.values, {0, count}, energy, next,
                   contacts.law.data());
      for (int i = 0; i < count; ++i) act(contacts.node[i], weight[contacts.node[i] - range.first], i);
    }
  }
}

template <int D>
void WallContacts<D>::run(Worker worker, Cells& cells) const {
  Contacts contacts;
  std::vector<ContactState> next;
  for (const int cell : cells.own_cells(worker)) {
    next.clear();
    for_each(cell, cells, false, &next, contacts, [&](int node, double weight, int i) {
      for (int k = 0; k < D; ++k) cells.force[k][node] += weight * contacts.law[i] * contacts.away[i][k];
    });
    if (remembers_) cells.wall_contacts.of_cell[cell].swap(next);
  }
}

/// Adds value(contacts, i), times the node's measure at rest, over all contacts of all ranks' cells.
template <int D>
template <class Value>
double WallContacts<D>::sum_over(const Cells& cells, bool energy, const Ranks<D>& ranks, Value value) const {
  std::vector<ExactSum> sum(1);
  Contacts contacts;
  for (const int cell : cells.own_cells())
    for_each(cell, cells, energy, nullptr, contacts,
             [&](int, double weight, int i) { sum.front().add(weight * value(contacts, i)); });
  add_up(ranks, sum);
  return sum.front().value();
}

template <int D>
double WallContacts<D>::energy(const Cells& cells, const Ranks<D>& ranks) const {
  return sum_over(cells, true, ranks, [](const Contacts& contacts, int i) { return contacts.law[i]; });
}

template <int D>
double WallContacts<D>::net_force(const Cells& cells, const Ranks<D>& ranks, int axis) const {
  return sum_over(cells, false, ranks,
                  [axis](const Contacts& contacts, int i) { return contacts.law[i] * contacts.away[i][axis]; });
}

template <int D>
std::string WallContacts<D>::without_energy() const {
  for (const auto& [type, law] : laws_)
    if (!law.has_energy()) return law.potential().id;
  return {};
}

template <int D>
std::optional<BeyondWall> find_beyond_wall(const CellNodes& cells, const NearBorder<D>& border) {
  for (const int cell : cells.own_cells()) {
    std::optional<BeyondWall> deepest;
    for (int i = cells.cells[cell].first; i < cells.cells[cell].end(); ++i) {
      const auto nearest = border.at(vector_at<D>(cells.position, i));
      if (nearest && -nearest->value > (deepest ? deepest->depth : 0)) deepest = {cell, i, -nearest->value};
    }
    if (deepest) return deepest;
  }
  return std::nullopt;
}

template std::optional<BeyondWall> find_beyond_wall(const CellNodes&, const NearBorder<2>&);
template std::optional<BeyondWall> find_beyond_wall(const CellNodes&, const NearBorder<3>&);
template class WallContacts<2>;
template class WallContacts<3>;

}  // namespace rouleau::core
