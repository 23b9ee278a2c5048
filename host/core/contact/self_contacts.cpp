#include "self_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "contact.hpp"
#include "core/domain/exact_sum.hpp"
#include "distance_law.hpp"

namespace rouleau::core {

namespace {

constexpr int block_size = 8;

}  // namespace

SelfContacts::SelfContacts(const Membranes& membranes, std::vector<SelfInteraction> interactions)
    : interactions_(std::move(interactions)), contacts_(membranes.cells.size()) {
  for (const SelfInteraction& interaction : interactions_) {
    const Potential& potential = interaction.potential;
    if (!is_of_distance_alone(potential))
      throw std::invalid_argument("a potential within a membrane depends on the distance alone: " + potential.id);
    const double cutoff = cutoff_of(potential);
    Kind& kind = kinds_.emplace_back(Kind{cutoff, potential.writes("energy"), {}});
    const RestShape& rest = *membranes.types[interaction.type];
    const int count = static_cast<int>(rest.x.size());
    kind.reach.resize(rest.x.size(), {0, 0});
    const double apart = std::numbers::pi / 2 * cutoff;
    for (int node = 0; node < count; ++node) {
      // Begins of segments that are far enough ahead, and ends of those that are far enough behind.
      double along = 0;
      int begin = 0, end = 0;
      for (int segment = 0; segment < count; ++segment) {
        if (along < apart) begin = segment + 1;
        along += rest.rest_length[(node + segment) % count];
        if (rest.rest_perimeter - along >= apart) end = segment + 1;
      }
      if (begin < end) kind.reach[node] = {node + begin, node + end};
    }
  }
}

void SelfContacts::run(Worker worker, Membranes& membranes) {
  const CellNumbers cells = membranes.own_cells(worker);
  for (const int cell : cells) {
    const CellRange& range = membranes.cells[cell];
    const double* weight = membranes.type_of(range).rest_weight.data();
    Contacts& contacts = contacts_.of(cells.first_place());
    for (std::size_t k = 0; k < interactions_.size(); ++k) {
      if (interactions_[k].type != range.type) continue;
      measure(k, cell, membranes, false, contacts);
      for (int i = 0; i < contacts.count; ++i) {
        const int own = contacts.node[i], node = range.first + own;
        const int from = range.first + contacts.closest[own], to = range.next(from);
        const double pull = weight[own] * 0.5 * contacts.law[i] / contacts.distance[i];
        const double x = pull * contacts.toward_x[own], y = pull * contacts.toward_y[own], s = contacts.place[own];
        membranes.force[0][node] += x, membranes.force[1][node] += y;
        membranes.force[0][from] -= (1 - s) * x, membranes.force[1][from] -= (1 - s) * y;
        membranes.force[0][to] -= s * x, membranes.force[1][to] -= s * y;
      }
    }
  }
}

void SelfContacts::find(std::size_t interaction, int cell, const Membranes& membranes, Contacts& contacts) const {
  const CellRange& range = membranes.cells[cell];
  const Kind& kind = kinds_[interaction];
  const int count = range.count;
  const double *x = membranes.position[0].data() + range.first, *y = membranes.position[1].data() + range.first;
  const auto nodes = static_cast<std::size_t>(count);
  if (contacts.square.size() < nodes) {
    for (auto* values :
         {&contacts.square, &contacts.toward_x, &contacts.toward_y, &contacts.place, &contacts.distance, &contacts.law})
      values->resize(nodes);
    contacts.closest.resize(nodes), contacts.node.resize(nodes);
  }
  std::fill(contacts.square.begin(), contacts.square.begin() + count, kind.cutoff * kind.cutoff);
  std::fill(contacts.closest.begin(), contacts.closest.begin() + count, -1);
  const auto wrapped = [&](int i) { return i < count ? i : i - count; };

  contacts.blocks.clear();
  for (int first = 0; first < count; first += block_size) {
    const int end = std::min(first + block_size, count), middle = (first + end) / 2;
    Block& block = contacts.blocks.emplace_back(Block{first, end, x[middle], y[middle], 0});
    for (int i = first; i <= end; ++i)
      block.radius = std::max(block.radius, std::hypot(x[wrapped(i)] - block.x, y[wrapped(i)] - block.y));
  }
  const auto look = [&](int node, int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const int next = wrapped(j + 1);
      const double along_x = x[next] - x[j], along_y = y[next] - y[j];
      const double length2 = along_x * along_x + along_y * along_y;
      const Approach<double> approach(x[node] - x[j], y[node] - y[j], along_x, along_y, length2 > 0 ? 1 / length2 : 0);
      if (!(approach.square < contacts.square[node])) continue;
      contacts.square[node] = approach.square;
      contacts.closest[node] = j;
      contacts.place[node] = approach.along;
      contacts.toward_x[node] = approach.x, contacts.toward_y[node] = approach.y;
    }
  };
  for (const Block& own : contacts.blocks) {
    for (const Block& other : contacts.blocks) {
      const double reach = own.radius + other.radius + kind.cutoff, dx = own.x - other.x, dy = own.y - other.y;
      if (!(dx * dx + dy * dy <= reach * reach)) continue;
      for (int node = own.first; node < own.end; ++node) {
        // Counted from the node on, segments of the block may come before or after the first one of the cell.
        const Reach allowed = kind.reach[node];
        for (const int turn : {0, count})
          look(node, std::max(other.first, allowed.begin - turn), std::min(other.end, allowed.end - turn));
      }
    }
  }
  contacts.count = 0;
  for (int node = 0; node < count; ++node) {
    if (contacts.closest[node] < 0) continue;
    contacts.distance[contacts.count] = std::max(std::sqrt(contacts.square[node]), ContactList::least_distance);
    contacts.node[contacts.count++] = node;
  }
}

/// Sets `law` to the force of the contacts, or their energy.
void SelfContacts::measure(std::size_t interaction, int cell, const Membranes& membranes, bool energy,
                           Contacts& contacts) const {
  find(interaction, cell, membranes, contacts);
  if (contacts.count == 0) return;
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(contacts.count);
  block.time_step = 1;
  block.distance = contacts.distance.data();
  (energy ? block.energy : block.force) = contacts.law.data();
  interactions_[interaction].potential.compute(&block);
}

double SelfContacts::energy(const Membranes& membranes, const Ranks<2>& ranks) const {
  std::vector<ExactSum> sum(1);
  Contacts contacts;
  for (const int cell : membranes.own_cells()) {
    for (std::size_t k = 0; k < interactions_.size(); ++k) {
      if (interactions_[k].type != membranes.cells[cell].type || !kinds_[k].energy) continue;
      measure(k, cell, membranes, true, contacts);
      const double* weight = membranes.type_of(membranes.cells[cell]).rest_weight.data();
      for (int i = 0; i < contacts.count; ++i) sum.front().add(weight[contacts.node[i]] * 0.5 * contacts.law[i]);
    }
  }
  add_up(ranks, sum);
  return sum.front().value();
}

std::string SelfContacts::without_energy() const {
  for (std::size_t k = 0; k < interactions_.size(); ++k)
    if (!kinds_[k].energy) return interactions_[k].potential.id;
  return {};
}

}  // namespace rouleau::core
