// Who is joined to whom, as a history of changes.
#include "observe/aggregate_history.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "observe/aggregates.hpp"

using namespace rouleau::observe;

namespace {

/// labels: of each cell, the smallest cell of its aggregate.
Snapshot snapshot(const std::vector<int>& labels) {
  Snapshot result;
  for (std::size_t cell = 0; cell < labels.size(); ++cell) {
    CellSnapshot entry{};
    entry.cell = static_cast<int>(cell);
    entry.aggregate = labels[cell];
    entry.bonded = entry.cell;
    result.aggregate_count += entry.aggregate == entry.cell ? 1 : 0;
    result.cells.push_back(entry);
  }
  return result;
}

/// Bonds between these cells, as labels of the snapshot's cells have them.
void join(Snapshot& snapshot, const std::vector<ContactSnapshot>& bonds) {
  std::vector<CellContact> pairs;
  for (const ContactSnapshot& bond : bonds) pairs.push_back({bond.cell_a, bond.cell_b, {}, 0, 0});
  const Aggregates joined = find_aggregates(static_cast<int>(snapshot.cells.size()), pairs);
  for (std::size_t k = 0; k < snapshot.cells.size(); ++k) snapshot.cells[k].bonded = joined.label[k];
  snapshot.bonds = bonds;
  snapshot.attracts = true;
}

}  // namespace

TEST_CASE("a rouleau has two cells or more; an aggregate may be a single cell") {
  AggregateHistory history;
  CHECK(history.rouleaux() == 0);
  history.follow(snapshot({0, 1, 2, 3}));
  CHECK(history.count() == 4);
  CHECK(history.rouleaux() == 0);
  history.follow(snapshot({0, 0, 2, 3}));
  CHECK(history.count() == 3);
  CHECK(history.rouleaux() == 1);
  history.follow(snapshot({0, 1, 1, 0}));
  CHECK(history.count() == 2);
  CHECK(history.rouleaux() == 2);
  history.follow(snapshot({0, 0, 0, 0}));
  CHECK(history.rouleaux() == 1);
  CHECK(history.events().size() == 4);
}

TEST_CASE("of many cells the first and the last event alone keep who is joined to whom") {
  AggregateHistory history;
  std::vector<int> labels(most_cells_remembered + 1);
  std::iota(labels.begin(), labels.end(), 0);
  for (const int joined : {1, 2, 3, 4}) {
    labels[joined] = 0;
    history.follow(snapshot(labels));
    history.follow(snapshot(labels));  // nothing has changed
  }
  REQUIRE(history.events().size() == 4);
  const auto& events = history.events();
  const int all = static_cast<int>(labels.size());
  for (int k = 0; k < 4; ++k) CHECK(events[k].count == all - 1 - k);
  CHECK(events[0].members.size() == labels.size() - 1);
  CHECK(events[1].members.empty());
  CHECK(events[2].members.empty());
  CHECK(events[3].members.front() == std::vector<int>{0, 1, 2, 3, 4});
  CHECK(history.rouleaux() == 1);
}

TEST_CASE("only what bonds join is joined, and a pair that meets through an image has parted") {
  Snapshot both = snapshot({0, 0, 0});
  const auto touching = [](int a, int b, int image) { return ContactSnapshot{a, b, {image, 0, 0}, 1e-7, 1e-6}; };
  both.contacts = {touching(0, 1, 0), touching(1, 2, 0)};
  AggregateHistory mixed, repelling;
  repelling.follow(both);
  CHECK(repelling.events()[0].joined.empty());
  CHECK(repelling.lifetimes().empty());
  join(both, {touching(0, 1, 0)});
  mixed.follow(both);
  CHECK(mixed.events()[0].together() == std::vector<std::vector<int>>{{0, 1}, {2}});
  CHECK(mixed.rouleaux() == 1);

  both.bonds[0].image = {-1, 0, 0};
  mixed.follow(both);
  REQUIRE(mixed.events().size() == 2);
  CHECK(mixed.events()[1].met_images == std::vector<std::array<int, 2>>{{0, 1}});
  both.bonds.push_back(touching(0, 1, 0));  // by both images at once: it has not parted
  mixed.follow(both);
  CHECK(mixed.events().size() == 2);
  CHECK(nlohmann::json(mixed).get<AggregateHistory>().events().size() == 2);
}

TEST_CASE("aggregates live from the first output with their members to the first without, and break or grow") {
  AggregateHistory history;
  const auto at = [&](double time, const std::string& stage, std::vector<std::array<int, 2>> pairs, int cells = 4) {
    std::vector<int> labels(cells);
    std::iota(labels.begin(), labels.end(), 0);
    Snapshot s = snapshot(labels);
    s.time = time;
    s.stage_name = stage;
    std::vector<ContactSnapshot> bonds;
    for (const auto& [a, b] : pairs) bonds.push_back({a, b, {}, 1e-7});
    join(s, bonds);
    history.follow(s);
    history = nlohmann::json(history).get<AggregateHistory>();
  };
  at(0, "rest", {});
  at(1, "rest", {{0, 1}, {2, 3}});
  at(3, "rest", {{0, 1}, {1, 2}, {2, 3}});  // both pairs have grown
  at(4, "shear", {{0, 1}, {1, 2}});         // the four broke in the first second of the stage
  at(6, "shear", {{0, 1}});
  at(7, "shear", {}, 1);  // all others have left: that is no break-up
  const nlohmann::json lives = history.lifetimes();
  REQUIRE(lives.size() == 2);
  CHECK(lives[0]["stage"] == "rest");
  const auto size = [&](int stage, int k) { return lives[stage]["sizes"][k]; };
  CHECK(size(0, 0)["cells"] == 2);
  CHECK(size(0, 0)["seen"] == 2);
  CHECK(size(0, 0)["grown"] == 2);
  CHECK(size(0, 0)["broken"] == 0);
  CHECK(size(0, 0)["time_s"] == 4);
  CHECK(size(0, 0)["mean_lifetime_s"] == 2);
  CHECK(size(0, 0)["break_up_rate_per_s"] == 0);
  CHECK(size(0, 0)["standard_error_per_s"] == 0.25);
  CHECK(size(0, 1)["cells"] == 4);
  CHECK(size(0, 1)["mean_lifetime_s"].is_null());
  CHECK(size(1, 0)["seen"] == 1);
  CHECK(size(1, 0)["time_s"] == 1);
  CHECK(size(1, 0)["broken"] == 0);
  CHECK(size(1, 1)["cells"] == 3);
  CHECK(size(1, 1)["broken"] == 1);
  CHECK(size(1, 1)["break_up_rate_per_s"] == 0.5);
  CHECK(size(1, 2)["cells"] == 4);
  CHECK(size(1, 2)["seen"] == 1);
  CHECK(size(1, 2)["break_up_rate_per_s"] == 1);
}

TEST_CASE("aggregates are said as rouleaux and single cells") {
  using rouleau::observe::aggregates_in_words;
  CHECK(aggregates_in_words({1, 1, 1, 1}) == "4 single cells");
  CHECK(aggregates_in_words({1}) == "1 single cell");
  CHECK(aggregates_in_words({4}) == "a rouleau of 4 cells");
  CHECK(aggregates_in_words({1, 2, 3}) == "rouleaux of 3 and 2 cells and 1 single cell");
  CHECK(aggregates_in_words({2, 2, 3, 7, 5, 1, 1}) == "5 rouleaux of 2 to 7 cells and 2 single cells");
}
