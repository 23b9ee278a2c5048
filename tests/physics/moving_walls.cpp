// Walls of a shape that move along themselves, and the shear stress on walls: Couette between cylinders, Poiseuille.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/geometry/formulas.hpp"
#include "flow_fixture.hpp"
#include "observe/walls/wall_shear.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

using std::numbers::pi;
constexpr double moving_tau = 2, moving_nu = (moving_tau - 0.5) / 3;

/// Of a region whose velocities are per step.
template <class Set>
Fluid<double, Set> steady_fluid(const Domain<Set::dimension>& domain, const RegionPointer<Set::dimension>& region,
                                double width, double push = 0) {
  constexpr int D = Set::dimension;
  FluidSetting<D> setting{.domain = domain, .relaxation_rate = 1 / moving_tau, .wall_time = 1};
  setting.body_force[0] = push;
  setting.solid = std::make_shared<const SolidNodes<D>>(domain.size, region);
  Fluid<double, Set> fluid(setting, make_collision("trt", {0.1875}, moving_tau, false, D));
  advance(fluid, std::lround(20 * width * width / (pi * pi * moving_nu)));  // what is missing dies out as exp(-20)
  fluid.settle();
  return fluid;
}

/// L2 error of the velocity over its L2 norm. Also of the next step: modes that change their sign with every step would
/// die out slowly.
template <class T, class Set, class Exact>
double profile_error(Fluid<T, Set>& fluid, const Region<Set::dimension>& region, Exact exact) {
  constexpr int D = Set::dimension;
  const Domain<D>& domain = fluid.setting().domain;
  double most = 0;
  for (int step = 0; step < 2; ++step) {
    const std::vector<Moments<D>> nodes = fluid.all_moments();
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Vec<D> place, velocity;
      std::size_t rest = i;
      for (int k = 0; k < D; ++k) {
        const auto size = static_cast<std::size_t>(domain.size[k]), axis = static_cast<std::size_t>(k);
        place[k] = static_cast<double>(rest % size), rest /= size;
        velocity[k] = nodes[i].velocity[axis];
      }
      if (region.distance(place).value <= 0) continue;
      error += (velocity - exact(place)).squaredNorm(), norm += exact(place).squaredNorm();
    }
    most = std::max(most, std::sqrt(error / norm));
    advance(fluid, 1);
    fluid.settle();
  }
  return most;
}

/// Root mean square of what the shear stress at places on a wall differs from, over its magnitude.
template <class T, class Set, class Exact>
double shear_error(const Fluid<T, Set>& fluid, const Region<Set::dimension>& region,
                   const std::vector<Vec<Set::dimension>>& places, Exact exact) {
  const rouleau::observe::WallShear<Set::dimension> shear(region, fluid.setting().domain, *fluid.setting().solid,
                                                          places);
  const auto found = shear.of(fluid);
  REQUIRE(found.size() == places.size());
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    error += (found[i] - exact(places[i])).squaredNorm(), norm += exact(places[i]).squaredNorm();
  return std::sqrt(error / norm);
}

/// On a circle in the plane of the last two axes, or of the only two.
template <int D>
std::vector<Vec<D>> circle(const Vec<2>& center, double radius) {
  constexpr int count = 97;
  std::vector<Vec<D>> places;
  for (int i = 0; i < count; ++i) {
    Vec<D>& place = places.emplace_back(Vec<D>::Zero());
    place[D - 2] = center[0] + radius * std::cos(2 * pi * i / count);
    place[D - 1] = center[1] + radius * std::sin(2 * pi * i / count);
  }
  return places;
}

struct Errors {
  double profile, torque, heat, inner_shear, outer_shear;  ///< heat: dissipation over the walls' power, less 1
};

constexpr double spin = 1e-4, ratio = 2.2;

/// Between a cylinder that turns and one at rest around it, with their axis off the lattice's nodes.
Errors turned(double inner) {
  const double outer = ratio * inner;
  const int side = static_cast<int>(std::ceil(2 * outer)) + 3;
  const Vec<2> center(side / 2.0 - 0.37, side / 2.0 - 0.61);
  BorderMotion<2> motion{.center = center};
  motion.spin << 0, -spin, spin, 0;
  const RegionPointer<2> region =
      intersection<2>({ball_region<2>(center, outer), outside_of(moving<2>(ball_region<2>(center, inner), motion))});
  auto fluid = steady_fluid<D2Q9>(Domain<2>({side, side}, {true, true}), region, outer - inner);
  // u = A r + B/r, A = -B/outer^2
  const double b = spin * inner * inner * outer * outer / (outer * outer - inner * inner);
  const auto around = [&](const Vec<2>& place) { return Vec<2>(center[1] - place[1], place[0] - center[0]); };
  const auto velocity = [&](const Vec<2>& place) -> Vec<2> {
    return (b / (place - center).squaredNorm() - b / (outer * outer)) * around(place);
  };
  const auto on_wall = [&](const Vec<2>& place) -> Vec<2> {  // drags the outer one along, holds the inner one back
    const double r = (place - center).norm();
    return (r < (inner + outer) / 2 ? -1 : 1) * 2 * moving_nu * b / (r * r) * around(place) / r;
  };
  const Energetics<2> energy = fluid.energetics();
  return {profile_error(fluid, *region, velocity), energy.wall_power / spin / (4 * pi * moving_nu * b) - 1,
          energy.dissipation / energy.wall_power - 1, shear_error(fluid, *region, circle<2>(center, inner), on_wall),
          shear_error(fluid, *region, circle<2>(center, outer), on_wall)};
}

}  // namespace

