// Numbers that blocks keep for each other, and the only way across the border between two blocks.
#pragma once

#include <algorithm>
#include <cstring>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

#include "ranks.hpp"

namespace rouleau::core {

/// A block's copy of a number that another block owns: number `component` of a node outside the block, which lies in
/// nodes of the lattice, not wrapped.
template <int D>
struct HaloCopy {
  std::array<int, D> node;
  int component;
};

/// Which way numbers go: from their owners to the copies, or from the copies home.
enum class Way { out, home };

/// The copies of one kind of number. Every rank finds out for itself what it has to send, from the blocks of all.
template <class T, int D>
class Halo {
 public:
  /// `copies(domain)`: those that the block of a domain keeps, in an order of its own; nodes beyond walls have none.
  /// `offset(node)`: of a node, in or around this block, in the arrays that begin() and end() are given.
  /// `early(node)`: whether its numbers are known before the others; none: all are known at once.
  Halo(const Ranks<D>& ranks, const std::function<std::vector<HaloCopy<D>>(const Domain<D>&)>& copies,
       const std::function<std::ptrdiff_t(const std::array<int, D>& node)>& offset,
       const std::function<bool(const std::array<int, D>& node)>& early = {})
      : transport_(ranks.transport), peers_(static_cast<std::size_t>(ranks.blocks->ranks())) {
    const Decomposition<D>& blocks = *ranks.blocks;
    const int own = transport_->rank();
    for (int rank = 0; rank < blocks.ranks(); ++rank) {
      const Domain<D> domain = blocks.domain(rank);
      std::vector<HaloCopy<D>> of_rank = copies(domain);
      // One component after another: along rows of the lattice numbers then lie beside each other.
      std::stable_sort(of_rank.begin(), of_rank.end(),
                       [](const HaloCopy<D>& a, const HaloCopy<D>& b) { return a.component < b.component; });
      for (const HaloCopy<D>& copy : of_rank) {
        std::array<int, D> node = copy.node;
        for (int k = 0; k < D; ++k) node[k] = domain.wrapped(k, node[k]);
        const int owner = blocks.owner(node);
        const auto add = [&](Peer& peer, Places& places, const std::array<int, D>& at) {
          places.add(copy.component, offset(at));
          peer.early = peer.early && early && early(at);
        };
        if (owner == own) add(peers_[rank], peers_[rank].owned, node);
        if (rank == own) add(peers_[owner], peers_[owner].copies, copy.node);
      }
    }
  }

  /// Whether all that a rank is sent is known early.
  [[nodiscard]] bool early(std::size_t rank) const { return peers_[rank].early; }
  /// Sends what goes this way, to the ranks that `wanted` holds for. `arrays[c]`: where component c of the node with
  /// offset 0 lies.
  template <class Wanted>
  void begin(Way way, std::span<T* const> arrays, Wanted wanted) {
    for (std::size_t rank = 0; rank < peers_.size(); ++rank) {
      if (!wanted(rank)) continue;
      const Places& from = way == Way::out ? peers_[rank].owned : peers_[rank].copies;
      if (from.count == 0) continue;
      Message message(from.count * sizeof(T));
      from.for_runs(message.data(), [&](std::byte* to, const Run& run, auto count) {
        std::memcpy(to, arrays[run.component] + run.offset, count * sizeof(T));
      });
      transport_->send(static_cast<int>(rank), std::move(message));
    }
  }
  void begin(Way way, std::span<T* const> arrays) {
    begin(way, arrays, [](std::size_t) { return true; });
  }
  /// Waits for what goes this way, and puts it where it belongs.
  void end(Way way, std::span<T* const> arrays) {
    for (std::size_t rank = 0; rank < peers_.size(); ++rank) {
      const Places& to = way == Way::out ? peers_[rank].copies : peers_[rank].owned;
      if (to.count == 0) continue;
      const Message message = transport_->receive(static_cast<int>(rank));
      to.for_runs(message.data(), [&](const std::byte* from, const Run& run, auto count) {
        std::memcpy(arrays[run.component] + run.offset, from, count * sizeof(T));
      });
    }
  }

  /// How many numbers this rank keeps for others.
  [[nodiscard]] std::size_t size() const {
    std::size_t copies = 0;
    for (const Peer& peer : peers_) copies += peer.copies.count;
    return copies;
  }

 private:
  /// Numbers that lie beside each other.
  struct Run {
    int component, count;
    std::ptrdiff_t offset;
  };
  struct Places {
    std::vector<Run> runs;
    std::size_t count = 0;

    void add(int component, std::ptrdiff_t offset) {
      ++count;
      if (!runs.empty() && runs.back().component == component && runs.back().offset + runs.back().count == offset) {
        ++runs.back().count;
      } else {
        runs.push_back({component, 1, offset});
      }
    }
    /// Calls function(bytes, run, run.count) for all runs and where they lie in a message. A number alone is common,
    /// and cheaper when the compiler knows it.
    template <class Bytes, class Function>
    void for_runs(Bytes* bytes, Function function) const {
      for (const Run& run : runs) {
        if (run.count == 1) {
          function(bytes, run, std::integral_constant<std::size_t, 1>{});
        } else {
          function(bytes, run, static_cast<std::size_t>(run.count));
        }
        bytes += static_cast<std::size_t>(run.count) * sizeof(T);
      }
    }
  };
  struct Peer {
    Places owned;   // by this rank, of which the peer keeps copies
    Places copies;  // kept here of what the peer owns
    bool early = true;
  };
  Transport* transport_;
  std::vector<Peer> peers_;  // of each rank
};

/// Calls function(node, out) for the nodes around a block, `below` nodes deep on its lower sides and `above` on the
/// upper ones, that the block does not reach by its own periodic images alone and that do not lie beyond a wall. `out`:
/// -1, 0 or 1 along every axis, by where the node lies outside.
template <int D, class Function>
void for_halo_nodes(const Domain<D>& domain, int below, int above, Function function) {
  const Box<D>& block = domain.block;
  std::array<int, D> node;
  for (int k = 0; k < D; ++k) node[k] = block.begin[k] - below;
  const auto next_row = [&] {  // false: that was the last one
    node[0] = block.begin[0] - below;
    for (int k = 1; k < D; ++k) {
      if (++node[k] < block.end[k] + above) return true;
      node[k] = block.begin[k] - below;
    }
    return false;
  };
  do {
    std::array<int, D> inside = node;
    inside[0] = block.begin[0];
    const bool beside = block.contains(inside);
    for (; node[0] < block.end[0] + above; ++node[0]) {
      if (beside && node[0] == block.begin[0]) node[0] = block.end[0];
      std::array<int, D> out{};
      bool foreign = false, wall = false;
      for (int k = 0; k < D; ++k) {
        out[k] = node[k] < block.begin[k] ? -1 : (node[k] >= block.end[k] ? 1 : 0);
        foreign = foreign || (out[k] != 0 && !domain.wraps(k));
        wall = wall || domain.wrapped(k, node[k]) < 0;
      }
      if (foreign && !wall) function(node, out);
    }
  } while (next_row());
}

}  // namespace rouleau::core
