// Flow through a tube of solid nodes: Hagen and Poiseuille.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/fluid/flow_rate.hpp"
#include "flow_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

using std::numbers::pi;
using Fluid3 = Fluid<double, D3Q19>;

struct TubeFlow {
  double flow_rate;  ///< over pi G R^4 / (8 mu), less 1
  double profile;    ///< L2 error of the velocity over its L2 norm
  double mass;       ///< gained by each node, density 1
  double balance;    ///< dissipation over the power of the force, less 1
};

TubeFlow tube_flow(double radius, double tau, bool interpolated = true) {
  const double viscosity = (tau - 0.5) / 3, force = 1e-6;
  const int n = static_cast<int>(std::ceil(2 * radius - 1e-9));
  FluidSetting<3> setting{
      .domain = {{4, n, n}, {true, false, false}}, .relaxation_rate = 1 / tau, .body_force = {force}};
  const SolidNodes<3> tube = tube_nodes({4, n, n}, radius);
  const auto is_solid = [&](const SolidNodes<3>::Node& node) { return tube.at(node); };
  setting.solid = std::make_shared<const SolidNodes<3>>(interpolated ? tube : SolidNodes<3>({4, n, n}, is_solid));
  Fluid3 fluid(setting, make_collision("trt", {0.1875}, tau, false, 3));
  // The slowest part of what is missing dies out as exp(-5.783 viscosity t / R^2).
  advance(fluid, std::lround(20 * radius * radius / (5.783 * viscosity)));
  fluid.settle();
  TubeFlow flow{};
  flow.flow_rate =
      flow_rate(fluid.row_velocities(), {}, setting.domain, true) * 8 * viscosity / (pi * force * std::pow(radius, 4)) -
      1;
  double error = 0, norm = 0;
  std::vector<Moments<3>> row;
  for (int i = 0; i < fluid.rows().end; ++i) {
    fluid.moments(i, row);
    const auto [y, z] = row_of(setting.domain.block, i);
    const double s = y - (n - 1) / 2.0, t = z - (n - 1) / 2.0;
    const double exact = std::max(0.0, force * (radius * radius - s * s - t * t) / (4 * viscosity));
    error += std::pow(row[1].velocity[0] - exact, 2), norm += exact * exact;
  }
  flow.profile = std::sqrt(error / norm);
  flow.mass = fluid.mass() / static_cast<double>(setting.solid->fluid_count());
  const auto energetics = fluid.energetics();
  flow.balance = energetics.dissipation / (force * energetics.velocity[0]) - 1;
  return flow;
}

}  // namespace

TEST_CASE("flow through a tube is that of Hagen and Poiseuille to second order", "[space][flow]") {
  // By how much depends on how the circle meets the lattice: the order is that of the bound.
  for (const double radius : {5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 24.0, 32.0}) {
    const TubeFlow flow = tube_flow(radius, 2);
    std::cout << "tube of " << radius << " spacings: flow rate off by " << flow.flow_rate << ", profile by "
              << flow.profile << "\n";
    CAPTURE(radius);
    CHECK(std::abs(flow.flow_rate) < 0.65 / (radius * radius));
    CHECK(flow.profile < 0.65 / (radius * radius));
    CHECK(std::abs(flow.mass) < 1e-15);  // along a straight tube nothing is lost by interpolation
    CHECK(std::abs(flow.balance) < 1e-8);
  }
}

TEST_CASE("with walls half way along each link the flow of a tube is of first order, and its mass is kept",
          "[space][flow]") {
  for (const double radius : {6.0, 12.0, 24.0}) {
    const TubeFlow flow = tube_flow(radius, 2, false);
    std::cout << "staircase of " << radius << " spacings: flow rate off by " << flow.flow_rate << "\n";
    CAPTURE(radius);
    CHECK(std::abs(flow.flow_rate) < 0.5 / radius);
    CHECK(std::abs(flow.flow_rate) > 0.65 / (radius * radius));
    CHECK(flow.profile < 0.5 / radius);
    CHECK(std::abs(flow.mass) < 1e-16);
    CHECK(std::abs(flow.balance) < 1e-8);
  }
}

TEST_CASE("the flow rate of a tube does not depend on tau with TRT", "[space][flow]") {
  CHECK(tube_flow(7, 0.6).flow_rate == Approx(tube_flow(7, 2).flow_rate).epsilon(1e-6));
}
