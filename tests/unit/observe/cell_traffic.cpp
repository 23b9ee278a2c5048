// Cells that come in and leave: their number is kept, and what they carry.
#include "observe/cell_traffic.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <stdexcept>

#include "observe/observables.hpp"
#include "scene/scene.hpp"

using namespace rouleau;
using namespace rouleau::observe;

TEST_CASE("cells that came in are inside or have left, and no volume is lost") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937 random(seed);
  CellTraffic traffic;
  traffic.begin_stage("flow");
  double inside = 0;
  std::map<int, double> there;
  int next = 0;
  for (; next < 5; ++next) traffic.came(next, 2, 0, CellTraffic::no_opening), there[next] = 2;
  for (int event = 0; event < 500; ++event) {
    if (there.empty() || random() % 2 == 0) {
      there[next] = 1 + next % 3;
      traffic.came(next, there[next], event, 0), ++next;
    } else {
      const auto gone = std::next(there.begin(), random() % there.size());
      traffic.left(gone->first, event, 1);
      there.erase(gone);
    }
    REQUIRE(traffic.inside() == static_cast<long>(there.size()));
    REQUIRE(traffic.in() + 5 == traffic.inside() + traffic.out());
  }
  for (const auto& [cell, volume] : there) inside += volume;
  const nlohmann::json ends = traffic.summary("m3")["stages"][0]["ends"];
  CHECK(ends[0]["volume_in"].get<double>() + 10 == inside + ends[1]["volume_out"].get<double>());
  CHECK(ends[1]["volume_in"] == 0);
  CHECK_THROWS_AS(traffic.left(next, 0, 1), std::out_of_range);
}

TEST_CASE("residence times are those of cells that came in and left") {
  CellTraffic traffic;
  traffic.begin_stage("flow");
  traffic.came(0, 1, 0, CellTraffic::no_opening);
  CHECK(traffic.summary("m3")["residence_time_s"].is_null());
  traffic.came(1, 1, 2, 0);
  traffic.came(2, 1, 3, 0);
  traffic.came(3, 1, 4, 0);
  traffic.left(0, 10, 1);  // it was there at the start: nobody knows since when
  traffic.left(2, 4, 1);
  traffic.left(1, 7, 0);
  const nlohmann::json found = traffic.summary("m3")["residence_time_s"];
  CHECK(found == nlohmann::json{{"mean", 3.0}, {"least", 1.0}, {"most", 5.0}, {"cells", 2}});
}

TEST_CASE("the discharge hematocrit of an end is net cell volume over all that flowed, stage by stage") {
  CellTraffic traffic;
  traffic.begin_stage("slow");
  CHECK(traffic.summary("m2")["stages"][0]["ends"][0]["discharge_hematocrit"].is_null());
  for (const double in : {0.0, 3.0, 12.0}) traffic.flowed({{{in}, {-in / 3, -2 * in / 3}}});
  traffic.came(0, 2, 1, 0);
  traffic.came(1, 2, 2, 0);
  traffic.left(0, 4, 1, 1);
  traffic.begin_stage("fast");
  traffic.flowed({{{10}, {-4, -6}}});
  traffic.left(1, 5, 1);
  const nlohmann::json stages = traffic.summary("m2")["stages"];
  REQUIRE(stages.size() == 2);
  CHECK(stages[0]["stage"] == "slow");
  CHECK(stages[0]["ends"][0]["flow_in"].get<double>() == Approx(12));
  CHECK(stages[0]["ends"][1]["flow_in"].get<double>() == Approx(-12));
  CHECK(stages[0]["ends"][0]["discharge_hematocrit"].get<double>() == Approx(4.0 / 12));
  CHECK(stages[0]["ends"][1]["discharge_hematocrit"].get<double>() == Approx(2.0 / 12));
  const nlohmann::json& openings = stages[0]["ends"][1]["openings"];
  REQUIRE(openings.size() == 2);
  CHECK(openings[0]["flow_in"].get<double>() == Approx(-4));
  CHECK(openings[0]["discharge_hematocrit"] == 0);
  CHECK(openings[1]["flow_in"].get<double>() == Approx(-8));
  CHECK(openings[1]["discharge_hematocrit"].get<double>() == Approx(2.0 / 8));
  CHECK((openings[0]["cells_out"] == 0 && openings[1]["cells_out"] == 1));
  CHECK_FALSE(stages[0]["ends"][0].contains("openings"));
  CHECK(traffic.come_in() == Approx(22));
  CHECK(stages[1]["ends"][0]["discharge_hematocrit"] == 0);
  CHECK(stages[1]["ends"][1]["discharge_hematocrit"].get<double>() == Approx(0.2));
}

TEST_CASE("a traffic that was kept goes on as if it had not been") {
  CellTraffic whole;
  whole.begin_stage("flow");
  whole.came(0, 1.25, 0, CellTraffic::no_opening);
  whole.came(7, 1.5, 0.25, 0);
  whole.flowed({{{3}, {-2}}});
  CellTraffic restored;
  nlohmann::json::from_cbor(nlohmann::json::to_cbor(whole)).get_to(restored);
  for (CellTraffic* traffic : {&whole, &restored}) {
    traffic->flowed({{{4}, {-4}}});
    traffic->left(7, 1, 1);
    traffic->begin_stage("on");
    traffic->left(0, 2, 0);
  }
  CHECK(nlohmann::json::to_cbor(whole) == nlohmann::json::to_cbor(restored));
  Snapshot snapshot;
  restored.tell(snapshot);
  CHECK((snapshot.cells_in == 1 && snapshot.cells_inside == 0 && snapshot.cells_out == 2));
  CHECK((snapshot.volume_through[0].at(0) == 4 && snapshot.volume_through[1].at(0) == 4));
}

TEST_CASE("series.csv has columns of cells' traffic where cells may come or leave, and nowhere else") {
  const Table& series = table("series");
  const auto without = series.columns({2, true}), with = series.columns({2, true, true});
  REQUIRE(with.size() == without.size() + 3);
  RunKind forked(2, true, true);
  forked.openings = {1, 2};
  const auto beside = series.columns(forked);
  CHECK(std::vector(beside.end() - 5, beside.end()) ==
        std::vector<std::string>{"cells_in", "cells_inside", "cells_out", "outlet_1_cells", "outlet_2_cells"});
  CHECK(std::count(beside.begin(), beside.end(), "outlet_2_flow_m2_per_s") == 1);
  CHECK(std::count(beside.begin(), beside.end(), "inlet_1_flow_m2_per_s") == 0);
  CHECK(std::equal(without.begin(), without.end(), with.begin()));
  CHECK(std::vector(with.end() - 3, with.end()) == std::vector<std::string>{"cells_in", "cells_inside", "cells_out"});
  scene::Scene scene;
  CHECK_FALSE(has_traffic(scene));
  scene.cells.push_back({});
  CHECK_FALSE(has_traffic(scene));
  scene.domain.openings.emplace();
  CHECK(has_traffic(scene));
  scene.cells.clear();
  CHECK_FALSE(has_traffic(scene));
}
