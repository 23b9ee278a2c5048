// Flow through channels and tubes whose walls cut the lattice at an angle: Poiseuille.
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

struct TurnedFlow {
  double profile;  ///< L2 error of the velocity over its L2 norm
  double mass;     ///< gained by each node, density 1
  double balance;  ///< dissipation over the power of the force, less 1
};

/// A tube along the diagonal of a periodic box's x and y, in the middle of its z, with its images.
class DiagonalTube final : public Region<3> {
 public:
  DiagonalTube(const rouleau::core::Domain<3>& domain, double radius)
      : middle_((Vec<3>(domain.size[0], domain.size[1], domain.size[2]) - Vec<3>::Ones()) / 2),
        along_(Vec<3>(domain.size[0], domain.size[1], 0).normalized()),
        period_(domain.size[0], 0, 0),
        radius_(radius) {}
  [[nodiscard]] Distance<3> distance(const Vec<3>& place) const override {
    Vec<3> nearest = Vec<3>::Constant(INFINITY);  // of its images across
    for (const int image : {-1, 0, 1}) {
      const Vec<3> from = place - middle_ - image * period_, across = from - from.dot(along_) * along_;
      if (across.norm() < nearest.norm()) nearest = across;
    }
    const double away = nearest.norm();
    return {radius_ - away, away > 0 ? Vec<3>(-nearest / away) : Vec<3>(Vec<3>::Unit(2))};
  }

 private:
  Vec<3> middle_, along_, period_;
  double radius_;
};

/// Flow along the diagonal of x and y that a force drives between walls `half_width` from the axis of a region.
template <class Set>
TurnedFlow turned_flow(const rouleau::core::Domain<Set::dimension>& domain, const RegionPointer<Set::dimension>& region,
                       double half_width) {
  constexpr int D = Set::dimension;
  const double tau = 2, viscosity = (tau - 0.5) / 3, force = 1e-6;
  Vec<D> along = Vec<D>::Zero();
  along[0] = domain.size[0], along[1] = domain.size[1];
  along.normalize();
  FluidSetting<D> setting{.domain = domain, .relaxation_rate = 1 / tau};
  for (int k = 0; k < D; ++k) setting.body_force[k] = force * along[k];
  setting.solid = std::make_shared<const SolidNodes<D>>(domain.size, region);
  Fluid<double, Set> fluid(setting, make_collision("trt", {0.1875}, tau, false, D));
  // The slowest part of what is missing dies out as exp(-pi^2 viscosity t / (2 half_width)^2), in a tube faster.
  advance(fluid, std::lround(20 * 4 * half_width * half_width / (std::numbers::pi * std::numbers::pi * viscosity)));
  fluid.settle();
  double error = 0, norm = 0;
  std::vector<Moments<D>> row;
  for (int i = 0; i < fluid.rows().end; ++i) {
    fluid.moments(i, row);
    const auto of_row = row_of(domain.block, i);
    for (int x = 0; x < domain.size[0]; ++x) {
      Vec<D> place, velocity;
      for (int k = 0; k < D; ++k) place[k] = k == 0 ? x : of_row[k - 1], velocity[k] = row[x].velocity[k];
      const double from_wall = region->distance(place).value, s = half_width - from_wall;
      if (from_wall <= 0) continue;
      const Vec<D> exact = force / (2 * (D - 1) * viscosity) * (half_width * half_width - s * s) * along;
      error += (velocity - exact).squaredNorm(), norm += exact.squaredNorm();
    }
  }
  const auto energetics = fluid.energetics();
  double power = 0;
  for (int k = 0; k < D; ++k) power += setting.body_force[k] * energetics.velocity[k];
  return {std::sqrt(error / norm), fluid.mass() / static_cast<double>(setting.solid->fluid_count()),
          energetics.dissipation / power - 1};
}

TurnedFlow along_channel(int nx, int ny, double half_height) {
  const rouleau::core::Domain<2> domain({nx, ny}, {true, true});
  return turned_flow<D2Q9>(domain, diagonal_channel(domain, half_height), half_height);
}
TurnedFlow along_tube(int nx, int ny, double radius) {
  const rouleau::core::Domain<3> domain({nx, ny, static_cast<int>(std::ceil(2 * radius)) + 2}, {true, true, true});
  return turned_flow<D3Q19>(domain, std::make_shared<DiagonalTube>(domain, radius), radius);
}

}  // namespace

TEST_CASE("flow through channels and tubes turned by any angle is that of Poiseuille to second order",
          "[flow][walls]") {
  struct Box {
    int nx, ny;
  };
  for (const auto& [nx, ny] : {Box{30, 30}, Box{40, 20}, Box{48, 16}, Box{64, 16}}) {
    const double apart = nx * ny / std::hypot(nx, ny), half_width = 0.37 * apart;
    const auto check = [&, turned = std::atan2(ny, nx) * 180 / std::numbers::pi](const char* what, auto flow_through) {
      const TurnedFlow coarse = flow_through(nx, ny, half_width), fine = flow_through(2 * nx, 2 * ny, 2 * half_width);
      std::cout << what << " turned by " << turned << " degrees, half width " << half_width << ": profile off by "
                << coarse.profile << ", " << fine.profile << " at twice the nodes; mass " << fine.mass << ", balance "
                << fine.balance << std::endl;
      CAPTURE(what, nx, ny);
      CHECK(coarse.profile < 0.65 / (half_width * half_width));
      CHECK(fine.profile < 0.65 / (4 * half_width * half_width));
      CHECK(std::abs(fine.balance) < 1e-8);
    };
    check("channel", along_channel);
    check("tube", along_tube);
  }
}
