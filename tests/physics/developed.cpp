// Flows that a stage begins with in ducts and tubes: solutions of Poisson's equation, and where the lattice stays.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>

#include "core/fluid/developed_flow.hpp"
#include "core/solver/solver.hpp"
#include "flow_fixture.hpp"
#include "scene/driving_flow.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

using Section = std::vector<double>;  // velocity in each row along x

struct Duct {
  std::array<int, 3> size;
  WallVelocity walls = {};
  double force = 0, tube_radius = 0;
};

/// Largest change of a velocity from the start until the slowest mode of a wrong start would have died out, over the
/// largest velocity. Where walls move, away from the corners by a sixth of the height: there the velocity jumps.
double change(const Duct& duct) {
  BasicSolverSetup<3> setup{.domain = {duct.size, {true, false, false}}, .tau = 1.5};
  setup.walls = duct.walls;
  setup.body_force_x = duct.force;
  if (duct.tube_radius > 0) {
    setup.section_flow = [&](double y, double z, double force) { return tube_flow(duct.tube_radius, force, y, z); };
    setup.solid = std::make_shared<const SolidNodes<3>>(duct.size, tube_region(duct.size, duct.tube_radius));
  }
  setup.developed = true;
  setup.collision = make_collision("trt", {0.1875}, setup.tau, false, 3);
  Surfaces none;
  Solver<double, D3Q19> solver(setup, none);
  solver.start(nullptr);
  const auto velocities = [&] {
    solver.fluid().settle();
    Section section;
    std::vector<Moments<3>> row;
    for (int i = 0; i < solver.fluid().rows().end; ++i) {
      solver.fluid().moments(i, row);
      const std::array<int, 2> at = row_of(setup.domain.block, i);
      const int corner = duct.walls.upper != 0 ? duct.size[1] / 6 : 0;
      const auto aside = [&](int axis) { return std::min(at[axis - 1], duct.size[axis] - 1 - at[axis - 1]) < corner; };
      const bool left_out = (setup.solid && setup.solid->at({0, at[0], at[1]})) || (aside(1) && aside(2));
      section.push_back(left_out ? 0 : row[1].velocity[0]);
    }
    return section;
  };
  const Section before = velocities();
  solver.step(std::lround(duct.size[1] * duct.size[1] / setup.viscosity() / 2));
  const Section after = velocities();
  double most = 0, largest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    most = std::max(most, std::abs(after[i] - before[i]));
    largest = std::max(largest, std::abs(after[i]));
  }
  return most / largest;
}

}  // namespace

TEST_CASE("the developed flow of a duct solves Poisson's equation, and has the speeds of its walls", "[flow]") {
  const auto [height, width] = GENERATE(std::pair{10.0, 10.0}, std::pair{10.0, 37.0}, std::pair{30.0, 8.0});
  const DuctFlow flow{height, width, {-0.3, 0.7}, 0.02};
  constexpr double h = 1e-4;
  for (const double y : {-0.45, -0.2, 0.0, 0.31, 0.44}) {
    for (const double z : {-0.4, 0.0, 0.13, 0.47}) {
      const double at_y = y * height, at_z = z * width;
      CAPTURE(height, width, y, z);
      const auto here = flow.at(at_y, at_z);
      const auto above = flow.at(at_y + h, at_z), below = flow.at(at_y - h, at_z);
      const auto right = flow.at(at_y, at_z + h), left = flow.at(at_y, at_z - h);
      CHECK((above.velocity - below.velocity) / (2 * h) == Approx(here.slope_y).margin(1e-7));
      CHECK((right.velocity - left.velocity) / (2 * h) == Approx(here.slope_z).margin(1e-7));
      CHECK((above.slope_y - below.slope_y + right.slope_z - left.slope_z) / (2 * h) == Approx(-0.02).margin(1e-7));
    }
  }
  for (const double share : {-0.45, 0.0, 0.3}) {
    CHECK(flow.at(share * height, width / 2).velocity == Approx(0).margin(1e-13));
    CHECK(flow.at(share * height, -width / 2).velocity == Approx(0).margin(1e-13));
    CHECK(flow.at(height * (0.5 - 1e-4), share * width).velocity == Approx(0.7).margin(5e-3));
    CHECK(flow.at(-height * (0.5 - 1e-4), share * width).velocity == Approx(-0.3).margin(5e-3));
  }
}

TEST_CASE("the developed flow of a duct has the flow rate of the series for ducts", "[flow]") {
  const rouleau::scene::Domain domain{{1, 10, 24}, {4, 4, 4}, {}, {true, false, false}};
  const DuctFlow flow{10, 24, {}, 1};
  double rate = 0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) rate += flow.at((i + 0.5) / n * 10 - 5, (k + 0.5) / n * 24 - 12).velocity;
  }
  rate *= 10.0 * 24 / (n * n);
  CHECK(rate == Approx(rouleau::scene::duct_share(domain) * 24 * 1000 / 12).epsilon(2e-5));
}

TEST_CASE("the developed flow of ducts and tubes is where the lattice stays, to second order", "[flow]") {
  struct Case {
    const char* name;
    Duct duct;
    double times_square;  ///< bound of the change, times the square of the nodes across y
  };
  for (const int n : {12, 24}) {
    const double tube = n / 2.0;
    for (const auto& [name, duct, bound] :
         {Case{"duct, driven", {{4, n, n * 3 / 2}, {}, 1e-6, 0}, 0.9},
          Case{"duct, walls move apart", {{4, n, n * 3 / 2}, {-0.01, 0.01}, 0, 0}, 0.5},
          Case{"duct, walls move together", {{4, n, n * 3 / 2}, {0.01, 0.01}, 0, 0}, 0.5},
          Case{"tube", {{4, n, n}, {}, 1e-6, tube}, 2.6}}) {
      const double moved = change(duct);
      std::cout << name << ", " << n << " nodes: velocities change by " << moved << " of the largest\n";
      CAPTURE(name, n);
      CHECK(moved < bound / (n * n));
    }
  }
}
