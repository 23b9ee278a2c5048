#include "cell_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cell_messages.hpp"

namespace rouleau::core {

template <int D>
CellExchange<D>::CellExchange(GhostCells<D> ghosts, bool velocities)
    : ranks_(ghosts.ranks()),
      ghosts_(std::move(ghosts)),
      velocities_(velocities),
      path_(static_cast<std::size_t>(ghosts_.cell_count()), 0.0) {}

template <int D>
std::vector<BoundingBox<D>> CellExchange<D>::boxes_of_all(const Cells& cells) const {
  std::vector<BoundingBox<D>> mine, all(cells.cells.size(), BoundingBox<D>::unknown());
  for (int c = 0; c < cells.cell_count(); ++c)
    if (ghosts_.owns(c)) mine.push_back(box_of<D>(cells, c));
  const auto of_ranks = all_of(ranks_, std::move(mine));
  std::vector<std::size_t> next(of_ranks.size());
  for (int c = 0; c < cells.cell_count(); ++c) {
    const int owner = ghosts_.owner(c);
    if (owner == GhostCells<D>::nobody) continue;
    all[c] = of_ranks[owner][next[owner]++];
  }
  return all;
}

template <int D>
void CellExchange<D>::run(Task task, const Parts& parts) {
  switch (task) {
    case Task::send_reactions:
      return send_reactions(*parts.interactions);
    case Task::receive_reactions:
      return receive_reactions(parts.cells, *parts.interactions);
    case Task::send_forces:
      return send_forces(parts.cells, parts.force);
    case Task::receive_forces:
      return receive_forces(parts.cells, parts.force);
    case Task::send_velocities:
      return send_velocities(parts.cells, parts.base);
    case Task::receive_velocities:
      return receive_velocities(parts.cells, parts.base);
    case Task::send_positions:
      return send_positions(parts.cells, parts.viscosity,
                            parts.interactions != nullptr ? &parts.interactions->watch() : nullptr, parts.escaped());
    case Task::receive_positions:
      return receive_positions(parts.cells, parts.viscosity);
    default:
      return;
  }
}

template <int D>
template <class Message>
void CellExchange<D>::transfer_positions(Cells& cells, DisplacementWatch& viscosity, const std::vector<int>& of_peer,
                                         Shown shown, Message& message) {
  for (const int c : of_peer) {
    for (auto& along : along_axes<D>(cells.position)) transfer_nodes(along, cells.cells[c], std::ref(message));
    for (auto& along : along_axes<D>(cells.velocity))
      if (shown.velocities) transfer_nodes(along, cells.cells[c], std::ref(message));
    message(&cells.largest_step[c], 1);
    if (shown.memory) transfer_memory<D>(cells, viscosity, c, std::ref(message));
  }
}

template <int D>
void CellExchange<D>::send_shown(const GhostCells<D>& ghosts, Cells& cells, DisplacementWatch& viscosity, Shown shown) {
  send_to_peers(ghosts.peers(), *ghosts.ranks().transport, &GhostCells<D>::Peer::mine,
                [&](int, const std::vector<int>& of_peer, Packer& message) {
                  transfer_positions(cells, viscosity, of_peer, shown, message);
                });
}

template <int D>
void CellExchange<D>::receive_shown(const GhostCells<D>& ghosts, Cells& cells, DisplacementWatch& viscosity,
                                    Shown shown) {
  receive_from_peers(ghosts.peers(), *ghosts.ranks().transport, &GhostCells<D>::Peer::theirs,
                     [&](int, const std::vector<int>& of_peer, Unpacker& message) {
                       transfer_positions(cells, viscosity, of_peer, shown, message);
                     });
}

template <int D>
void CellExchange<D>::send_positions(Cells& cells, DisplacementWatch& viscosity, DisplacementWatch* lists,
                                     bool escaped) {
  const auto raise = [](double& largest, double value) {
    if (!(value <= largest) && !std::isnan(largest)) largest = value;
  };
  double step = 0, path = 0;
  for (const int c : cells.own_cells()) {
    path_[c] += cells.largest_step[c];
    raise(step, cells.largest_step[c]);
    raise(path, path_[c]);
  }
  const bool expired = lists != nullptr && lists->measure_own(cells);
  const auto [all_step, all_path, all_escaped, all_expired] =
      largest(ranks_, std::array{step, path, escaped ? 1.0 : 0.0, expired ? 1.0 : 0.0});
  with_memory_ = !(all_path <= GhostCells<D>::skin);
  cells.largest_step_of_others = all_step;
  took_over_ = lost_sight_ = false;
  if (with_memory_) {
    const std::vector<BoundingBox<D>> boxes = boxes_of_all(cells);
    hand_over(cells, viscosity, ghosts_.change_owners(boxes));
    ghosts_.renew(boxes);
    std::fill(path_.begin(), path_.end(), 0.0);
    for (const int c : cells.known_cells()) lost_sight_ = lost_sight_ || !ghosts_.knows(c);
    ghosts_.set_parts(cells);
  }
  if (lists != nullptr) lists->agree(with_memory_ || all_expired > 0);
  escaped_ = all_escaped > 0;
  send_shown(ghosts_, cells, viscosity, {velocities_, with_memory_});
  on_their_way_ = true;
}

template <int D>
void CellExchange<D>::receive_positions(Cells& cells, DisplacementWatch& viscosity) {
  if (std::exchange(on_their_way_, false)) receive_shown(ghosts_, cells, viscosity, {velocities_, with_memory_});
}

template <int D>
void CellExchange<D>::hand_over(Cells& cells, DisplacementWatch& viscosity,
                                const std::vector<typename GhostCells<D>::Handover>& handovers) {
  const int own = ranks_.transport->rank();
  std::map<int, Packer> to;
  std::map<int, Unpacker> from;
  for (const auto& handover : handovers)
    if (handover.from == own) transfer_cell<D>(cells, viscosity, handover.cell, std::ref(to[handover.to]));
  for (auto& [rank, message] : to) ranks_.transport->send(rank, message.take());
  for (const auto& handover : handovers) {
    if (handover.to != own) continue;
    auto message = from.find(handover.from);
    if (message == from.end())
      message = from.emplace(handover.from, Unpacker(ranks_.transport->receive(handover.from))).first;
    transfer_cell<D>(cells, viscosity, handover.cell, std::ref(message->second));
    took_over_ = true;
  }
}

template <int D>
void CellExchange<D>::send_reactions(Interactions<D>& interactions) const {
  for (const auto& [rank, peer] : ghosts_.peers()) {
    if (!peer.touch) continue;
    Packer message;
    for (const int c : peer.mine) {
      if constexpr (D == 2) {
        interactions.for_reactions(c, [&, to = rank](int other, double* x, double* y, std::size_t count) {
          if (ghosts_.owner(other) == to) message(x, count), message(y, count);
        });
      } else {
        const auto is_there = [&, to = rank](const TouchedCell& touched) { return ghosts_.owner(touched.cell) == to; };
        std::vector<TouchedCell>& touched = interactions.reactions(c);
        const auto count = static_cast<std::size_t>(std::count_if(touched.begin(), touched.end(), is_there));
        message(&count, 1);
        for (TouchedCell& cell : touched)
          if (is_there(cell)) transfer_reactions(cell, message);
      }
    }
    ranks_.transport->send(rank, message.take());
  }
}

template <int D>
void CellExchange<D>::receive_reactions(const Cells& cells, Interactions<D>& interactions) const {
  for (const auto& [rank, peer] : ghosts_.peers()) {
    if (!peer.touch) continue;
    Unpacker message(ranks_.transport->receive(rank));
    for (const int c : peer.theirs) {
      if constexpr (D == 2) {
        interactions.for_reactions(c, [&](int other, double* x, double* y, std::size_t count) {
          if (cells.owns(other)) message(x, count), message(y, count);
        });
      } else {
        std::size_t count = 0;
        message(&count, 1);
        interactions.reactions(c).resize(count);
        for (TouchedCell& touched : interactions.reactions(c)) transfer_reactions(touched, message);
      }
    }
  }
}

template <int D>
template <class Message>
void CellExchange<D>::transfer_forces(const Cells& cells, const std::array<double*, D>& force,
                                      const std::vector<int>& of_peer, Message& message) {
  for (const int c : of_peer) {
    const CellRange& cell = cells.cells[c];
    for (double* along : force) message(along + cell.first, static_cast<std::size_t>(cell.count));
  }
}

template <int D>
void CellExchange<D>::send_forces(const Cells& cells, const std::array<double*, D>& force) const {
  send_to_peers(ghosts_.peers(), *ranks_.transport, &GhostCells<D>::Peer::mine_there,
                [&](int, const auto& of_peer, auto& message) { transfer_forces(cells, force, of_peer, message); });
}

template <int D>
void CellExchange<D>::receive_forces(const Cells& cells, const std::array<double*, D>& force) const {
  receive_from_peers(ghosts_.peers(), *ranks_.transport, &GhostCells<D>::Peer::theirs_here,
                     [&](int, const auto& of_peer, auto& message) { transfer_forces(cells, force, of_peer, message); });
}

template <int D>
template <class Message>
void CellExchange<D>::transfer_velocities(Cells& cells, const Base& base, int reader, const std::vector<int>& of_peer,
                                          Message& message) const {
  const Box<D> block = ranks_.blocks->domain(reader).block;
  for (const int c : of_peer) {
    for (int i = cells.cells[c].first; i < cells.cells[c].end(); ++i) {
      if (!block.contains(base(i))) continue;
      for (auto& along : along_axes<D>(cells.velocity)) message(along.data() + i, 1);
    }
  }
}

template <int D>
void CellExchange<D>::send_velocities(Cells& cells, const Base& base) const {
  send_to_peers(ghosts_.peers(), *ranks_.transport, &GhostCells<D>::Peer::theirs_here,
                [&](int reader, const auto& of_peer, auto& message) {
                  transfer_velocities(cells, base, reader, of_peer, message);
                });
}

template <int D>
void CellExchange<D>::receive_velocities(Cells& cells, const Base& base) const {
  receive_from_peers(ghosts_.peers(), *ranks_.transport, &GhostCells<D>::Peer::mine_there,
                     [&](int reader, const auto& of_peer, auto& message) {
                       transfer_velocities(cells, base, reader, of_peer, message);
                     });
}

template <int D>
void CellExchange<D>::pass_on(Cells& cells, DisplacementWatch& watch, const GhostCells<D>& next) {
  receive_positions(cells, watch);
  std::vector<typename GhostCells<D>::Handover> handovers;
  for (int c = 0; c < cells.cell_count(); ++c) {
    const bool there = ghosts_.owner(c) != GhostCells<D>::nobody && next.owner(c) != GhostCells<D>::nobody;
    if (there && next.owner(c) != ghosts_.owner(c)) handovers.push_back({c, ghosts_.owner(c), next.owner(c)});
  }
  hand_over(cells, watch, handovers);
  constexpr Shown everything{.velocities = true, .memory = true};
  send_shown(next, cells, watch, everything);
  receive_shown(next, cells, watch, everything);
  next.set_parts(cells);
}

template <int D>
void CellExchange<D>::show_places(Cells& cells, const std::map<int, Sight>& sights) const {
  const auto transfer = [&](int, const std::vector<int>& of_peer, auto& message) {
    for (const int c : of_peer) {
      for (auto& along : along_axes<D>(cells.position)) transfer_nodes(along, cells.cells[c], std::ref(message));
      message(&cells.largest_step[c], 1);
    }
  };
  send_to_peers(sights, *ranks_.transport, &Sight::mine, transfer);
  receive_from_peers(sights, *ranks_.transport, &Sight::theirs, transfer);
}

template class CellExchange<2>;
template class CellExchange<3>;

}  // namespace rouleau::core
