// What the messages about cells are made of.
#pragma once

#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/contact/reactions.hpp"
#include "core/domain/transport.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "core/membrane/displacement_watch.hpp"

namespace rouleau::core {

/// Makes a message of values one after another, copied bit by bit.
class Packer {
 public:
  template <class V>
  void operator()(const V* values, std::size_t count) {
    const std::size_t at = message_.size();
    message_.resize(at + count * sizeof(V));
    if (count > 0) std::memcpy(message_.data() + at, static_cast<const void*>(values), count * sizeof(V));
  }
  [[nodiscard]] Message take() { return std::move(message_); }

 private:
  Message message_;
};

/// Takes them out again; throws std::logic_error when there are no more.
class Unpacker {
 public:
  explicit Unpacker(Message message) : message_(std::move(message)) {}
  template <class V>
  void operator()(V* values, std::size_t count) {
    if (count * sizeof(V) > message_.size() - at_) throw std::logic_error("a message about cells ends too early");
    if (count > 0) std::memcpy(static_cast<void*>(values), message_.data() + at_, count * sizeof(V));
    at_ += count * sizeof(V);
  }

 private:
  Message message_;
  std::size_t at_ = 0;
};

// What goes into a message, or comes out of one: `transfer(values, count)` and `message` are a Packer or an Unpacker.

/// Values: an array of all nodes.
template <class Values, class Transfer>
void transfer_nodes(Values& values, const CellRange& cell, Transfer transfer) {
  transfer(values.data() + cell.first, static_cast<std::size_t>(cell.count));
}

template <class Message>
void transfer_reactions(TouchedCell& touched, Message& message) {
  std::size_t count = touched.reactions.size();
  message(&touched.cell, 1), message(&count, 1);
  touched.reactions.resize(count);
  message(touched.reactions.data(), count);
}

/// What the watch of the viscosity remembers of a cell.
template <int D, class Transfer>
void transfer_memory(CellNodes& cells, DisplacementWatch& watch, int cell, Transfer transfer) {
  DisplacementWatch::Memory& memory = watch.memory();
  for (auto& along : along_axes<D>(memory.position)) transfer_nodes(along, cells.cells[cell], transfer);
  transfer(&memory.limit[cell], 1);
  transfer(&memory.bound[cell], 1);
}

/// What laws and potentials remember of it, and what has leaked.
template <int D, class Transfer>
void transfer_state(CellNodes& cells, int cell, Transfer transfer) {
  const CellRange& range = cells.cells[cell];
  for (auto& along : along_axes<D>(cells.force)) transfer_nodes(along, range, transfer);
  if (!cells.area_leakage.empty()) transfer(&cells.area_leakage[cell], 1);
  for (ElementState& state : cells.state) transfer_nodes(state.value, range, transfer);
  for (ContactMemory* memory : {&cells.contacts, &cells.wall_contacts}) {
    if (memory->of_cell.empty()) continue;
    std::vector<ContactState>& contacts = memory->of_cell[cell];
    std::size_t size = contacts.size();
    transfer(&size, 1);
    contacts.resize(size);
    for (ContactState& contact : contacts) {
      transfer(&contact.variable, 1);
      transfer(&contact.other, 1);
      transfer(&contact.shift, 1);
      contact.value.resize(static_cast<std::size_t>(range.count));
      transfer(contact.value.data(), contact.value.size());
    }
  }
}

/// All that there is.
template <int D, class Transfer>
void transfer_cell(CellNodes& cells, DisplacementWatch& watch, int cell, Transfer transfer) {
  for (auto& along : along_axes<D>(cells.position)) transfer_nodes(along, cells.cells[cell], transfer);
  for (auto& along : along_axes<D>(cells.velocity)) transfer_nodes(along, cells.cells[cell], transfer);
  transfer(&cells.largest_step[cell], 1);
  transfer_memory<D>(cells, watch, cell, transfer);
  transfer_state<D>(cells, cell, transfer);
}

/// Gives each of `peers` what transfer(rank, cells, message) packs of the cells in one of its lists; those with an
/// empty list are left out.
template <class Peer, class Transfer>
void send_to_peers(const std::map<int, Peer>& peers, Transport& transport, std::vector<int> Peer::*given,
                   Transfer transfer) {
  for (const auto& [rank, peer] : peers) {
    if ((peer.*given).empty()) continue;
    Packer message;
    transfer(transport.rank(), peer.*given, message);
    transport.send(rank, message.take());
  }
}
/// Takes from each what transfer(rank, cells, message) unpacks of those in one of its lists.
template <class Peer, class Transfer>
void receive_from_peers(const std::map<int, Peer>& peers, Transport& transport, std::vector<int> Peer::*taken,
                        Transfer transfer) {
  for (const auto& [rank, peer] : peers) {
    if ((peer.*taken).empty()) continue;
    Unpacker message(transport.receive(rank));
    transfer(rank, peer.*taken, message);
  }
}

}  // namespace rouleau::core
