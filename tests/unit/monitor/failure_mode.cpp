#include "monitor/failure_mode.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "monitor/membrane_wave.hpp"
#include "unit/periodic_box.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::monitor;

namespace {

using std::numbers::pi;

/// A ring of nodes about (x, y) with a velocity in each.
struct Ring {
  std::vector<double> x, y, velocity_x, velocity_y;

  explicit Ring(int count, double radius = 16, double at_x = 20, double at_y = 30) {
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * pi * i / count;
      x.push_back(at_x + radius * std::cos(angle));
      y.push_back(at_y + radius * std::sin(angle));
    }
    velocity_x.assign(x.size(), 0.0);
    velocity_y.assign(x.size(), 0.0);
  }
  /// Adds a wave along or across the ring.
  Ring& wave(int periods, double along, double across, double phase = 0.3) {
    const double count = static_cast<double>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double angle = 2 * pi * static_cast<double>(i) / count, value = std::cos(periods * angle + phase);
      velocity_x[i] += value * (-along * std::sin(angle) - across * std::cos(angle));
      velocity_y[i] += value * (along * std::cos(angle) - across * std::sin(angle));
    }
    return *this;
  }
  /// Adds a flow with a uniform gradient.
  Ring& flow(double ux, double uy, double dudx, double dudy, double dvdx, double dvdy) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      velocity_x[i] += ux + dudx * x[i] + dudy * y[i];
      velocity_y[i] += uy + dvdx * x[i] + dvdy * y[i];
    }
    return *this;
  }
  [[nodiscard]] MembraneWave found() const { return find_wave(x, y, velocity_x, velocity_y); }
};

/// One cell made of a ring, its last step as given.
Membranes membranes_of(const Ring& ring) {
  Membranes m;
  m.cells.push_back({{0, static_cast<int>(ring.x.size())}, 0, 0, 0});
  m.position[0] = ring.x, m.position[1] = ring.y, m.velocity[0] = ring.velocity_x, m.velocity[1] = ring.velocity_y;
  double largest = 0;
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    largest = std::max(largest, std::hypot(m.velocity[0][i], m.velocity[1][i]));
  m.largest_step = {largest};
  return m;
}

Failure failed(const std::string& reason, int cell) {
  Failure f;
  f.reason = reason;
  f.cell = cell;
  return f;
}

const Domain<2> domain = test::periodic_box(128);

}  // namespace

TEST_CASE("a seeded wave is found with its length and direction", "[failure_mode]") {
  const int count = GENERATE(64, 99, 100), periods = GENERATE(5, 8, 13, 25, 31);
  const double tangential = GENERATE(0.0, 0.25, 1.0);
  // On a ring such a wave is orthogonal to every flow with a uniform gradient: what is found is exact.
  const double along = std::sqrt(tangential), across = std::sqrt(1 - tangential);
  const MembraneWave alone = Ring(count).wave(periods, along, across).found();
  CHECK(alone.wavelength == Approx(static_cast<double>(count) / periods).epsilon(1e-14));
  CHECK(alone.tangential_share == Approx(tangential).margin(1e-12));
  CHECK(alone.prominence == Approx(1).epsilon(1e-10));
  // Not the least change where a translation, a rotation and a shear flow come on top.
  const MembraneWave carried =
      Ring(count).wave(periods, along, across).flow(0.5, -0.3, 0.01, 0.04, -0.02, -0.01).found();
  CHECK(carried.wavelength == alone.wavelength);
  CHECK(carried.tangential_share == Approx(tangential).margin(1e-12));
  CHECK(carried.speed == Approx(alone.speed).epsilon(1e-10));
}

TEST_CASE("the shortest wave, every other node, is found", "[failure_mode]") {
  const MembraneWave wave = Ring(100).wave(50, 1, 0, 0).found();
  CHECK(wave.wavelength == 2);
  CHECK(wave.tangential_share == Approx(1));
  CHECK(wave.speed == Approx(1));
}

TEST_CASE("smooth motion is no wave", "[failure_mode]") {
  CHECK(Ring(100).flow(0.1, 0.2, 0, 0.01, 0, 0).found().prominence < 1e-12);
  CHECK(Ring(100).wave(3, 0.5, 1).flow(0.1, 0, 0, 0, 0, 0).found().prominence < 1e-12);
  CHECK(Ring(100).found().prominence == 0);
  CHECK(Ring(8).wave(3, 1, 0).found().prominence == 0);
  Ring broken = Ring(100).wave(13, 1, 0);
  broken.velocity_x[7] = std::nan("");
  CHECK(broken.found().prominence == 0);
}

