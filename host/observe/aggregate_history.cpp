#include "aggregate_history.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "json/shown.hpp"

namespace rouleau::observe {

namespace {

constexpr std::size_t most_cells_with_images = 200;  ///< of more, pairs that have met would fill checkpoints

/// The cells of each label, ascending, in the order of their first ones.
std::vector<std::vector<int>> groups_by(int CellSnapshot::*label, const std::vector<CellSnapshot>& cells) {
  std::vector<std::vector<int>> groups;
  std::map<int, std::size_t> place;
  for (const CellSnapshot& cell : cells) {
    const auto [found, is_new] = place.try_emplace(cell.*label, groups.size());
    if (is_new) groups.emplace_back();
    groups[found->second].push_back(cell.cell);
  }
  return groups;
}

/// Those of two cells or more.
std::vector<std::vector<int>> several(const std::vector<std::vector<int>>& members) {
  std::vector<std::vector<int>> groups;
  std::copy_if(members.begin(), members.end(), std::back_inserter(groups), [](const auto& m) { return m.size() > 1; });
  return groups;
}

}  // namespace

/// Pairs that are close again, but through none of the images through which they were when they were last.
std::vector<std::array<int, 2>> AggregateHistory::follow_images(const std::vector<ContactSnapshot>& contacts) {
  std::map<std::pair<int, int>, Images> now;
  for (const ContactSnapshot& contact : contacts) now[{contact.cell_a, contact.cell_b}].push_back(contact.image);
  std::vector<std::array<int, 2>> met;
  for (auto& [pair, images] : now) {
    Images& before = images_[pair];
    const bool other = !before.empty() && std::none_of(images.begin(), images.end(), [&](const auto& image) {
      return std::find(before.begin(), before.end(), image) != before.end();
    });
    if (other) met.push_back({pair.first, pair.second});
    before = std::move(images);
  }
  return met;
}

void AggregateHistory::follow_lives(const Snapshot& snapshot, std::vector<std::vector<int>> groups) {
  std::vector<int> cells;
  for (const CellSnapshot& cell : snapshot.cells) cells.push_back(cell.cell);
  const auto holds = [](const std::vector<int>& all, const std::vector<int>& some) {
    return std::includes(all.begin(), all.end(), some.begin(), some.end());
  };
  if (lives_.empty() || lives_.back().stage != snapshot.stage_name) {
    lives_.push_back({snapshot.stage_name, {}});
    for (const auto& group : last_) ++lives_.back().of_size[static_cast<int>(group.size())].seen;
  }
  for (const auto& group : last_) {
    Lives& lives = lives_.back().of_size[static_cast<int>(group.size())];
    lives.time += snapshot.time - last_time_;
    if (std::binary_search(groups.begin(), groups.end(), group) || !holds(cells, group)) continue;
    const bool grown = std::any_of(groups.begin(), groups.end(), [&](const auto& now) { return holds(now, group); });
    ++(grown ? lives.grown : lives.broken);
  }
  for (const auto& group : groups)
    if (!std::binary_search(last_.begin(), last_.end(), group))
      ++lives_.back().of_size[static_cast<int>(group.size())].seen;
  last_ = std::move(groups);
  last_time_ = snapshot.time;
}

nlohmann::json AggregateHistory::lifetimes() const {
  auto result = nlohmann::json::array();
  for (const StageLives& stage : lives_) {
    auto sizes = nlohmann::json::array();
    for (const auto& [cells, lives] : stage.of_size) {
      const auto [seen, broken, grown, time] = lives;
      sizes.push_back({{"cells", cells},
                       {"seen", seen},
                       {"broken", broken},
                       {"grown", grown},
                       {"time_s", time},
                       {"break_up_rate_per_s", json::number_or_null(broken / time)},
                       // As of one where none broke.
                       {"standard_error_per_s", json::number_or_null(std::sqrt(std::max(broken, 1)) / time)},
                       {"mean_lifetime_s", json::number_or_null(time / (broken + grown))}});
    }
    result.push_back({{"stage", stage.stage}, {"sizes", std::move(sizes)}});
  }
  return result;
}

void AggregateHistory::follow(const Snapshot& snapshot) {
  count_ = snapshot.aggregate_count;
  if (snapshot.cells.empty()) return;
  const bool through_image = std::any_of(snapshot.cells.begin(), snapshot.cells.end(),
                                         [](const CellSnapshot& cell) { return cell.through_image; });
  AggregateEvent event{snapshot.strain, snapshot.time, snapshot.aggregate_count,
                       groups_by(&CellSnapshot::aggregate, snapshot.cells), through_image};
  if (snapshot.attracts) {
    event.joined = groups_by(&CellSnapshot::bonded, snapshot.cells);
    if (snapshot.cells.size() <= most_cells_remembered) follow_lives(snapshot, several(event.joined));
    if (event.joined == event.members) event.joined.clear();
    if (snapshot.cells.size() <= most_cells_with_images) event.met_images = follow_images(snapshot.bonds);
  }
  // Cells that come alone and leave alone are no change.
  const bool changed = events_.empty() || several(events_.back().members) != several(event.members) ||
                       events_.back().through_image != event.through_image ||
                       several(events_.back().together()) != several(event.together()) || !event.met_images.empty();
  if (!changed) return;
  if (snapshot.cells.size() > most_cells_remembered && events_.size() > 1)
    events_.back().members = events_.back().joined = {};
  events_.push_back(std::move(event));
}

int AggregateHistory::rouleaux() const {
  if (events_.empty()) return 0;
  const auto& members = events_.back().together();
  return static_cast<int>(std::count_if(members.begin(), members.end(), [](const auto& m) { return m.size() > 1; }));
}

}  // namespace rouleau::observe
