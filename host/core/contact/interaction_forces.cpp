#include "interaction_forces.hpp"

#include <algorithm>
#include <string>

#include "distance_law.hpp"

namespace rouleau::core {

std::vector<double> cutoffs_of(const std::vector<Interaction>& interactions) {
  std::vector<double> cutoffs;
  cutoffs.reserve(interactions.size());
  for (const Interaction& interaction : interactions) cutoffs.push_back(cutoff_of(interaction.potential));
  return cutoffs;
}

double contact_reach(const std::vector<Interaction>& interactions) {
  const std::vector<double> cutoffs = cutoffs_of(interactions);
  return cutoffs.empty() ? 0 : list_reach(*std::max_element(cutoffs.begin(), cutoffs.end()));
}

Cutoffs pair_cutoffs(const CellNodes& cells, const std::vector<Interaction>& interactions,
                     const std::vector<double>& cutoffs) {
  int types = 1;
  for (const CellRange& cell : cells.cells) types = std::max(types, cell.type + 1);
  for (const Interaction& interaction : interactions)
    types = std::max({types, interaction.between[0] + 1, interaction.between[1] + 1});
  Cutoffs result(types);
  for (std::size_t p = 0; p < interactions.size(); ++p) {
    result.raise(interactions[p].between[0], interactions[p].between[1], cutoffs[p]);
  }
  return result;
}

bool acts_between(const Interaction& interaction, int a, int b) {
  return (interaction.between[0] == a && interaction.between[1] == b) ||
         (interaction.between[0] == b && interaction.between[1] == a);
}

InteractionForces::InteractionForces(Membranes& membranes, std::vector<Interaction> interactions, Domain<2> domain)
    : interactions_(std::move(interactions)),
      cutoffs_(cutoffs_of(interactions_)),
      contacts_(membranes, pair_cutoffs(membranes, interactions_, cutoffs_), domain),
      scratch_(membranes.cells.size()),
      reactions_(membranes.cells.size()),
      across_images_(membranes.cells.size()) {
  for (std::size_t p = 0; p < interactions_.size(); ++p) {
    const Potential& potential = interactions_[p].potential;
    variables_.push_back(keep_state(potential, p, membranes.contacts, membranes.cells.size()));
    has_state_ = has_state_ || !potential.state.empty();
    const Traits traits{potential.reads("normal_velocity"), potential.reads("tangential_velocity"),
                        potential.reads("sliding_speed"), potential.writes("energy")};
    needs_velocities_ =
        needs_velocities_ || traits.normal_velocity || traits.tangential_velocity || traits.sliding_speed;
    traits_.push_back(traits);
  }
}

void InteractionForces::run(Worker worker, int phase, Membranes& membranes) {
  const CellNumbers cells = membranes.known_cells(worker);
  switch (phase) {
    case 0:
      contacts_.measure(worker, membranes);
      break;
    case 1:
      contacts_.refresh(worker, membranes);
      for (const int cell : cells) {
        if (!membranes.owns(cell)) {
          make_room_for_reactions(cell);
          continue;
        }
        compute_forces(cell, membranes, scratch_.of(cells.first_place()));
        act(cell, membranes, scratch_.of(cells.first_place()));
      }
      break;
    default:
      contacts_.neighbours().link(worker, membranes);
      for (const int cell : cells) {
        if (membranes.owns(cell)) take_reactions(cell, membranes);
      }
      break;
  }
}

void InteractionForces::forget(const Membranes& membranes, std::span<const Range> nodes) {
  contacts_.forget(membranes, nodes);
  membranes.forget_unknown_of(reactions_);
}

// Pairs are listed by type of the other cell, so that a potential gets its distances in one piece.
InteractionForces::TypeRange InteractionForces::next_range(int cell, const std::vector<Range>& ranges,
                                                           const Membranes& membranes, std::size_t& pair) const {
  const std::vector<NeighbourList::Pair>& pairs = contacts_.neighbours().list(cell).pairs;
  const auto type_of = [&](std::size_t p) { return membranes.cells[pairs[p].other].type; };
  TypeRange result{type_of(pair), ranges[pair]};
  for (++pair; pair < pairs.size() && type_of(pair) == result.type; ++pair) result.contacts.end = ranges[pair].end;
  return result;
}

/// Adds (or, if it is the first, sets) one potential's force or energy at the contacts to `result`.
void InteractionForces::apply(std::size_t potential, Range contacts, double* result, bool energy, bool first,
                              Scratch& scratch) const {
  const ContactList& list = scratch.contacts;
  const Potential& model = interactions_[potential].potential;
  const double cutoff = cutoffs_[potential];
  const int own_type = interactions_[potential].between[0], other_type = interactions_[potential].between[1];
  const bool all = !(cutoff < contacts_.neighbours().cutoffs()(own_type, other_type));
  int count = contacts.end - contacts.begin;
  const double* distance = list.distance.data() + contacts.begin;
  if (!all) {
    count = 0;
    for (int i = contacts.begin; i < contacts.end; ++i) {
      scratch.distance[count] = list.distance[i];
      scratch.contact[count] = i;
      count += list.distance[i] <= cutoff ? 1 : 0;
    }
    distance = scratch.distance.data();
  }
  if (first && !(all && count > 0)) std::fill(result + contacts.begin, result + contacts.end, 0.0);
  if (count == 0) return;

  const bool direct = first && all;
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(count);
  block.time_step = 1;
  block.distance = distance;
  give_velocities(potential, contacts.begin, count, all, scratch, block);
  (energy ? block.energy : block.force) = direct ? result + contacts.begin : scratch.law.data();
  model.compute(&block);
  if (direct) return;
  for (int i = 0; i < count; ++i) {
    result[all ? contacts.begin + i : scratch.contact[i]] += scratch.law[i];
  }
}

void InteractionForces::give_velocities(std::size_t potential, int first, int count, bool all, Scratch& scratch,
                                        rouleau_interaction_block& block) const {
  const auto give = [&](bool needed, const std::vector<double>& values, std::vector<double>& chosen,
                        const double*& to) {
    if (!needed) return;
    to = values.data() + first;
    if (all) return;
    for (int k = 0; k < count; ++k) chosen[k] = values[scratch.contact[k]];
    to = chosen.data();
  };
  give(traits_[potential].normal_velocity, scratch.velocities.normal, scratch.normal, block.normal_velocity);
  give(traits_[potential].tangential_velocity, scratch.velocities.tangential, scratch.tangential,
       block.tangential_velocity);
  give(traits_[potential].sliding_speed, scratch.velocities.sliding, scratch.sliding, block.sliding_speed);
}

void InteractionForces::find_contacts(int cell, const Membranes& membranes, Scratch& scratch) const {
  const ContactList& list = scratch.contacts;
  contacts_.find(cell, membranes, scratch.contacts);
  if (scratch.law.size() < list.node.size()) {
    for (auto* values : {&scratch.force, &scratch.law, &scratch.distance}) values->resize(list.node.size());
    for (auto* values : {&scratch.normal, &scratch.tangential, &scratch.sliding}) values->resize(list.node.size());
    scratch.contact.resize(list.node.size());
  }
  if (needs_velocities_) {
    scratch.velocities.measure(list, contacts_.neighbours().list(cell).pairs, membranes);
  }
}

void InteractionForces::compute_forces(int cell, Membranes& membranes, Scratch& scratch) {
  const ContactList& list = scratch.contacts;
  find_contacts(cell, membranes, scratch);
  make_room_for_reactions(cell);
  const int type = membranes.cells[cell].type;
  std::vector<ContactState> none;
  NextState next{has_state_ ? membranes.contacts.of_cell[cell] : none};
  for (std::size_t pair = 0; pair < list.ranges.size();) {
    const std::size_t first_pair = pair;
    const TypeRange range = next_range(cell, list.ranges, membranes, pair);
    bool first = true;
    for (std::size_t p = 0; p < interactions_.size(); ++p) {
      if (!acts_between(interactions_[p], type, range.type)) continue;
      if (variables_[p].empty()) {
        apply(p, range.contacts, scratch.force.data(), false, first, scratch);
      } else {
        if (first) {
          std::fill(scratch.force.data() + range.contacts.begin, scratch.force.data() + range.contacts.end, 0.0);
        }
        for (std::size_t q = first_pair; q < pair; ++q) {
          apply_with_state(p, cell, q, membranes, scratch.force.data(), false, &next, scratch);
        }
      }
      first = false;
    }
  }
  next.states.resize(next.kept);  // pairs that do not touch any more
}

void InteractionForces::make_room_for_reactions(int cell) {
  const auto touched = static_cast<std::size_t>(contacts_.neighbours().list(cell).touched);
  reactions_[cell].x.assign(touched, 0.0);
  reactions_[cell].y.assign(touched, 0.0);
}

void InteractionForces::act(int cell, Membranes& membranes, const Scratch& scratch) {
  const ContactList& list = scratch.contacts;
  const std::vector<NeighbourList::Pair>& pairs = contacts_.neighbours().list(cell).pairs;
  const CellRange& own = membranes.cells[cell];
  const double* weight = membranes.type_of(own).rest_weight.data();
  const double *force = scratch.force.data(), *along = list.along.data();
  double *force_x = membranes.force[0].data(), *force_y = membranes.force[1].data();
  const int *node = list.node.data(), *segment = list.segment.data();
  across_images_[cell] = 0;
  const double *direction_x = list.direction_x.data(), *direction_y = list.direction_y.data();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const NeighbourList::Pair& pair = pairs[p];
    const int to_touched = pair.reaction - pair.touched.begin - membranes.cells[pair.other].first;
    double *reaction_x = reactions_[cell].x.data(), *reaction_y = reactions_[cell].y.data();
    const auto act_at = [&](int i) {
      const double f = 0.5 * weight[node[i] - own.first] * force[i], fx = f * direction_x[i], fy = f * direction_y[i];
      const int begin = segment[i] + to_touched;
      force_x[node[i]] += fx;
      force_y[node[i]] += fy;
      reaction_x[begin] -= (1 - along[i]) * fx;
      reaction_y[begin] -= (1 - along[i]) * fy;
      reaction_x[begin + 1] -= along[i] * fx;
      reaction_y[begin + 1] -= along[i] * fy;
    };
    // Consecutive contacts often share a segment, and each sum waits for the one before: two halves take turns.
    const Range range = list.ranges[p];
    const int half = (range.end - range.begin) / 2, middle = range.begin + half;
    for (int i = range.begin; i < middle; ++i) {
      act_at(i);
      act_at(i + half);
    }
    for (int i = middle + half; i < range.end; ++i) act_at(i);
    for (int i = range.begin; i < range.end && pair.shift.y != 0; ++i)
      across_images_[cell] += pair.shift.y * 0.5 * weight[node[i] - own.first] * force[i] * direction_x[i];
  }
}

