// What a run says about the rheology of its suspension over time: means, break-up of aggregates, tank treading.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "aggregates.hpp"
#include "json/json.hpp"
#include "snapshot.hpp"
#include "statistics.hpp"

namespace rouleau::observe {

/// Follows the snapshots of a run. Costs nothing between them. Of more than most_cells_remembered cells there are means
/// alone.
class RheologyHistory {
 public:
  void follow(const Snapshot& snapshot);

  /// One object for each stage that has been seen, in order:
  ///   stage              its name
  ///   means              over the second half of the stage, {from_s, outputs, and for each column of series.csv that
  ///                      has_means (observables.hpp) {mean, deviation}}: mean in time, by straight lines between
  ///                      outputs that have a value, and standard deviation of the outputs; null where none has one
  ///   statistics         of each of these columns that has a value: Statistics, in time from the start of the stage
  ///   dissociation       of each aggregate, by bonds, of two or more cells at the stage's start, {members, parted,
  ///                      separate}; each of the two {strain, strain_before, time_s} from the start of the stage, or
  ///                      null: at `strain` the output after which its members never again were all in one aggregate
  ///                      (parted), or no two of them in one (separate); `strain_before`: the output before that one.
  ///                      Once one of them has left the domain nothing more is said of an aggregate
  ///   rotation           of each cell at the end, {cell, turns, strain, time_s, tank_treading_rad_per_strain,
  ///                      tumbling_..., tank_treading_rad_per_s, tumbling_...}: mean rates of the outline about the
  ///                      centroid relative to the long axis, and of the long axis, over the last whole turns of the
  ///                      outline (as many as fit into the second half, one if there is one at all; turns 0: over the
  ///                      second half)
  [[nodiscard]] nlohmann::json stages() const;
  /// Whether a stage, if it is the present one, has been steady for so long that the mean of a column is known so well.
  [[nodiscard]] bool knows(int stage, std::string_view column, double standard_error) const;
  /// Whether a stage, if it is the present one, began with two or more cells that bonds joined, and joins no such
  /// aggregate as a whole any more.
  [[nodiscard]] bool parted(int stage) const;
  /// Whether what it remembers has a value for each column that has means: one of another version may not.
  [[nodiscard]] bool fits() const;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RheologyHistory, stages_, stage_, start_strain_, start_time_)

 private:
  struct Instant {
    double strain, time;         ///< since the start of the stage
    std::vector<double> values;  ///< of the observables that have means
    // Of each cell that is remembered.
    std::vector<int> cell;             ///< ascending
    std::vector<int> label;            ///< CellSnapshot::bonded
    std::vector<double> marker, axis;  ///< rad, continuous
    [[nodiscard]] bool has(int number) const { return std::binary_search(cell.begin(), cell.end(), number); }
    [[nodiscard]] std::size_t place(int number) const { return place_of(number, cell); }
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Instant, strain, time, values, cell, label, marker, axis)
  };
  struct StageHistory {
    std::string name;
    std::vector<Instant> instants;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(StageHistory, name, instants)
  };
  static nlohmann::json means(const StageHistory& stage);
  static nlohmann::json statistics(const StageHistory& stage);
  static Statistics statistics(const StageHistory& stage, std::size_t column);
  static nlohmann::json dissociation(const StageHistory& stage);
  static nlohmann::json rotation(const StageHistory& stage);

  std::vector<StageHistory> stages_;
  int stage_ = -1;
  double start_strain_ = 0, start_time_ = 0;
};

}  // namespace rouleau::observe