TEST_CASE("a prominent wave names the mode of a failure by its direction and length", "[failure_mode]") {
  struct Case {
    int periods;
    double along, across;
    const char* mode;
  };
  const auto [periods, along, across, mode] =
      GENERATE(Case{13, 1, 0.1, "tangential"}, Case{13, 0.1, 1, "normal"}, Case{24, 1, 0, "tangential"},
               Case{25, 1, 0, "node-scale"}, Case{50, 0.2, 1, "node-scale"});
  const Membranes m = membranes_of(Ring(100).wave(periods, 0.4 * along, 0.4 * across).flow(0.05, 0, 0, 0, 0, 0));
  Failure f = failed("node_step", 0);
  find_mode(f, m, GrowthWatch(), domain, {36, 30}, 0, 77);
  CHECK(f.mode.name == mode);
  CHECK(f.mode.wavelength == Approx(100.0 / periods));
  CHECK(f.mode.tangential_share == Approx(along * along / (along * along + across * across)).epsilon(1e-9));
  CHECK(f.mode.step == 77);
  CHECK(mode_sentence(f).find(along > across ? "along the membrane" : "across the membrane") != std::string::npos);
  scene::Stage stage;
  CHECK(mode_remedy(f, false, stage).find("semi-implicit") != std::string::npos);
  CHECK(mode_remedy(f, true, stage).find("semi-implicit") == std::string::npos);
  CHECK(mode_remedy(f, true, stage).find("numerics.density_factor") != std::string::npos);
  stage.density_factor_key = "/stages/1/density_factor";
  CHECK(mode_remedy(f, true, stage).find("/stages/1/density_factor") != std::string::npos);
}

TEST_CASE("the mode is read where the wave first stood out, not from the crumpled end", "[failure_mode]") {
  GrowthWatch growth;
  growth.note(10, membranes_of(Ring(100).flow(0.02, 0, 0, 0, 0, 0)));
  CHECK(growth.level() == Approx(0.04));
  growth.note(30, membranes_of(Ring(100).wave(13, 0.05, 0)));
  growth.note(40, membranes_of(Ring(100).wave(40, 0.2, 0.2)));
  const Membranes end = membranes_of(Ring(100).wave(50, 0, 1));
  Failure f = failed("node_step", 0);
  find_mode(f, end, growth, domain, {36, 30}, 0, 50);
  CHECK(f.mode.name == "tangential");
  CHECK(f.mode.wavelength == Approx(100.0 / 13));
  CHECK(f.mode.step == 30);
}

TEST_CASE("what lies ten checks back is forgotten, and the level falls to twice the calmest check", "[failure_mode]") {
  GrowthWatch growth;
  growth.note(5, membranes_of(Ring(100).flow(0.1, 0, 0, 0, 0, 0)));
  const Membranes calm = membranes_of(Ring(100).flow(0.03, 0, 0, 0, 0, 0));
  for (int check = 1; check <= 10; ++check) growth.check(100 * check, calm);
  CHECK(growth.excursions().size() == 1);
  CHECK(growth.level() == Approx(0.2));
  growth.check(1100, calm);
  CHECK(growth.excursions().empty());
  CHECK(growth.level() == Approx(0.06));
}

TEST_CASE("without a wave the reason and the surroundings name the mode", "[failure_mode]") {
  const Membranes one = membranes_of(Ring(100).flow(0.02, 0.01, 0, 0, 0, 0));
  const auto mode = [](const Membranes& m, const char* reason, int cell, std::array<double, 2> place,
                       double oscillation) {
    Failure f = failed(reason, cell);
    find_mode(f, m, GrowthWatch(), domain, place, oscillation, 1);
    CHECK(std::isnan(f.mode.wavelength));
    return f.mode.name;
  };
  CHECK(mode(one, "area_drift", 0, {20, 30}, 0) == "leakage");
  CHECK(mode(one, "crossing", 0, {36, 30}, 0) == "collapse");
  CHECK(mode(one, "mach", -1, {60, 30}, 0) == "sound");
  CHECK(mode(one, "mach", -1, {37, 30}, 0) == "none");
  CHECK(mode(one, "mach", -1, {37, 30}, 0.5) == "sound");
  CHECK(mode(one, "mach", -1, {37 + 128, 30}, 0) == "none");  // its image is as near
  CHECK(mode(Membranes(), "non_finite", -1, {60, 30}, 0) == "sound");
  // A second ring beside the first.
  Membranes two = one;
  two.cells.push_back({{100, 100}, 0, 0, 0});
  for (int i = 0; i < 100; ++i) {
    two.position[0].push_back(one.position[0][static_cast<std::size_t>(i)] + 35);
    two.position[1].push_back(one.position[1][static_cast<std::size_t>(i)]);
    two.velocity[0].push_back(0);
    two.velocity[1].push_back(0);
  }
  CHECK(mode(two, "node_step", 0, {36, 30}, 0) == "collapse");
  CHECK(mode(two, "mach", -1, {37, 30}, 0) == "collapse");
  CHECK(mode(two, "node_step", 0, {4, 30}, 0) == "none");
}

TEST_CASE("a fluid's oscillation at the lattice's scale is told from its smooth flow", "[failure_mode]") {
  const auto of = [](const std::function<double(int, int)>& u) {
    return lattice_oscillation(40, 40, [&](int x, int y) { return FluidSample{u(x, y), 0, 0}; });
  };
  CHECK(of([](int x, int y) { return (x + y) % 2 == 0 ? 1.0 : -1.0; }) == Approx(1).epsilon(0.02));
  CHECK(of([](int, int y) { return y % 2 == 0 ? 0.3 : -0.3; }) == Approx(1).epsilon(0.02));
  CHECK(of([](int, int y) { return 0.01 * y; }) < 1e-20);
  CHECK(of([](int x, int) { return std::sin(2 * pi * x / 16); }) < 0.01);
  CHECK(of([](int, int) { return 0.1; }) == 0);
  CHECK(of([](int, int) { return std::nan(""); }) == 0);
}
