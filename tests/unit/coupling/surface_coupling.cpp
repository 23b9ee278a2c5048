// The coupling in three dimensions: balances, adjointness, images, order of sums.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "core/coupling/coupling.hpp"
#include "core/fluid/periodic.hpp"
#include "core/surface/triangle_surface.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;
using core::Domain;

namespace {

constexpr std::array<int, 3> box = {20, 18, 16};

template <class T>
VectorField<T, 3> field() {
  return {Field<T, 3>(box), Field<T, 3>(box), Field<T, 3>(box)};
}

/// A sphere of radius 3 and 92 nodes, whose forces are random.
Surfaces sphere_at(const Vec<3>& center, std::mt19937& random) {
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(3, {3, 3, 3}))));
  add_cell(s, 0, center);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < s.node_count(); ++i)
    s.force[0][i] = any(random), s.force[1][i] = any(random), s.force[2][i] = any(random);
  return s;
}

template <class Function>
void for_nodes(const Function& function) {
  for (int z = 0; z < box[2]; ++z) {
    for (int y = 0; y < box[1]; ++y) {
      for (int x = 0; x < box[0]; ++x) function(x, y, z);
    }
  }
}

/// Fills the halo as the fluid does: images of periodic axes, and beyond walls that rest the mirrored velocity
/// reversed.
template <class T>
void fill_halo(VectorField<T, 3>& u, const Domain<3>& domain) {
  constexpr int halo = Field<T, 3>::halo;
  for (Field<T, 3>& component : u) {
    for (int z = -halo; z < box[2] + halo; ++z) {
      for (int y = -halo; y < box[1] + halo; ++y) {
        for (int x = -halo; x < box[0] + halo; ++x) {
          int at[3] = {x, y, z};
          T sign = 1;
          for (int k = 0; k < 3; ++k) {
            const int wrapped = domain.wrapped(k, at[k]);
            if (wrapped < 0) sign = -sign;
            at[k] = wrapped >= 0 ? wrapped : at[k] < 0 ? -1 - at[k] : 2 * box[k] - 1 - at[k];
          }
          component.row(y, z)[x] = sign * component.row(at[1], at[2])[at[0]];
        }
      }
    }
  }
}

}  // namespace

TEMPLATE_TEST_CASE("in three dimensions spreading and interpolation are adjoint, over borders and beside walls too", "",
                   float, double) {
  auto random = generator(81);
  std::uniform_real_distribution<double> any(-1, 1);
  struct Case {
    std::array<bool, 3> periodic;
    Vec<3> center;
  };
  for (const auto& [periodic, center] :
       {Case{{true, true, true}, {1.3, 17.6, -0.4}}, Case{{true, false, false}, {1.3, 2.6, 12.4}},
        Case{{false, true, true}, {2.6, 17.6, 3.4}}}) {
    const Domain<3> domain(box, periodic);
    for (const KernelKind kernel :
         {KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::cosine4, KernelKind::sharp6}) {
      Surfaces s = sphere_at(center, random);
      Coupling<TestType, 3> coupling(kernel, domain);
      coupling.reserve(s);
      coupling.locate({}, s, s.positions());
      REQUIRE(coupling.escaped(s) == -1);
      VectorField<TestType, 3> force = field<TestType>(), u = field<TestType>();
      coupling.spread({0, box[1] * box[2]}, s, s.forces(), force);
      for_nodes([&](int x, int y, int z) {
        for (auto& component : u) component.row(y, z)[x] = static_cast<TestType>(any(random));
      });
      double power = 0, size = 0;
      for_nodes([&](int x, int y, int z) {
        for (int k = 0; k < 3; ++k) {
          const double one = static_cast<double>(force[k].row(y, z)[x]) * static_cast<double>(u[k].row(y, z)[x]);
          power += one;
          size += std::abs(one);
        }
      });
      fill_halo(u, domain);
      coupling.interpolate({}, s, u);
      for (int i = 0; i < s.node_count(); ++i) {
        power -= s.force[0][i] * s.velocity[0][i] + s.force[1][i] * s.velocity[1][i] + s.force[2][i] * s.velocity[2][i];
      }
      CHECK(std::abs(power) < (sizeof(TestType) == 4 ? 1e-5 : 1e-13) * size);
    }
  }
}

