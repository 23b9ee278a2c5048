// Observables of blood rheology on states whose answers are known.
#include "observe/rheology.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>

#include "observe/rheology_history.hpp"

using namespace rouleau::core;
using namespace rouleau::observe;

namespace {

/// A snapshot of as many cells as there are labels of what bonds join. All are close to each other.
Snapshot at(int stage, double strain, double time, const std::vector<int>& label) {
  Snapshot s;
  s.stage = stage;
  s.stage_name = "stage " + std::to_string(stage);
  s.strain = strain;
  s.time = time;
  s.aggregate_sizes = aggregate_sizes(label);
  s.aggregate_size_number_mean = number_mean(s.aggregate_sizes);
  s.aggregate_size_weight_mean = weight_mean(s.aggregate_sizes);
  for (const int l : label) {
    CellSnapshot cell{};
    cell.cell = static_cast<int>(s.cells.size());
    cell.bonded = l;
    s.cells.push_back(cell);
  }
  return s;
}

}  // namespace

TEST_CASE("aggregates are counted by size, with the two means") {
  const auto sizes = aggregate_sizes({0, 0, 2, 3, 3, 3, 6, 7});
  CHECK(sizes == std::map<int, int>{{1, 3}, {2, 1}, {3, 1}});
  CHECK(number_mean(sizes) == 8.0 / 5);
  CHECK(weight_mean(sizes) == (3.0 + 4 + 9) / 8);
  CHECK(std::isnan(number_mean({})));
  CHECK(std::isnan(weight_mean({})));
}

TEST_CASE("turned by an eighth of a turn the shear stress is half of the first normal stress difference") {
  using namespace rouleau;
  scene::Scene scene;
  scene.domain.size = scene::Vector::filled(2, 100e-6);
  scene.domain.nodes = {100, 100};
  scene.domain.periodic[1] = true;
  scene.fluid.viscosity = 1;
  scene::CellType& type = scene.cell_types.emplace_back();
  type.name = "a", type.shape = scene::Circle{1}, type.segments = 3, type.interior_viscosity = 5;
  const auto turned = [&](double angle) {
    const std::complex<double> turn = std::polar(1.0, angle);
    core::Membranes m;
    m.cells.push_back({{0, 3}, 0, 0, 0});
    // A triangle, forces that have no sum, and velocities.
    const std::complex<double> place[] = {{2, 1}, {9, 3}, {4, 8}}, force[] = {{0.3, -0.2}, {-0.7, 0.4}, {0.4, -0.2}},
                               velocity[] = {{0.1, 0.05}, {-0.02, 0.3}, {0.2, -0.1}};
    for (int k = 0; k < 3; ++k) {
      m.position[0].push_back((turn * place[k]).real() + 50), m.position[1].push_back((turn * place[k]).imag() + 50);
      m.force[0].push_back((turn * force[k]).real()), m.force[1].push_back((turn * force[k]).imag());
      m.velocity[0].push_back((turn * velocity[k]).real()), m.velocity[1].push_back((turn * velocity[k]).imag());
    }
    return particle_stress(m, scene, 0.7);
  };
  const double eighth = std::numbers::pi / 4;
  // Of a tensor turned by 45 degrees the xy part is (xx - yy) / 2, and xx - yy is -2 xy; that of forces is not symmetric.
  const ParticleStress stress = turned(0), quarter = turned(2 * eighth), half = turned(4 * eighth);
  CHECK(quarter.first == Approx(-stress.first).epsilon(1e-9));
  CHECK(half.first == Approx(stress.first).epsilon(1e-9));
  CHECK(half.xy == Approx(stress.xy).epsilon(1e-9));
  const double symmetric = (stress.xy - quarter.xy) / 2;  // the antisymmetric part stays
  CHECK(turned(eighth).first == Approx(-2 * symmetric).epsilon(1e-9));
  CHECK(turned(-eighth).first == Approx(2 * symmetric).epsilon(1e-9));
  CHECK((turned(eighth).xy - turned(-eighth).xy) / 2 == Approx(stress.first / 2).epsilon(1e-9));
  CHECK(std::isnan(stress.second));
  CHECK(std::abs(stress.first) > 1e-5);
}

