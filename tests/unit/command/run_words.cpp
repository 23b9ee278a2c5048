// What a run says of itself at its end.
#include "command/run_words.hpp"

#include <catch2/catch.hpp>

using rouleau::command::closing;
using Json = nlohmann::json;

namespace {

using Groups = std::vector<std::vector<int>>;

Json event(double strain, double time, const Groups& members) {
  return {{"strain", strain}, {"time_s", time}, {"count", members.size()}, {"members", members}};
}

Json summary_with(const std::vector<Json>& history) {
  return {{"outcome", "completed after 1000 steps"},
          {"status", "completed"},
          {"wall_s", 15.2},
          {"threads", 1},
          {"mlups", 1322.4},
          {"simulated_time_s", 7.75},
          {"strain", 15.0},
          {"aggregate_history", history},
          {"rheology", Json::array()},
          {"contacts", {{"close_below_m", 7.5e-7}, {"attracting", Json::array({{"rbc", "rbc"}})}}},
          {"conservation", {{"area_drift_max", 0.00104}}}};
}

const Groups apart{{0}, {1}, {2}, {3}}, together{{0, 1, 2, 3}}, middle{{0}, {1, 2}, {3}};

std::string aggregation(const std::vector<Json>& history) { return closing(summary_with(history)).at(1); }

}  // namespace

TEST_CASE("a run says how it ended, what it cost, when the largest rouleau formed and broke, and the physics") {
  Json summary = summary_with({event(0, 0, apart), event(0, 0.35, Groups{{0, 1}, {2, 3}}), event(0, 2.1, together),
                               event(8.75, 7.44, middle), event(10, 7.5, apart), event(12.5, 7.625, middle),
                               event(13, 7.65, apart)});
  summary["rheology"] = {
      {{"stage", "rest"}, {"statistics", Json::object()}},
      {{"stage", "shear"},
       {"statistics",
        {{"relative_viscosity", {{"verdict", "steady"}, {"mean", 1.17471}, {"bar_95", 0.0309}, {"from_s", 0.25}}}}}}};
  CHECK(closing(summary) ==
        std::vector<std::string>{
            "completed after 1000 steps in 15 s (1 thread, 1322 MLUPS): 7.75 s simulated, strain 15",
            "rouleau of 4 at 2.1 s; broke at strain 8.75; all single from strain 13",
            "relative viscosity 1.17 +- 0.04 (95 %; of chance, not of the lattice) in shear from 0.25 s on; largest "
            "area drift 0.1 %"});
  Json& known = summary["rheology"][1]["statistics"]["relative_viscosity"];
  known["mean"] = nullptr;
  known["verdict"] = "not steady: it rises or falls all the time";
  CHECK(closing(summary).back() ==
        "no mean of the relative viscosity in shear: not steady: it rises or falls all the time; largest area drift "
        "0.1 %");
}

TEST_CASE("what becomes of a rouleau is said as it happened") {
  CHECK(aggregation({event(0, 0, together)}) == "rouleau of 4 from the start; still whole at the end");
  CHECK(aggregation({event(0, 0, apart)}) == "the cells never join: all 4 stay single");
  CHECK(aggregation({event(0, 0, together), event(3, 1, middle)}) ==
        "rouleau of 4 from the start; broke at strain 3; a rouleau of 2 cells and 2 single cells at the end");
  CHECK(aggregation({event(0, 0, together), event(3, 1, {{0, 3}, {1, 2}})}) ==
        "rouleau of 4 from the start; broke at strain 3; rouleaux of 2 and 2 cells at the end");
  CHECK(aggregation({event(0, 0, together), event(3, 1, {{2}, {0, 1, 3}})}) ==
        "rouleau of 4 from the start; broke at strain 3; a rouleau of 3 cells and 1 single cell at the end");
  Groups all(1), parts{{10, 11, 12}};
  for (int cell = 0; cell < 13; ++cell) all.front().push_back(cell);
  for (int cell = 0; cell < 10; cell += 2) parts.push_back({cell, cell + 1});
  CHECK(aggregation({event(0, 0, all), event(3, 1, parts)}) ==
        "rouleau of 13 from the start; broke at strain 3; 6 rouleaux of 2 to 3 cells at the end");
  // A gap that closes again is no end of it, but it is not whole all the time.
  CHECK(aggregation({event(0, 0, together), event(3, 1, middle), event(4, 2, together)}) ==
        "rouleau of 4 from the start; broke at strain 3; whole again from strain 4");
  // Cells driven by pressure have no strain: the time says when.
  CHECK(aggregation({event(0, 0, together), event(0, 1.25, middle), event(0, 2, apart)}) ==
        "rouleau of 4 from the start; broke at 1.25 s; all single from 2 s");
}

TEST_CASE("two cells that part and meet through an image have not stayed together") {
  const Groups pair{{0, 1}}, single{{0}, {1}};
  Json met = event(11, 3, pair);
  met["met_images"] = Groups{{0, 1}};
  CHECK(aggregation({event(0, 0, pair), event(9, 2, single), met}) ==
        "rouleau of 2 from the start; broke at strain 9; whole again from strain 11 by an image of itself: the box is "
        "too short");
  CHECK(aggregation({event(0, 0, pair), met}) ==
        "rouleau of 2 from the start; parted before strain 11, where it met an image of itself: the box is too short");
}

TEST_CASE("cells that nothing attracts are close, and never a rouleau") {
  const auto words = [](const std::vector<Json>& history) {
    Json summary = summary_with(history);
    summary["contacts"]["attracting"] = Json::array();
    return closing(summary).at(1);
  };
  CHECK(words({event(0, 0, together)}) ==
        "at most 4 of 4 cells were close, with gaps below 0.75 um; nothing attracts them to each other");
  CHECK(words({event(0, 0, apart), event(3, 1, middle)}) ==
        "at most 2 of 4 cells were close, with gaps below 0.75 um; nothing attracts them to each other");
  CHECK(words({event(0, 0, apart)}) == "no two cells came closer than 0.75 um");
  // Of a mixture only those are joined that attract each other, whoever else is close.
  Json mixed = event(0, 0, together);
  mixed["joined"] = middle;
  CHECK(aggregation({mixed}) == "rouleau of 2 from the start; still whole at the end");
}

TEST_CASE("a fluid without cells, or with one, says nothing of aggregates") {
  CHECK(closing(summary_with({})).size() == 1);
  CHECK(closing(summary_with({event(0, 0, Groups(1, {0}))})) ==
        std::vector<std::string>{closing(summary_with({})).front(), "largest area drift 0.1 %"});
}
