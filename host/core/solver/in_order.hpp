// What owners know of their cells, brought to the first rank in the order of the cells, some at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "core/domain/bands.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "ghost_cells.hpp"

namespace rouleau::core {

/// Nodes of a run of cells, about: so many doubles are a band (band_bytes).
inline constexpr int nodes_of_run = static_cast<int>(band_bytes / sizeof(double));

/// Calls take(run, values) on the first rank for one run of cells [run.begin, run.end) after another, until it has had
/// all: `values` are those that add(cell, values) has appended for each of them on its owner, cell after
/// cell; on the first rank of a cell that is not there. All
/// ranks together, at any time when no message is on its way. `ghosts`: whose they are; null: this rank has all. No
/// rank holds more than some runs at a time: one that is faster than the first rank waits for it, as for bands.
template <class V, int D, class Add, class Take>
void give_in_order(const GhostCells<D>* ghosts, const CellNodes& cells, Add add, Take take,
                   int nodes_at_once = nodes_of_run) {
  Transport* const transport = ghosts != nullptr ? ghosts->ranks().transport : nullptr;
  const int own = transport != nullptr ? transport->rank() : 0;
  const auto owner = [&](int cell) { return ghosts != nullptr ? std::max(ghosts->owner(cell), 0) : 0; };
  struct Part {
    std::vector<std::size_t> counts;  // of values, of each of a rank's cells
    std::vector<V> values;
    std::size_t cell = 0, value = 0;  // the next ones
  };
  int sent = 0;
  for (Range run{0, 0}; run.begin < cells.cell_count(); run.begin = run.end) {
    const int first = cells.cells[run.begin].first;
    do {
      ++run.end;
    } while (run.end < cells.cell_count() && cells.cells[run.end].end() - first <= nodes_at_once);
    Part mine;
    std::set<int> others;
    for (int c = run.begin; c < run.end; ++c) {
      if (owner(c) == own) {
        const std::size_t before = mine.values.size();
        add(c, mine.values);
        mine.counts.push_back(mine.values.size() - before);
      } else {
        others.insert(owner(c));
      }
    }
    if (own == 0 && others.empty()) {
      take(run, mine.values);
      continue;
    }
    if (own != 0) {
      if (mine.counts.empty()) continue;
      if (++sent > bands_ahead) static_cast<void>(transport->receive(0));
      transport->send(0, message_of(std::span<const std::size_t>(mine.counts)));
      transport->send(0, message_of(std::span<const V>(mine.values)));
      continue;
    }
    std::map<int, Part> parts;
    parts[0] = std::move(mine);
    for (const int rank : others) {
      parts[rank].counts = values_of<std::size_t>(transport->receive(rank));
      parts[rank].values = values_of<V>(transport->receive(rank));
      transport->send(rank, {});
    }
    std::vector<V> all;
    for (int c = run.begin; c < run.end; ++c) {
      Part& part = parts.at(owner(c));
      const auto from = part.values.begin() + static_cast<std::ptrdiff_t>(part.value);
      const std::size_t count = part.counts[part.cell++];
      all.insert(all.end(), from, from + static_cast<std::ptrdiff_t>(count));
      part.value += count;
    }
    take(run, all);
  }
  for (int k = std::min(sent, bands_ahead); k > 0; --k) static_cast<void>(transport->receive(0));
}

}  // namespace rouleau::core