TEST_CASE("an aggregate has come apart where its members are never together again") {
  RheologyHistory history;
  history.follow(at(0, 0, 0, {0, 1, 2, 3, 4}));
  history.follow(at(0, 0, 7, {0, 0, 0, 3, 3}));  // the end of the first stage: a rouleau of three and a pair
  history.follow(at(1, 1, 7.1, {0, 0, 0, 3, 3}));
  history.follow(at(1, 2, 7.2, {0, 1, 1, 3, 4}));  // both have come apart ...
  history.follow(at(1, 3, 7.3, {0, 0, 0, 3, 4}));  // ... but the rouleau meets again
  history.follow(at(1, 4, 7.4, {0, 0, 2, 3, 4}));
  history.follow(at(1, 5, 7.5, {0, 1, 2, 3, 4}));
  const auto stages = history.stages();
  REQUIRE(stages.size() == 2);
  CHECK(stages[0]["dissociation"].empty());
  const auto& dissociation = stages[1]["dissociation"];
  REQUIRE(dissociation.size() == 2);
  CHECK(dissociation[0]["members"] == std::vector<int>{0, 1, 2});
  CHECK(dissociation[0]["parted"]["strain"] == 4.0);
  CHECK(dissociation[0]["parted"]["strain_before"] == 3.0);
  CHECK(dissociation[0]["parted"]["time_s"].get<double>() == Approx(0.4));
  CHECK(dissociation[0]["separate"]["strain"] == 5.0);
  CHECK(dissociation[1]["parted"]["strain"] == 2.0);
  CHECK(dissociation[1]["parted"] == dissociation[1]["separate"]);

  history.follow(at(1, 6, 7.6, {0, 1, 2, 3, 3}));
  CHECK(history.stages()[1]["dissociation"][1]["parted"].is_null());
}

TEST_CASE("of very many cells there are means, and nothing of each") {
  RheologyHistory history;
  std::vector<int> labels(most_cells_remembered);
  std::iota(labels.begin(), labels.end(), 0);
  history.follow(at(0, 0, 0, labels));
  CHECK(history.stages()[0]["rotation"].size() == labels.size());
  labels.push_back(0);
  RheologyHistory of_more;
  for (const double strain : {0.0, 1.0, 2.0}) of_more.follow(at(0, strain, strain, labels));
  const auto stage = of_more.stages()[0];
  CHECK(stage["rotation"].empty());
  CHECK(stage["dissociation"].empty());
  CHECK(stage["means"]["outputs"] == 2);
}

TEST_CASE("means in time do not depend on where outputs fall, nor on one that is written twice") {
  const auto mean_of = [](const std::vector<double>& times, double undefined_before) {
    RheologyHistory history;
    for (const double time : times) {
      Snapshot s = at(0, time, time, {0});
      s.relative_viscosity = time < undefined_before ? std::nan("") : 3 - time;
      history.follow(s);
    }
    return history.stages()[0]["means"]["relative_viscosity"];
  };
  for (const std::vector<double>& times : std::vector<std::vector<double>>{
           {0, 0.5, 1, 1.5, 2}, {0, 0.999, 2}, {0, 1.001, 1.4, 2}, {0, 0.5, 0.7, 1.9, 2, 2}, {0, 2}})
    CHECK(mean_of(times, 0)["mean"].get<double>() == Approx(1.5).epsilon(1e-12));
  CHECK(mean_of({0, 0.5, 1.5, 2}, 1.2)["mean"].get<double>() == Approx(1.25).epsilon(1e-12));
  CHECK(mean_of({0, 1, 2}, 1.5)["mean"] == 1.0);
  CHECK(mean_of({0, 1, 2}, 1.5)["deviation"].is_null());
  CHECK(mean_of({0, 1, 2}, 5).is_null());
}

