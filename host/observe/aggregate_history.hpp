// How aggregates form and come apart: one event for each change.
#pragma once

#include <vector>

#include "aggregate_event.hpp"
#include "snapshot.hpp"

namespace rouleau::observe {

class AggregateHistory {
 public:
  /// Adds an event if members or contacts across the periodic border differ from those before. Of many cells
  /// (most_cells_remembered) only the first and the last event keep their members.
  void follow(const Snapshot& snapshot);
  [[nodiscard]] const std::vector<AggregateEvent>& events() const { return events_; }
  /// Aggregates at the last snapshot, single cells included.
  [[nodiscard]] int count() const { return events_.empty() ? 0 : events_.back().count; }
  /// Those of two cells or more.
  [[nodiscard]] int rouleaux() const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(AggregateHistory, events_)

 private:
  std::vector<AggregateEvent> events_;
};

}  // namespace rouleau::observe
