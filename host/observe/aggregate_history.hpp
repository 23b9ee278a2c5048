// How cells come close and part: one event for each change.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "aggregates.hpp"
#include "snapshot.hpp"

namespace rouleau::observe {

class AggregateHistory {
 public:
  /// Adds an event if aggregates of two cells or more or contacts across the periodic border differ from those before.
  /// Of many cells (most_cells_remembered) only the first and the last event keep their members. `attracting`: pairs of
  /// cell types whose contacts join them.
  void follow(const Snapshot& snapshot, const std::vector<std::array<std::string, 2>>& attracting = {});
  [[nodiscard]] const std::vector<AggregateEvent>& events() const { return events_; }
  /// Aggregates at the last snapshot, single cells included.
  [[nodiscard]] int count() const { return count_; }
  /// Those of two cells or more that are joined, where cells attract each other.
  [[nodiscard]] int rouleaux() const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(AggregateHistory, events_, images_, count_)

 private:
  using Images = std::vector<std::array<int, 3>>;
  std::vector<std::array<int, 2>> follow_images(const std::vector<ContactSnapshot>& contacts);

  std::map<std::pair<int, int>, Images>
      images_;  ///< of attracting pairs, of the second cell, when they were last close
  std::vector<AggregateEvent> events_;
  int count_ = 0;
};

}  // namespace rouleau::observe