void InteractionForces::take_reactions(int cell, Membranes& membranes) const {
  const CellRange& own = membranes.cells[cell];
  for (const NeighbourList::Pair& pair : contacts_.neighbours().list(cell).pairs) {
    const NeighbourList::Pair& opposite = contacts_.neighbours().list(pair.other).pairs[pair.reverse];
    const int first = opposite.reaction - opposite.touched.begin;
    const double *reaction_x = reactions_[pair.other].x.data() + first,
                 *reaction_y = reactions_[pair.other].y.data() + first;
    double *force_x = membranes.force[0].data() + own.first, *force_y = membranes.force[1].data() + own.first;
    const int last = std::min(opposite.touched.end, own.count);
    for (int k = opposite.touched.begin; k < last; ++k) {
      force_x[k] += reaction_x[k];
      force_y[k] += reaction_y[k];
    }
    if (opposite.touched.end > own.count) {
      force_x[0] += reaction_x[own.count];
      force_y[0] += reaction_y[own.count];
    }
  }
}

double InteractionForces::energy(const Membranes& membranes, const Ranks<2>& ranks) const {
  std::vector<ExactSum> sum(1);
  Scratch scratch;
  for (const int cell : membranes.own_cells()) {
    const ContactList& list = scratch.contacts;
    find_contacts(cell, membranes, scratch);
    std::vector<double> energy(list.node.size(), 0.0);
    const CellRange& own = membranes.cells[cell];
    const int type = own.type;
    for (std::size_t pair = 0; pair < list.ranges.size();) {
      const std::size_t first_pair = pair;
      const TypeRange range = next_range(cell, list.ranges, membranes, pair);
      for (std::size_t p = 0; p < interactions_.size(); ++p) {
        if (!traits_[p].energy || !acts_between(interactions_[p], type, range.type)) continue;
        if (variables_[p].empty()) apply(p, range.contacts, energy.data(), true, false, scratch);
        for (std::size_t q = first_pair; q < pair && !variables_[p].empty(); ++q) {
          apply_with_state(p, cell, q, membranes, energy.data(), true, nullptr, scratch);
        }
      }
    }
    const double* weight = membranes.type_of(own).rest_weight.data();
    for (int i = 0; i < list.count; ++i) sum.front().add(0.5 * weight[list.node[i] - own.first] * energy[i]);
  }
  add_up(ranks, sum);
  return sum.front().value();
}

std::string InteractionForces::without_energy() const {
  for (std::size_t p = 0; p < interactions_.size(); ++p)
    if (!traits_[p].energy) return interactions_[p].potential.id;
  return {};
}

}  // namespace rouleau::core
