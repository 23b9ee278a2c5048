#include "aggregate_history.hpp"

#include <algorithm>

namespace rouleau::observe {

void AggregateHistory::follow(const Snapshot& snapshot) {
  if (snapshot.cells.empty()) return;
  AggregateEvent event{snapshot.strain, snapshot.time, snapshot.aggregate_count, {}, false};
  std::vector<int> slot(snapshot.cells.size(), -1);
  for (const CellSnapshot& cell : snapshot.cells) {
    int& s = slot[cell.aggregate];
    if (s < 0) {
      s = static_cast<int>(event.members.size());
      event.members.emplace_back();
    }
    event.members[s].push_back(cell.cell);
    event.through_image = event.through_image || cell.through_image;
  }
  const bool changed =
      events_.empty() || events_.back().members != event.members || events_.back().through_image != event.through_image;
  if (!changed) return;
  if (snapshot.cells.size() > most_cells_remembered && events_.size() > 1) events_.back().members = {};
  events_.push_back(std::move(event));
}

int AggregateHistory::rouleaux() const {
  if (events_.empty()) return 0;
  const auto& members = events_.back().members;
  return static_cast<int>(std::count_if(members.begin(), members.end(), [](const auto& m) { return m.size() > 1; }));
}

}  // namespace rouleau::observe
