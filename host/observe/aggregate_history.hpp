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
  /// Of many cells (most_cells_remembered) only the first and the last event keep their members; they have no
  /// lives.
  void follow(const Snapshot& snapshot);
  [[nodiscard]] const std::vector<AggregateEvent>& events() const { return events_; }
  /// Aggregates at the last snapshot, single cells included.
  [[nodiscard]] int count() const { return count_; }
  /// Those of two cells or more that are joined, where cells attract each other.
  [[nodiscard]] int rouleaux() const;
  /// Of each stage {stage, sizes}, of each number of joined cells {cells, seen, broken, grown, time_s,
  /// break_up_rate_per_s, standard_error_per_s, mean_lifetime_s}: aggregates with the same members, from the first
  /// output with them to the first without. Broken: their members are not all in one; grown: they are, with others.
  /// Those of which a cell has left the domain, or that are there at the end, count with their time alone.
  [[nodiscard]] nlohmann::json lifetimes() const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE_WITH_DEFAULT(AggregateHistory, events_, images_, count_, lives_, last_, last_time_)

 private:
  struct Lives {
    int seen = 0, broken = 0, grown = 0;
    double time = 0;  ///< s, of all together
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Lives, seen, broken, grown, time)
  };
  struct StageLives {
    std::string stage;
    std::map<int, Lives> of_size;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(StageLives, stage, of_size)
  };
  void follow_lives(const Snapshot& snapshot, std::vector<std::vector<int>> groups);

  using Images = std::vector<std::array<int, 3>>;
  std::vector<std::array<int, 2>> follow_images(const std::vector<ContactSnapshot>& contacts);

  std::map<std::pair<int, int>, Images>
      images_;  ///< of attracting pairs, of the second cell, when they were last close
  std::vector<StageLives> lives_;
  std::vector<std::vector<int>> last_;  ///< joined, at the last snapshot, ascending
  double last_time_ = 0;
  std::vector<AggregateEvent> events_;
  int count_ = 0;
};

}  // namespace rouleau::observe
