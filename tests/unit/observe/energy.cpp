// The growth of the total energy that EnergyHistory finds in stages at rest.
#include "observe/energy.hpp"

#include <catch2/catch.hpp>

using namespace rouleau::observe;

namespace {

Snapshot with_energy(int stage, double time, double kinetic, double interaction) {
  Snapshot snapshot;
  snapshot.stage = stage;
  snapshot.stage_name = "stage " + std::to_string(stage);
  snapshot.time = time;
  snapshot.energy.kinetic = kinetic;
  snapshot.energy.interaction = interaction;
  snapshot.energy.total = kinetic + interaction;
  return snapshot;
}

}  // namespace

TEST_CASE("the largest growth of the energy at rest is that above the least before") {
  EnergyHistory history;
  CHECK(history.summary()["largest_growth_at_rest_J_per_m"].is_null());
  for (const double total : {5.0, 3.0, 4.0, 2.0, 4.5, 4.0}) history.follow(with_energy(0, total, total, 0), false);
  // Another stage has a least of its own; one that is driven may grow.
  for (const double total : {40.0, 41.0}) history.follow(with_energy(1, 7, total, -40), false);
  for (const double total : {1.0, 1000.0}) history.follow(with_energy(2, 8, total, 0), true);
  const nlohmann::json found = history.summary();
  CHECK(found["largest_growth_at_rest_J_per_m"] == 2.5);
  CHECK(found["largest_growth_at_rest_relative"] == 0.5);
  REQUIRE(found["stages_at_rest"].size() == 2);
  CHECK(found["stages_at_rest"][0]["time_s"] == 4.5);
  CHECK(found["stages_at_rest"][1]["growth_J_per_m"] == 1);
  CHECK(found["stages_at_rest"][1]["relative"].get<double>() == Approx(1.0 / 81));  // of all magnitudes together
  CHECK(found["unknown"].is_null());
}

TEST_CASE("an energy that only falls has not grown, and one that nobody tells is said to be unknown") {
  EnergyHistory history;
  for (const double total : {3.0, 2.0, 2.0, -1.0}) history.follow(with_energy(0, 1, 4, total), false);
  CHECK(history.summary()["largest_growth_at_rest_J_per_m"] == 0);
  CHECK(history.summary()["stages_at_rest"][0]["time_s"].is_null());
  Snapshot silent = with_energy(1, 2, 1, 1);
  silent.energy.total = EnergySnapshot::none;
  silent.energy.unknown = "membrane law x gives no energy";
  history.follow(silent, false);
  CHECK(history.summary()["unknown"] == "membrane law x gives no energy");
  CHECK(history.summary()["stages_at_rest"].size() == 1);
}

TEST_CASE("a history of energies that was kept as text goes on as if it had not been") {
  EnergyHistory whole, first;
  for (const double total : {5.0, 3.0, 4.0}) {
    whole.follow(with_energy(0, 1, total, 0), false);
    first.follow(with_energy(0, 1, total, 0), false);
  }
  EnergyHistory second;
  nlohmann::json(first).get_to(second);
  for (const double total : {2.0, 5.0}) {
    whole.follow(with_energy(0, 2, total, 0), false);
    second.follow(with_energy(0, 2, total, 0), false);
  }
  CHECK(second.summary() == whole.summary());
}