TEST_CASE("between a cylinder that turns and one around it the flow is that of Couette, to second order",
          "[flow][walls]") {
  for (const double inner : {4.7, 9.4, 18.8}) {
    const Errors off = turned(inner);
    std::cout << "cylinder of " << inner << " spacings in one of " << ratio * inner << ": profile off by "
              << off.profile << ", torque by " << off.torque << ", dissipation by " << off.heat
              << ", shear stress inside by " << off.inner_shear << ", outside by " << off.outer_shear << std::endl;
    CAPTURE(inner);
    const double square = inner * inner;
    CHECK(off.profile < 0.5 / square);
    CHECK(std::abs(off.torque) < 0.6 / square);
    CHECK(std::abs(off.heat) < 1e-4);
    CHECK(off.inner_shear < 6 / square);
    CHECK(off.outer_shear < 3 / square);
  }
}

TEST_CASE("a rod that slides and turns in a tube takes the fluid along as it must", "[space][flow][walls]") {
  constexpr double slide = 1e-3;
  for (const double inner : {3.7, 7.4}) {
    const double outer = ratio * inner;
    const int side = static_cast<int>(std::ceil(2 * outer)) + 3;
    const Vec<3> center(0, side / 2.0 - 0.37, side / 2.0 - 0.61);
    BorderMotion<3> motion{.velocity = slide * Vec<3>::Unit(0), .center = center};
    motion.spin(1, 2) = -spin, motion.spin(2, 1) = spin;
    const auto round = [&](double radius) {
      return extruded(ball_region<2>(center.tail<2>(), radius), 0, -INFINITY, INFINITY);
    };
    const RegionPointer<3> region = intersection<3>({round(outer), outside_of(moving<3>(round(inner), motion))});
    auto fluid = steady_fluid<D3Q19>(Domain<3>({2, side, side}, {true, true, true}), region, outer - inner);
    const double b = spin * inner * inner * outer * outer / (outer * outer - inner * inner), log = std::log(ratio);
    const double profile = profile_error(fluid, *region, [&](const Vec<3>& place) -> Vec<3> {
      const double y = place[1] - center[1], z = place[2] - center[2], r = std::hypot(y, z);
      const double turns = b / (r * r) - b / (outer * outer);
      return {slide * std::log(outer / r) / log, -turns * z, turns * y};
    });
    const double power = 2 * (4 * pi * moving_nu * b * spin + 2 * pi * moving_nu * slide * slide / log);
    const double off = fluid.energetics().wall_power / power - 1;
    const double shear =
        shear_error(fluid, *region, circle<3>(center.tail<2>(), inner), [&](const Vec<3>& place) -> Vec<3> {
          const double y = place[1] - center[1], z = place[2] - center[2], r = std::hypot(y, z),
                       turns = 2 * moving_nu * b / (r * r * r);
          return {-moving_nu * slide / (r * log), turns * z, -turns * y};
        });
    std::cout << "rod of " << inner << " spacings in a tube: profile off by " << profile << ", power by " << off
              << ", shear stress by " << shear << std::endl;
    CHECK(profile < 0.7 / (inner * inner));
    CHECK(std::abs(off) < 1 / (inner * inner));
    CHECK(shear < 4 / (inner * inner));
  }
}

TEST_CASE("the shear stress on the walls of a channel and of a tube carries what drives the flow", "[flow][walls]") {
  constexpr double push = 1e-6;
  for (const double half : {4.3, 8.6, 17.2}) {
    const double middle = half + 1.7;
    const int side = static_cast<int>(std::ceil(2 * middle)) + 1;
    const RegionPointer<2> channel = box_region<2>({-INFINITY, middle - half}, {INFINITY, middle + half});
    const auto plane = steady_fluid<D2Q9>(Domain<2>({4, side}, {true, true}), channel, 2 * half, push);
    const double in_channel =
        shear_error(plane, *channel, {{1.2, middle - half}, {2.6, middle + half}}, [&](const Vec<2>&) -> Vec<2> {
          return {push * half, 0};
        });
    const Vec<2> center(middle, middle);
    const RegionPointer<3> tube = extruded(ball_region<2>(center, half), 0, -INFINITY, INFINITY);
    const auto round = steady_fluid<D3Q19>(Domain<3>({2, side, side}, {true, true, true}), tube, 2 * half, push);
    const double in_tube = shear_error(round, *tube, circle<3>(center, half), [&](const Vec<3>&) -> Vec<3> {
      return {push * half / 2, 0, 0};
    });
    std::cout << "half width " << half << ": shear stress off by " << in_channel << " in a channel, " << in_tube
              << " in a tube" << std::endl;
    CHECK(in_channel < 0.3 / (half * half));
    CHECK(in_tube < 0.12 / half);
  }
}
