#include "surface_wall_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "contact.hpp"
#include "distance_law.hpp"

namespace rouleau::core {

SurfaceWallContacts::SurfaceWallContacts(Surfaces& surfaces, const std::vector<WallInteraction>& interactions,
                                         const Domain<3>& domain, double tube_radius)
    : middle_{(domain.size[1] - 1) / 2.0, (domain.size[2] - 1) / 2.0} {
  if (tube_radius > 0) walls_.push_back({0, tube_radius, 0});
  for (const int axis : {1, 2}) {
    if (!domain.walled(axis) || tube_radius > 0) continue;
    walls_.push_back({axis, -0.5, 1});
    walls_.push_back({axis, domain.size[axis] - 0.5, -1});
  }
  if (walls_.empty()) throw std::invalid_argument("a potential between cells and walls needs walls");
  for (const auto& [type, potential] : interactions) {
    if (reads_sliding(potential))
      throw std::invalid_argument("a potential with walls does not read how surfaces slide: " + potential.id);
    laws_.push_back({type, SurfaceLaw(potential, laws_.size(), surfaces.wall_contacts, surfaces.cells.size())});
    remembers_ = remembers_ || laws_.back().law.remembers();
  }
}

void SurfaceWallContacts::measure(const SurfaceLaw& law, int cell, int wall, const Surfaces& surfaces, bool energy,
                                  std::vector<ContactState>* next, Contacts& contacts) const {
  for (auto* values : {&contacts.away_y, &contacts.away_z}) values->clear();
  contacts.node.clear();
  contacts.inputs.clear();
  const CellRange& range = surfaces.cells[cell];
  const auto add = [&](int node, double distance, double away_y, double away_z) {
    if (!(distance <= law.cutoff())) return;
    contacts.node.push_back(node);
    contacts.away_y.push_back(away_y);
    contacts.away_z.push_back(away_z);
    contacts.inputs.distance.push_back(std::max(distance, ContactList::least_distance));
    if (law.remembers()) contacts.inputs.key.push_back({node - range.first, wall, {}});
    if (law.reads_normal_velocity())  // the wall moves along itself
      contacts.inputs.normal_velocity.push_back(away_y * surfaces.velocity[1][node] +
                                                away_z * surfaces.velocity[2][node]);
  };
  const auto& [axis, place, outward] = walls_[wall];
  for (int i = range.first; i < range.end(); ++i) {
    if (axis == 1) {
      add(i, outward * (surfaces.position[1][i] - place), outward, 0);
    } else if (axis == 2) {
      add(i, outward * (surfaces.position[2][i] - place), 0, outward);
    } else {
      const double y = surfaces.position[1][i] - middle_[0], z = surfaces.position[2][i] - middle_[1],
                   radius = std::sqrt(y * y + z * z);
      if (radius > 0) add(i, place - radius, -y / radius, -z / radius);
    }
  }
  if (contacts.node.empty()) return;
  law.evaluate(range, states_of(surfaces.wall_contacts, cell), contacts.inputs, energy, next, contacts.law);
}

template <class Act>
void SurfaceWallContacts::for_each(int cell, const Surfaces& surfaces, bool energy, std::vector<ContactState>* next,
                                   Contacts& contacts, Act act) const {
  for (const auto& [type, law] : laws_) {
    if (type != surfaces.cells[cell].type || (energy && !law.has_energy())) continue;
    for (int wall = 0; wall < static_cast<int>(walls_.size()); ++wall) {
      measure(law, cell, wall, surfaces, energy, next, contacts);
      if (!contacts.node.empty()) act();
    }
  }
}

void SurfaceWallContacts::run(Worker worker, Surfaces& surfaces) {
  Contacts contacts;
  std::vector<ContactState> next;
  for (const int cell : surfaces.own_cells(worker)) {
    const double* area = surfaces.type_of(cell).node_area.data();
    const int first = surfaces.cells[cell].first;
    next.clear();
    for_each(cell, surfaces, false, &next, contacts, [&] {
      for (std::size_t i = 0; i < contacts.node.size(); ++i) {
        const int node = contacts.node[i];
        surfaces.force[1][node] += area[node - first] * contacts.law[i] * contacts.away_y[i];
        surfaces.force[2][node] += area[node - first] * contacts.law[i] * contacts.away_z[i];
      }
    });
    if (remembers_) surfaces.wall_contacts.of_cell[cell].swap(next);
  }
}

/// Adds value(contacts, i), times the node's area at rest, over all contacts of all ranks' cells.
template <class Value>
double SurfaceWallContacts::sum_over(const Surfaces& surfaces, bool energy, const Ranks<3>& ranks, Value value) const {
  std::vector<ExactSum> sum(1);
  Contacts contacts;
  for (const int cell : surfaces.own_cells()) {
    const RestSurface& rest = surfaces.type_of(cell);
    for_each(cell, surfaces, energy, nullptr, contacts, [&] {
      for (std::size_t i = 0; i < contacts.node.size(); ++i)
        sum.front().add(rest.node_area[contacts.node[i] - surfaces.cells[cell].first] * value(contacts, i));
    });
  }
  add_up(ranks, sum);
  return sum.front().value();
}

double SurfaceWallContacts::energy(const Surfaces& surfaces, const Ranks<3>& ranks) const {
  return sum_over(surfaces, true, ranks, [](const Contacts& contacts, std::size_t i) { return contacts.law[i]; });
}

double SurfaceWallContacts::net_force(const Surfaces& surfaces, const Ranks<3>& ranks, int axis) const {
  return sum_over(surfaces, false, ranks, [axis](const Contacts& contacts, std::size_t i) {
    return contacts.law[i] * (axis == 1 ? contacts.away_y : contacts.away_z)[i];
  });
}

std::string SurfaceWallContacts::without_energy() const {
  for (const auto& [type, law] : laws_)
    if (!law.has_energy()) return law.potential().id;
  return {};
}

}  // namespace rouleau::core
