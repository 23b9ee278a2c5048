#include "surface_interactions.hpp"

#include <algorithm>
#include <stdexcept>

#include "distance_law.hpp"

namespace rouleau::core {

namespace {

/// Of a contact's node against the facing point of the other surface, by the nodes' velocities in the last step.
Vec<3> relative_velocity(const SurfaceContact& contact, const Surfaces& surfaces) {
  const auto of = [&](int node) {
    return Vec<3>(surfaces.velocity[0][node], surfaces.velocity[1][node], surfaces.velocity[2][node]);
  };
  Vec<3> apart = of(contact.node);
  for (std::size_t k = 0; k < 3; ++k) apart -= contact.weight[k] * of(contact.corner[k]);
  return apart;
}

/// The largest of each type.
std::vector<double> self_cutoffs(const Surfaces& surfaces, const std::vector<SelfInteraction>& within_cells) {
  std::vector<double> cutoffs(within_cells.empty() ? 0 : surfaces.types.size(), 0.0);
  for (const auto& [type, potential] : within_cells) {
    if (!is_of_distance_alone(potential))
      throw std::invalid_argument("a potential within a membrane depends on the distance alone: " + potential.id);
    cutoffs[type] = std::max(cutoffs[type], cutoff_of(potential));
  }
  return cutoffs;
}

}  // namespace

SurfaceInteractions::SurfaceInteractions(Surfaces& surfaces, std::vector<Interaction> interactions,
                                         const Domain<3>& domain, std::vector<SelfInteraction> within_cells)
    : between_cells_(interactions.size()),
      interactions_(std::move(interactions)),
      contacts_(surfaces, pair_cutoffs(surfaces, interactions_, cutoffs_of(interactions_)), domain,
                self_cutoffs(surfaces, within_cells)),
      scratch_(surfaces.cells.size()),
      reactions_(surfaces.cells.size()),
      across_images_(surfaces.cells.size()) {
  for (SelfInteraction& own : within_cells) interactions_.push_back({{own.type, own.type}, std::move(own.potential)});
  for (std::size_t p = 0; p < interactions_.size(); ++p) {
    const SurfaceLaw& law = laws_.emplace_back(interactions_[p].potential, p, surfaces.contacts, surfaces.cells.size());
    remembers_ = remembers_ || law.remembers();
    needs_velocities_ = needs_velocities_ || law.reads_normal_velocity() || law.reads_sliding_speed();
  }
}

void SurfaceInteractions::run(Worker worker, int phase, Surfaces& surfaces) {
  const CellNumbers cells = surfaces.known_cells(worker);
  if (phase == 0) return contacts_.measure(worker, surfaces);
  if (phase == 1) {
    contacts_.refresh(worker, surfaces);
    for (const int cell : cells) {
      reactions_[cell].clear();
      if (!surfaces.owns(cell)) continue;
      Scratch& scratch = scratch_.of(cells.first_place());
      contacts_.find(cell, surfaces, scratch.contacts);
      scratch.state.clear();
      evaluate(cell, surfaces, false, &scratch.state, scratch);
      act(cell, surfaces, scratch);
      if (remembers_) surfaces.contacts.of_cell[cell].swap(scratch.state);
    }
    return;
  }
  // All cells' reactions in their order, of which each worker takes those on its share of the nodes.
  const Range own = surfaces.node_share(worker);
  for (const int cell : surfaces.known_cells()) {
    for (const Reaction& reaction : reactions_[cell]) {
      if (reaction.node < own.begin || reaction.node >= own.end || !surfaces.owns(reaction.cell)) continue;
      surfaces.force[0][reaction.node] += reaction.force.x();
      surfaces.force[1][reaction.node] += reaction.force.y();
      surfaces.force[2][reaction.node] += reaction.force.z();
    }
  }
}

void SurfaceInteractions::forget(const Surfaces& surfaces, std::span<const Range> nodes) {
  contacts_.forget(surfaces, nodes);
  surfaces.forget_unknown_of(reactions_);
}

void SurfaceInteractions::evaluate(int cell, const Surfaces& surfaces, bool energy, std::vector<ContactState>* next,
                                   Scratch& scratch) const {
  scratch.result.assign(scratch.contacts.size(), 0.0);
  const CellRange& own = surfaces.cells[cell];
  for (std::size_t p = 0; p < laws_.size(); ++p) {
    const SurfaceLaw& law = laws_[p];
    if (energy && !law.has_energy()) continue;
    scratch.inputs.clear();
    scratch.contact.clear();
    for (std::size_t c = 0; c < scratch.contacts.size(); ++c) {
      const SurfaceContact& contact = scratch.contacts[c];
      if (contact.distance > law.cutoff() || !acts_at(p, contact, cell, surfaces)) continue;
      scratch.inputs.distance.push_back(contact.distance);
      if (law.reads_normal_velocity() || law.reads_sliding_speed()) {
        const Vec<3> velocity = relative_velocity(contact, surfaces);
        const double normal = velocity.dot(contact.direction);
        if (law.reads_normal_velocity()) scratch.inputs.normal_velocity.push_back(normal);
        if (law.reads_sliding_speed())
          scratch.inputs.sliding_speed.push_back((velocity - normal * contact.direction).norm());
      }
      if (law.remembers()) scratch.inputs.key.push_back({contact.node - own.first, contact.other, contact.shift});
      scratch.contact.push_back(static_cast<int>(c));
    }
    if (scratch.contact.empty()) continue;
    law.evaluate(own, states_of(surfaces.contacts, cell), scratch.inputs, energy, next, scratch.law);
    for (std::size_t i = 0; i < scratch.law.size(); ++i) scratch.result[scratch.contact[i]] += scratch.law[i];
  }
}

bool SurfaceInteractions::acts_at(std::size_t interaction, const SurfaceContact& contact, int cell,
                                  const Surfaces& surfaces) const {
  return contact.within == (interaction >= between_cells_) &&
         acts_between(interactions_[interaction], surfaces.cells[cell].type, surfaces.cells[contact.other].type);
}

void SurfaceInteractions::act(int cell, Surfaces& surfaces, const Scratch& scratch) {
  const RestSurface& rest = surfaces.type_of(cell);
  const int first = surfaces.cells[cell].first;
  across_images_[cell] = 0;
  for (std::size_t c = 0; c < scratch.contacts.size(); ++c) {
    const SurfaceContact& contact = scratch.contacts[c];
    if (scratch.result[c] == 0) continue;
    const Vec<3> force = 0.5 * rest.node_area[contact.node - first] * scratch.result[c] * contact.direction;
    across_images_[cell] += contact.shift.y * force.x();
    surfaces.force[0][contact.node] += force.x();
    surfaces.force[1][contact.node] += force.y();
    surfaces.force[2][contact.node] += force.z();
    for (std::size_t k = 0; k < 3; ++k) {
      if (contact.weight[k] != 0)
        reactions_[cell].push_back({contact.other, contact.corner[k], -contact.weight[k] * force});
    }
  }
}

double SurfaceInteractions::energy(const Surfaces& surfaces, const Ranks<3>& ranks) const {
  std::vector<ExactSum> sum(1);
  Scratch scratch;
  for (const int cell : surfaces.own_cells()) {
    contacts_.find(cell, surfaces, scratch.contacts);
    evaluate(cell, surfaces, true, nullptr, scratch);
    const RestSurface& rest = surfaces.type_of(cell);
    for (std::size_t c = 0; c < scratch.contacts.size(); ++c)
      sum.front().add(0.5 * rest.node_area[scratch.contacts[c].node - surfaces.cells[cell].first] * scratch.result[c]);
  }
  add_up(ranks, sum);
  return sum.front().value();
}

std::string SurfaceInteractions::without_energy() const {
  for (const Interaction& interaction : interactions_)
    if (!interaction.potential.writes("energy")) return interaction.potential.id;
  return {};
}

}  // namespace rouleau::core