TEMPLATE_TEST_CASE(
    "beside walls that move and in their corners lattice and walls get the force and the power of the nodes", "", float,
    double) {
  auto random = generator(86);
  std::uniform_real_distribution<double> any(-1, 1);
  const Domain<3> domain(box, {true, false, false});
  const WallVelocity walls{0.3, -0.7};
  for (const KernelKind kernel :
       {KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::cosine4, KernelKind::sharp6}) {
    Surfaces s = sphere_at({5, 8, 8}, random);
    for (int i = 0; i < s.node_count(); ++i) {  // most of them in the corners
      s.position[1][i] = any(random) < 0 ? any(random) / 2 + 0.2 : 16.9 + any(random) / 2;
      s.position[2][i] = i % 5 == 0        ? 8 + any(random)
                         : any(random) < 0 ? any(random) / 2 + 0.2
                                           : 14.8 + any(random) / 2;
    }
    Coupling<TestType, 3> coupling(kernel, domain);
    coupling.reserve(s);
    coupling.locate({}, s, s.positions());
    REQUIRE(coupling.escaped(s) == -1);
    VectorField<TestType, 3> force = field<TestType>(), u = field<TestType>();
    coupling.spread({0, box[1] * box[2]}, s, s.forces(), force);
    for_nodes([&](int x, int y, int z) {
      for (auto& component : u) component.row(y, z)[x] = static_cast<TestType>(any(random));
    });
    for (int z = 0; z < box[2]; ++z) {
      for (int y = 0; y < box[1]; ++y) fill_velocity_halo<TestType, 3>(u, {y, z}, domain, walls);
    }
    coupling.interpolate({}, s, u);
    const WallForces<3> share = coupling.wall_share(s, s.forces(), {});
    const auto& given = s.force;
    const auto& moved = s.velocity;
    const double rounding = sizeof(TestType) == 4 ? 2e-4 : 1e-12;
    double power = share.lower[0] * walls.lower + share.upper[0] * walls.upper;
    for (int k = 0; k < 3; ++k) {
      double lost = -share.all(k);
      for (int i = 0; i < s.node_count(); ++i) {
        power -= given[k][i] * moved[k][i];
        lost += given[k][i];
      }
      for_nodes([&](int x, int y, int z) {
        const auto here = static_cast<double>(force[k].row(y, z)[x]);
        power += here * static_cast<double>(u[k].row(y, z)[x]);
        lost -= here;
      });
      CHECK(std::abs(lost) < rounding);
      CHECK(std::abs(share.all(k)) > 0.1);
    }
    CHECK(std::abs(power) < rounding);
  }
}

TEST_CASE("in three dimensions force and torque on the lattice are those of the nodes") {
  auto random = generator(82);
  const Domain<3> domain(box, {true, true, true});
  for (const KernelKind kernel : {KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::sharp6}) {
    Surfaces s = sphere_at({9.7, 8.2, 7.9}, random);
    Coupling<double, 3> coupling(kernel, domain);
    coupling.reserve(s);
    coupling.locate({}, s, s.positions());
    VectorField<double, 3> force = field<double>();
    coupling.spread({0, box[1] * box[2]}, s, s.forces(), force);
    Vec<3> sum = Vec<3>::Zero(), torque = Vec<3>::Zero();
    for_nodes([&](int x, int y, int z) {
      const Vec<3> f(force[0].row(y, z)[x], force[1].row(y, z)[x], force[2].row(y, z)[x]);
      sum += f;
      torque += Vec<3>(x, y, z).cross(f);
    });
    for (int i = 0; i < s.node_count(); ++i) {
      const Vec<3> f(s.force[0][i], s.force[1][i], s.force[2][i]);
      sum -= f;
      torque -= s.nodes(0)[i].cross(f);
    }
    CHECK(sum.norm() < 1e-12);
    CHECK(torque.norm() < 1e-11);
  }
}

TEST_CASE("in three dimensions linear velocity is interpolated exactly") {
  auto random = generator(83);
  const Domain<3> domain(box, {true, true, true});
  Surfaces s = sphere_at({9.7, 8.2, 7.9}, random);
  Coupling<double, 3> coupling(KernelKind::peskin4, domain);
  coupling.reserve(s);
  coupling.locate({}, s, s.positions());
  VectorField<double, 3> u = field<double>();
  for_nodes([&](int x, int y, int z) {
    u[0].row(y, z)[x] = 0.3 + 0.1 * y - 0.2 * z;
    u[1].row(y, z)[x] = 0.05 * x + 0.02 * y;
    u[2].row(y, z)[x] = -0.07 * z + 0.01 * x;
  });
  coupling.interpolate({}, s, u);
  for (int i = 0; i < s.node_count(); ++i) {
    CHECK(std::abs(s.velocity[0][i] - (0.3 + 0.1 * s.position[1][i] - 0.2 * s.position[2][i])) < 1e-14);
    CHECK(std::abs(s.velocity[1][i] - (0.05 * s.position[0][i] + 0.02 * s.position[1][i])) < 1e-14);
    CHECK(std::abs(s.velocity[2][i] - (-0.07 * s.position[2][i] + 0.01 * s.position[0][i])) < 1e-14);
  }
}