TEST_CASE("a stage says what it knows of a mean, in its own time, and whether its aggregates have parted") {
  RheologyHistory history;
  const auto follow = [&](int stage, double time, double value, std::vector<int> labels) {
    Snapshot s = at(stage, time, time, std::move(labels));
    s.relative_viscosity = value;
    s.flow_rate = std::nan("");
    history.follow(s);
  };
  for (int k = 0; k < 30; ++k) follow(0, 0.1 * k, 7, {0, 0, k < 29 ? 2 : 0});
  CHECK_FALSE(history.parted(0));
  CHECK(history.knows(0, "relative_viscosity", 1e-9));                                   // all alike
  CHECK_FALSE(history.knows(1, "relative_viscosity", 1e9));                              // the next stage has not begun
  const auto noise = [](int k) { return std::fmod(k * std::numbers::phi, 1.0) - 0.5; };  // evenly spread, uncorrelated
  for (int k = 0; k < 400; ++k) follow(1, 3 + 0.5 * k, 2 + noise(k), {0, 0, 0});
  const auto known = history.stages()[1]["statistics"]["relative_viscosity"];
  CHECK(known["verdict"] == "steady");
  CHECK(known["mean"].get<double>() == Approx(2).margin(0.02));
  CHECK(known["from_s"].get<double>() < 100);
  CHECK(history.knows(1, "relative_viscosity", 1.001 * known["standard_error"].get<double>()));
  CHECK_FALSE(history.knows(1, "relative_viscosity", 0.999 * known["standard_error"].get<double>()));
  CHECK_FALSE(history.knows(1, "flow_rate_m2_per_s", 1e9));  // it has no value
  CHECK_FALSE(history.stages()[1]["statistics"].contains("flow_rate_m2_per_s"));
  CHECK_FALSE(history.parted(1));
  follow(1, 300, 2, {0, 1, 1});
  CHECK(history.parted(1));
  CHECK_FALSE(history.parted(2));
  RheologyHistory single;
  for (const double time : {0.0, 1.0}) single.follow(at(0, time, time, {0, 1}));
  CHECK_FALSE(single.parted(0));  // nothing was together
}

TEST_CASE("rates of tank treading and tumbling are those of the last whole turns of the outline") {
  RheologyHistory history;
  // Cell 0 treads with -0.4 rad per strain at a swinging inclination, 1 tumbles like a rigid body, 2 hardly moves.
  for (int k = 0; k <= 400; ++k) {
    const double strain = 0.25 * k, time = strain / 20;
    Snapshot s = at(0, strain, time, {0, 1, 2});
    s.cells[0].tank_treading_angle = 1 - 0.4 * strain + 0.2 * std::sin(0.4 * strain);
    s.cells[0].angle = 0.5;
    s.cells[1].tank_treading_angle = -0.5 * strain;
    s.cells[1].angle = -0.5 * strain + 1;
    s.cells[2].tank_treading_angle = 1e-3 * strain;
    s.cells[2].angle = std::nan("");
    s.relative_viscosity = k % 2 == 0 ? 1.5 : 1.7;
    history.follow(s);
  }
  const auto stage = history.stages()[0];
  const auto& rotation = stage["rotation"];
  // Strain 50 to 100 is 20 rad: 3 whole turns, in which the swing cancels out but for the lines between outputs.
  CHECK(rotation[0]["turns"] == 3);
  CHECK(rotation[0]["tank_treading_rad_per_strain"].get<double>() == Approx(-0.4).epsilon(1e-4));
  CHECK(rotation[0]["tank_treading_rad_per_s"].get<double>() == Approx(-8).epsilon(1e-4));
  CHECK(rotation[0]["tumbling_rad_per_strain"] == 0.0);
  CHECK(rotation[1]["tumbling_rad_per_strain"].get<double>() == Approx(-0.5).epsilon(1e-12));
  CHECK(rotation[1]["tank_treading_rad_per_strain"].get<double>() == Approx(0).margin(1e-12));
  CHECK(rotation[2]["turns"] == 0);
  CHECK(rotation[2]["tank_treading_rad_per_strain"].get<double>() == Approx(1e-3).epsilon(1e-9));

  const auto& means = stage["means"];
  CHECK(means["outputs"] == 201);
  CHECK(means["relative_viscosity"]["mean"].get<double>() == Approx(1.6).epsilon(1e-12));
  CHECK(means["relative_viscosity"]["deviation"].get<double>() == Approx(0.1).epsilon(0.01));
  CHECK(means["aggregate_size_number_mean"]["mean"] == 1.0);
}
