#include "interactions.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/domain/exact_sum.hpp"

namespace rouleau::core {

namespace {

int node_of(const ContactList& list, std::size_t i) { return list.node[i]; }
int node_of(const ContactsOf<3>::List& list, std::size_t i) { return list.contacts[i].node; }

}  // namespace

template <int D>
Interactions<D>::Interactions(Cells& cells, std::vector<Interaction> between_cells, const Domain<D>& domain,
                              const std::vector<SelfInteraction>& within_cells)
    : between_cells_(between_cells.size()),
      interactions_(std::move(between_cells)),
      contacts_(cells, pair_cutoffs(cells, interactions_), domain, self_cutoffs(cells.types.size(), within_cells)),
      scratch_(cells.cells.size()),
      reactions_(cells.cells.size()),
      across_images_(cells.cells.size()) {
  for (const auto& [type, potential, strength] : within_cells)
    interactions_.push_back({{type, type}, potential, strength});
  for (const Interaction& interaction : interactions_) {
    const Potential& potential = interaction.potential;
    if (D == 3 && potential.reads("tangential_velocity"))
      throw std::invalid_argument("\"" + potential.id +
                                  "\" reads a tangential velocity, which has no sign on surfaces");
    const ContactLaw& law =
        laws_.emplace_back(potential, laws_.size(), cells.contacts, cells.cells.size(), interaction.strength);
    remembers_ = remembers_ || law.remembers();
    needs_velocities_ = needs_velocities_ || law.reads_velocities();
  }
}

template <int D>
void Interactions<D>::run(Worker worker, int phase, Cells& cells) {
  if (phase == 0) return contacts_.measure(worker, cells);
  if (phase == 2) return take_reactions(worker, cells);
  contacts_.refresh(worker, cells);
  const CellNumbers known = cells.known_cells(worker);
  for (const int cell : known) {
    make_room_for_reactions(cell);
    if (!cells.owns(cell)) continue;
    Scratch& scratch = scratch_.of(known.first_place());
    scratch.state.clear();
    evaluate(cell, cells, false, &scratch.state, scratch);
    act(cell, cells, scratch);
    if (remembers_) cells.contacts.of_cell[cell].swap(scratch.state);
  }
}

template <int D>
void Interactions<D>::forget(const Cells& cells, std::span<const Range> nodes) {
  contacts_.forget(cells, nodes);
  cells.forget_unknown_of(reactions_);
}

template <int D>
void Interactions<D>::evaluate(int cell, const Cells& cells, bool energy, std::vector<ContactState>* next,
                               Scratch& scratch) const {
  const int all = find(cell, cells, scratch);
  scratch.result.assign(all, 0.0);
  if (scratch.law.size() < scratch.result.size()) scratch.law.resize(scratch.result.size());
  for (std::size_t p = 0; p < laws_.size(); ++p) {
    const ContactLaw& law = laws_[p];
    if (energy && !law.has_energy()) continue;
    scratch.chosen.clear();
    scratch.values.key.clear();
    const Range piece = choose(p, cell, cells, scratch);
    const auto chosen = static_cast<int>(scratch.chosen.size());
    if (chosen > 0) law.choose(scratch.contacts, scratch.chosen, scratch.values);
    const ContactValues& values = chosen > 0 ? scratch.values : scratch.contacts;
    const Range contacts = chosen > 0 ? Range{0, chosen} : piece;
    if (contacts.begin == contacts.end) continue;
    law.evaluate(cells.cells[cell].count, states_of(cells.contacts, cell), values, contacts, energy, next,
                 scratch.law.data());
    for (int i = 0; i < chosen; ++i) scratch.result[scratch.chosen[i]] += scratch.law[i];
    for (int i = piece.begin; i < piece.end; ++i) scratch.result[i] += scratch.law[i - piece.begin];
  }
}

template <int D>
double Interactions<D>::energy(const Cells& cells, const Ranks<D>& ranks) const {
  std::vector<ExactSum> sum(1);
  Scratch scratch;
  for (const int cell : cells.own_cells()) {
    evaluate(cell, cells, true, nullptr, scratch);
    const auto weight = half_weight(cells, cell);
    for (std::size_t c = 0; c < scratch.result.size(); ++c)
      sum.front().add(weight(node_of(scratch.contacts, c)) * scratch.result[c]);
  }
  add_up(ranks, sum);
  return sum.front().value();
}

template <int D>
std::vector<PairEnergy> Interactions<D>::pair_energies(const Cells& cells) const {
  std::vector<PairEnergy> pairs;
  Scratch scratch;
  for (const int cell : cells.own_cells()) {
    evaluate(cell, cells, true, nullptr, scratch);
    const auto weight = half_weight(cells, cell);
    const auto first = static_cast<std::ptrdiff_t>(pairs.size());
    const auto add = [&](int other, const ImageShift& shift, std::size_t i) {
      auto pair = std::find_if(pairs.begin() + first, pairs.end(),
                               [&](const PairEnergy& p) { return p.other == other && p.shift == shift; });
      if (pair == pairs.end()) pair = pairs.insert(pair, {cell, other, shift, 0});
      pair->energy += weight(node_of(scratch.contacts, i)) * scratch.result[i];
    };
    if constexpr (D == 2) {
      const std::vector<NeighbourList::Pair>& near = contacts_.neighbours().list(cell).pairs;
      for (std::size_t p = 0; p < near.size(); ++p)
        for (int i = scratch.contacts.ranges[p].begin; i < scratch.contacts.ranges[p].end; ++i)
          add(near[p].other, near[p].shift, static_cast<std::size_t>(i));
    } else {
      const std::vector<TriangleContact>& contacts = scratch.contacts.contacts;
      for (std::size_t i = 0; i < contacts.size(); ++i)
        if (!contacts[i].within) add(contacts[i].other, contacts[i].shift, i);
    }
  }
  return pairs;
}

template <int D>
std::string Interactions<D>::without_energy() const {
  for (const ContactLaw& law : laws_)
    if (!law.has_energy()) return law.potential().id;
  return {};
}

// In two dimensions.

template <>
int Interactions<2>::find(int cell, const Membranes& membranes, Scratch& scratch) const {
  contacts_.find(cell, membranes, scratch.contacts);
  if (needs_velocities_) contacts_.measure_velocities(cell, membranes, scratch.contacts);
  return scratch.contacts.count;
}

// Pairs are listed by type of the other cell: what a potential acts at stands in one piece.
template <>
Range Interactions<2>::choose(std::size_t law, int cell, const Membranes& membranes, Scratch& scratch) const {
  const std::array<int, 2>& between = interactions_[law].between;
  const ContactList& list = scratch.contacts;
  const CellRange& own = membranes.cells[cell];
  const double cutoff = laws_[law].cutoff();
  const bool within = law >= between_cells_, remembers = laws_[law].remembers();
  const bool whole = !within && !remembers && !(cutoff < contacts_.neighbours().cutoffs()(between[0], between[1]));
  Range piece{0, 0};
  const auto take = [&](Range contacts, int other, const ImageShift& shift) {
    if (whole) {
      piece = {piece.begin == piece.end ? contacts.begin : piece.begin, contacts.end};
      return;
    }
    for (int i = contacts.begin; i < contacts.end; ++i) {
      if (list.distance[i] > cutoff) continue;
      scratch.chosen.push_back(i);
      if (remembers) scratch.values.key.push_back({list.node[i] - own.first, other, shift});
    }
  };
  if (within) {
    if (between[0] == own.type) take(list.within, cell, {});
    return piece;
  }
  const std::vector<NeighbourList::Pair>& pairs = contacts_.neighbours().list(cell).pairs;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    if (acts_between(interactions_[law], own.type, membranes.cells[pairs[p].other].type))
      take(list.ranges[p], pairs[p].other, pairs[p].shift);
  return piece;
}

template <>
void Interactions<2>::make_room_for_reactions(int cell) {
  const auto touched = static_cast<std::size_t>(contacts_.neighbours().list(cell).touched);
  reactions_[cell].x.assign(touched, 0.0);
  reactions_[cell].y.assign(touched, 0.0);
}

template <>
void Interactions<2>::act(int cell, Membranes& membranes, const Scratch& scratch) {
  const ContactList& list = scratch.contacts;
  const CellRange& own = membranes.cells[cell];
  const auto weight = half_weight(membranes, cell);
  const double *force = scratch.result.data(), *along = list.along.data();
  double *force_x = membranes.force[0].data(), *force_y = membranes.force[1].data();
  const int *node = list.node.data(), *segment = list.segment.data();
  const double *direction_x = list.direction_x.data(), *direction_y = list.direction_y.data();
  for (int i = list.within.begin; i < list.within.end; ++i) {
    const int from = segment[i], to = own.next(from);
    const double f = weight(node[i]) * force[i] / list.distance[i], fx = f * direction_x[i], fy = f * direction_y[i];
    force_x[node[i]] += fx, force_y[node[i]] += fy;
    force_x[from] -= (1 - along[i]) * fx, force_y[from] -= (1 - along[i]) * fy;
    force_x[to] -= along[i] * fx, force_y[to] -= along[i] * fy;
  }
  std::array<double, 4>& across = across_images_[cell] = {};
  const std::vector<NeighbourList::Pair>& pairs = contacts_.neighbours().list(cell).pairs;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const NeighbourList::Pair& pair = pairs[p];
    const int to_touched = pair.reaction - pair.touched.begin - membranes.cells[pair.other].first;
    double *reaction_x = reactions_[cell].x.data(), *reaction_y = reactions_[cell].y.data();
    const auto act_at = [&](int i) {
      const double f = weight(node[i]) * force[i], fx = f * direction_x[i], fy = f * direction_y[i];
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
    for (int i = range.begin; i < range.end && !(pair.shift == ImageShift{}); ++i) {
      const double f = weight(node[i]) * force[i];
      across[0] += pair.shift.y * f * direction_x[i];
      across[1] += pair.shift.x * f * direction_x[i];
      across[2] += pair.shift.y * f * direction_y[i];
    }
  }
}

template <>
void Interactions<2>::take_reactions(Worker worker, Membranes& membranes) {
  contacts_.neighbours().link(worker, membranes);
  for (const int cell : membranes.own_cells(worker)) {
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
}

// In three dimensions.

template <>
int Interactions<3>::find(int cell, const Surfaces& surfaces, Scratch& scratch) const {
  List& list = scratch.contacts;
  contacts_.find(cell, surfaces, list.contacts);
  list.distance.clear(), list.normal_velocity.clear(), list.sliding_speed.clear();
  for (const TriangleContact& contact : list.contacts) {
    list.distance.push_back(contact.distance);
    if (!needs_velocities_) continue;
    Vec<3> velocity = vector_at<3>(surfaces.velocity, contact.node);  // against the facing point, in the last step
    for (std::size_t k = 0; k < 3; ++k)
      velocity -= contact.weight[k] * vector_at<3>(surfaces.velocity, contact.corner[k]);
    const double normal = velocity.dot(contact.direction);
    list.normal_velocity.push_back(normal);
    list.sliding_speed.push_back((velocity - normal * contact.direction).norm());
  }
  return static_cast<int>(list.contacts.size());
}

template <>
Range Interactions<3>::choose(std::size_t law, int cell, const Surfaces& surfaces, Scratch& scratch) const {
  const CellRange& own = surfaces.cells[cell];
  const std::vector<TriangleContact>& contacts = scratch.contacts.contacts;
  const bool within = law >= between_cells_, remembers = laws_[law].remembers();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const TriangleContact& contact = contacts[c];
    if (contact.distance > laws_[law].cutoff() || contact.within != within ||
        !acts_between(interactions_[law], own.type, surfaces.cells[contact.other].type))
      continue;
    scratch.chosen.push_back(static_cast<int>(c));
    if (remembers) scratch.values.key.push_back({contact.node - own.first, contact.other, contact.shift});
  }
  return {0, 0};
}

template <>
void Interactions<3>::make_room_for_reactions(int cell) {
  std::erase_if(reactions_[cell], [](const TouchedCell& touched) { return touched.reactions.empty(); });
  for (TouchedCell& touched : reactions_[cell]) touched.reactions.clear();
}

template <>
void Interactions<3>::act(int cell, Surfaces& surfaces, const Scratch& scratch) {
  const auto weight = half_weight(surfaces, cell);
  std::array<double, 4>& across = across_images_[cell] = {};
  for (std::size_t c = 0; c < scratch.contacts.contacts.size(); ++c) {
    const TriangleContact& contact = scratch.contacts.contacts[c];
    if (scratch.result[c] == 0) continue;
    const Vec<3> force = weight(contact.node) * scratch.result[c] * contact.direction;
    const ImageShift& shift = contact.shift;
    across[0] += shift.y * force.x();
    across[1] += shift.x * force.x(), across[2] += shift.y * force.y(), across[3] += shift.z * force.z();
    for (int k = 0; k < 3; ++k) surfaces.force[k][contact.node] += force[k];
    std::vector<TouchedCell::Reaction>& reactions = TouchedCell::reactions_on(contact.other, reactions_[cell]);
    for (std::size_t k = 0; k < 3; ++k)
      if (contact.weight[k] != 0) reactions.push_back({contact.corner[k], -contact.weight[k] * force});
  }
}

// In the order of the cells that they come from; each worker those on the cells that it goes on with.
template <>
void Interactions<3>::take_reactions(Worker worker, Surfaces& surfaces) {
  const Range own = surfaces.numbers_of_known(worker);
  for (const int cell : surfaces.known_cells()) {
    for (const TouchedCell& touched : reactions_[cell]) {
      if (touched.cell < own.begin || touched.cell >= own.end || !surfaces.owns(touched.cell)) continue;
      for (const auto& [node, force] : touched.reactions)
        for (int k = 0; k < 3; ++k) surfaces.force[k][node] += force[k];
    }
  }
}

template class Interactions<2>;
template class Interactions<3>;

}  // namespace rouleau::core