TEMPLATE_TEST_CASE("spread forces of surfaces are the same bits however rows are shared out and wherever borders lie",
                   "", float, double) {
  auto random = generator(84);
  const Domain<3> domain(box, {true, true, true});
  Surfaces s = sphere_at({9.75, 8.25, 7.5}, random);
  for (auto& places : s.position) {  // with few digits, so that they are the same ones elsewhere
    for (double& place : places) place = std::round(place * 1024) / 1024;
  }
  const KernelKind kernel = GENERATE(KernelKind::peskin4, KernelKind::sharp6);
  const auto spread = [&](const std::vector<int>& cuts) {
    Coupling<TestType, 3> coupling(kernel, domain);
    coupling.reserve(s);
    coupling.locate({}, s, s.positions());
    VectorField<TestType, 3> force = field<TestType>();
    for (std::size_t k = 1; k < cuts.size(); ++k) coupling.spread({cuts[k - 1], cuts[k]}, s, s.forces(), force);
    return force;
  };
  const auto whole = spread({0, 288}), parts = spread({0, 1, 100, 101, 150, 288});
  for (double& x : s.position[0]) x += 8;  // across the border
  for (double& z : s.position[2]) z -= 5;
  const auto moved = spread({0, 50, 288});
  for_nodes([&](int x, int y, int z) {
    for (int k = 0; k < 3; ++k) {
      REQUIRE(whole[k].row(y, z)[x] == parts[k].row(y, z)[x]);
      REQUIRE(whole[k].row(y, z)[x] == moved[k].row(y, (z + 11) % 16)[(x + 8) % 20]);
    }
  });
  // Blocks side by side, one narrower than a stencil.
  for (const auto& borders : {std::vector{0, 9, 20}, std::vector{0, 7, 10, 20}}) {
    for (std::size_t b = 1; b < borders.size(); ++b) {
      const Domain<3> part(box, {true, true, true}, {{borders[b - 1], 0, 0}, {borders[b], box[1], box[2]}});
      Coupling<TestType, 3> coupling(kernel, part);
      coupling.reserve(s);
      coupling.locate({}, s, s.positions());
      VectorField<TestType, 3> force;
      for (auto& component : force) component = Field<TestType, 3>({part.block.size(0), box[1], box[2]});
      coupling.spread({0, box[1] * box[2]}, s, s.forces(), force);
      for_nodes([&](int x, int y, int z) {
        for (int k = 0; k < 3; ++k) {
          if (x < borders[b - 1] || x >= borders[b]) continue;
          REQUIRE(moved[k].row(y, z)[x] == force[k].row(y, z)[x - borders[b - 1]]);
        }
      });
    }
  }
}

TEST_CASE("a node of a surface beyond a wall, or nowhere, is reported and touches nothing") {
  auto random = generator(85);
  const Domain<3> domain(box, {true, false, true});
  Surfaces s = sphere_at({9, 9, 8}, random);
  Coupling<double, 3> coupling(KernelKind::peskin4, domain);
  coupling.reserve(s);
  for (const double bad : {std::nan(""), 18.01, -1.01, 1e300}) {
    Surfaces lost = s;
    lost.position[1][17] = bad;
    for (int i = 0; i < lost.node_count(); ++i) {
      if (i != 17) lost.force[0][i] = lost.force[1][i] = lost.force[2][i] = 0;
    }
    coupling.locate({}, lost, lost.positions());
    CHECK(coupling.escaped(lost) == 17);
    VectorField<double, 3> force = field<double>();
    coupling.spread({0, box[1] * box[2]}, lost, lost.forces(), force);
    for_nodes([&](int x, int y, int z) { REQUIRE(force[0].row(y, z)[x] == 0); });
    coupling.interpolate({}, lost, force);
    CHECK(lost.velocity[1][17] == 0);
  }
}
