// Flow through a channel whose walls cut the lattice at an angle, and past cylinders, in two dimensions.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/geometry/faceted.hpp"
#include "flow_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// A channel along the diagonal of a periodic box, from end to end, as a long rectangle: the region comes again in its
/// images.
RegionPointer<2> diagonal_channel(const rouleau::core::Domain<2>& domain, double half_height) {
  const Vec<2> along(domain.size[0], domain.size[1]), across = Vec<2>(-along[1], along[0]).normalized() * half_height;
  const Vec<2> middle = (along - Vec<2>::Ones()) / 2;
  const Border<2> rectangle{
      {middle - along - across, middle + along - across, middle + along + across, middle - along + across},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  return std::make_shared<FacetedRegion<2>>(with_images(rectangle, domain));
}

struct FlowErrors {
  double profile;  ///< L2 error of the velocity over its L2 norm
  double mass;     ///< gained by each node, density 1
};

FlowErrors channel_flow(int nx, int ny, double half_height) {
  const double tau = 2, viscosity = (tau - 0.5) / 3, force = 1e-6;
  const rouleau::core::Domain<2> domain({nx, ny}, {true, true});
  const Vec<2> along = Vec<2>(nx, ny).normalized();
  const auto channel = diagonal_channel(domain, half_height);
  FluidSetting<2> setting{
      .domain = domain, .relaxation_rate = 1 / tau, .body_force = {force * along[0], force * along[1]}};
  setting.solid = std::make_shared<const SolidNodes<2>>(domain.size, channel);
  Fluid<double> fluid(setting, make_collision("trt", {0.1875}, tau, false));
  // The slowest part of what is missing dies out as exp(-pi^2 viscosity t / (2 half_height)^2).
  advance(fluid, std::lround(20 * 4 * half_height * half_height / (std::numbers::pi * std::numbers::pi * viscosity)));
  fluid.settle();
  double error = 0, norm = 0;
  std::vector<Moments<2>> row;
  for (int y = 0; y < ny; ++y) {
    fluid.moments(y, row);
    for (int x = 0; x < nx; ++x) {
      const double from_wall = channel->distance({x, y}).value, s = half_height - from_wall;
      if (from_wall <= 0) continue;
      const Vec<2> exact = force / (2 * viscosity) * (half_height * half_height - s * s) * along;
      error += (Vec<2>(row[x].velocity[0], row[x].velocity[1]) - exact).squaredNorm(), norm += exact.squaredNorm();
    }
  }
  return {std::sqrt(error / norm), fluid.mass() / static_cast<double>(setting.solid->fluid_count())};
}

}  // namespace

TEST_CASE("flow through a channel turned by any angle is that of Poiseuille to second order", "[flow][walls]") {
  struct Box {
    int nx, ny;
  };
  for (const auto& [nx, ny] : {Box{30, 30}, Box{40, 20}, Box{48, 16}, Box{64, 16}}) {
    const double apart = nx * ny / std::hypot(nx, ny), half_height = 0.37 * apart;
    const FlowErrors coarse = channel_flow(nx, ny, half_height), fine = channel_flow(2 * nx, 2 * ny, 2 * half_height);
    std::cout << "turned by " << std::atan2(ny, nx) * 180 / std::numbers::pi << " degrees, half height " << half_height
              << ": profile off by " << coarse.profile << ", " << fine.profile << " at twice the nodes; mass "
              << fine.mass << "\n";
    CAPTURE(nx, ny);
    CHECK(coarse.profile < 0.65 / (half_height * half_height));
    CHECK(fine.profile < 0.65 / (4 * half_height * half_height));
  }
}
