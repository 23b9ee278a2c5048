#include "surface_wall_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "contact.hpp"
#include "distance_law.hpp"

namespace rouleau::core {

SurfaceWallContacts::SurfaceWallContacts(std::vector<WallInteraction> interactions, const Domain<3>& domain,
                                         double tube_radius)
    : interactions_(std::move(interactions)), middle_{(domain.size[1] - 1) / 2.0, (domain.size[2] - 1) / 2.0} {
  if (tube_radius > 0) walls_.push_back({0, tube_radius, 0});
  for (const int axis : {1, 2}) {
    if (!domain.walled(axis) || tube_radius > 0) continue;
    walls_.push_back({axis, -0.5, 1});
    walls_.push_back({axis, domain.size[axis] - 0.5, -1});
  }
  if (walls_.empty()) throw std::invalid_argument("a potential between cells and walls needs walls");
  for (const WallInteraction& interaction : interactions_) {
    const Potential& potential = interaction.potential;
    if (!is_of_distance_alone(potential))
      throw std::invalid_argument("\"" + potential.id +
                                  "\" acts by more than the distance, which surfaces do not tell");
    cutoffs_.push_back(cutoff_of(potential));
  }
}

void SurfaceWallContacts::measure(std::size_t interaction, int cell, const Wall& wall, const Surfaces& surfaces,
                                  bool energy, Contacts& contacts) const {
  for (auto* values : {&contacts.distance, &contacts.away_y, &contacts.away_z}) values->clear();
  contacts.node.clear();
  const CellRange& range = surfaces.cells[cell];
  const auto add = [&](int node, double distance, double away_y, double away_z) {
    if (!(distance <= cutoffs_[interaction])) return;
    contacts.node.push_back(node);
    contacts.distance.push_back(std::max(distance, ContactList::least_distance));
    contacts.away_y.push_back(away_y);
    contacts.away_z.push_back(away_z);
  };
  for (int i = range.first; i < range.end(); ++i) {
    if (wall.axis == 1) {
      add(i, wall.outward * (surfaces.y[i] - wall.place), wall.outward, 0);
    } else if (wall.axis == 2) {
      add(i, wall.outward * (surfaces.z[i] - wall.place), 0, wall.outward);
    } else {
      const double y = surfaces.y[i] - middle_[0], z = surfaces.z[i] - middle_[1], radius = std::sqrt(y * y + z * z);
      if (radius > 0) add(i, wall.place - radius, -y / radius, -z / radius);
    }
  }
  if (contacts.node.empty()) return;
  evaluate(interactions_[interaction].potential, contacts.distance, energy, contacts.law);
}

template <class Act>
void SurfaceWallContacts::for_each(Range cells, const Surfaces& surfaces, bool energy, Contacts& contacts,
                                   Act act) const {
  for (int cell = cells.begin; cell < cells.end; ++cell) {
    for (std::size_t k = 0; k < interactions_.size(); ++k) {
      if (interactions_[k].type != surfaces.cells[cell].type) continue;
      if (energy && !interactions_[k].potential.writes("energy")) continue;
      for (const Wall& wall : walls_) {
        measure(k, cell, wall, surfaces, energy, contacts);
        if (!contacts.node.empty()) act(cell);
      }
    }
  }
}

void SurfaceWallContacts::run(Worker worker, Surfaces& surfaces) {
  Contacts contacts;
  for_each(worker.share(surfaces.cell_count()), surfaces, false, contacts, [&](int cell) {
    if (!surfaces.owns(cell)) return;
    const double* area = surfaces.type_of(cell).node_area.data();
    const int first = surfaces.cells[cell].first;
    for (std::size_t i = 0; i < contacts.node.size(); ++i) {
      const int node = contacts.node[i];
      surfaces.force_y[node] += area[node - first] * contacts.law[i] * contacts.away_y[i];
      surfaces.force_z[node] += area[node - first] * contacts.law[i] * contacts.away_z[i];
    }
  });
}

double SurfaceWallContacts::energy(const Surfaces& surfaces, const Ranks<3>&) const {
  double sum = 0;
  Contacts contacts;
  for_each({0, surfaces.cell_count()}, surfaces, true, contacts, [&](int cell) {
    const RestSurface& rest = surfaces.type_of(cell);
    for (std::size_t i = 0; i < contacts.node.size(); ++i)
      sum += rest.node_area[contacts.node[i] - surfaces.cells[cell].first] * contacts.law[i];
  });
  return sum;
}

double SurfaceWallContacts::net_force(const Surfaces& surfaces) const {
  double sum = 0;
  Contacts contacts;
  for_each({0, surfaces.cell_count()}, surfaces, false, contacts, [&](int cell) {
    const RestSurface& rest = surfaces.type_of(cell);
    for (std::size_t i = 0; i < contacts.node.size(); ++i)
      sum += rest.node_area[contacts.node[i] - surfaces.cells[cell].first] * contacts.law[i] * contacts.away_y[i];
  });
  return sum;
}

std::string SurfaceWallContacts::without_energy() const {
  for (const WallInteraction& interaction : interactions_)
    if (!interaction.potential.writes("energy")) return interaction.potential.id;
  return {};
}

}  // namespace rouleau::core
