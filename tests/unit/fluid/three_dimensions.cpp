// D3Q19 in place: against plain two-array streaming, between walls and across periodic borders; in blocks; its observers.
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <thread>

#include "core/domain/decomposition.hpp"
#include "core/domain/transport.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/fluid/periodic.hpp"
#include "unit/flow_fixture.hpp"
#include "unit/shipped_models.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

using Nodes = std::array<int, 3>;
template <class T>
using Fluid3 = Fluid<T, D3Q19>;

CollisionOperator trt_in_space(double tau, bool inertia) { return trt(tau, inertia, 3); }

/// A number of either sign that belongs to a node of the lattice, whatever block it lies in.
double noise(int x, int y, int z, int what) { return 1e-3 * ((x * 73 + y * 191 + z * 59 + what * 37) % 101 - 50) / 50; }

template <class T>
typename Fluid3<T>::State noisy_state(int x, int y, int z) {
  typename Fluid3<T>::State state{noise(x, y, z, 0), {}, {}};
  for (int k = 0; k < 3; ++k) state.velocity[k] = noise(x, y, z, 1 + k);
  for (int k = 0; k < 9; ++k) state.gradient[k] = noise(x, y, z, 4 + k);
  return state;
}

template <class Function>
void for_each_node(const Box<3>& box, Function function) {
  for (int z = 0; z < box.size(2); ++z) {
    for (int y = 0; y < box.size(1); ++y) {
      for (int x = 0; x < box.size(0); ++x) function(x, y, z);
    }
  }
}

enum class Solid { none, half_way, interpolated };

/// Single nodes, clusters, and some that meet their own images across periodic borders; walls anywhere along links.
std::shared_ptr<const SolidNodes<3>> some_solid(const Nodes& size, Solid kind = Solid::half_way) {
  if (kind == Solid::none) return nullptr;
  const auto is_solid = [](const Nodes& n) {
    return (n[1] == 0 && n[2] < 2) || (n[0] + 2 * n[1] + 3 * n[2]) % 7 == 0 || (n[0] / 4 + n[1] + n[2]) % 5 == 0;
  };
  if (kind == Solid::half_way) return std::make_shared<const SolidNodes<3>>(size, is_solid);
  return std::make_shared<const SolidNodes<3>>(size, is_solid, [](const Nodes& n, const Nodes& to) {
    return 0.5 + 450 * noise(n[0], n[1], n[2], 9 * to[0] + 3 * to[1] + to[2] + 20);
  });
}

/// The textbook: collide into a copy, then move every population to its neighbour or bounce it back.
struct TwoArrayFluid {
  Domain<3> domain;
  std::shared_ptr<const SolidNodes<3>> solid;
  WallVelocity walls;
  CollisionOperator collision;
  std::vector<double> f;

  [[nodiscard]] std::size_t at(int q, const Nodes& n) const {
    return ((static_cast<std::size_t>(n[2]) * domain.size[1] + n[1]) * domain.size[0] + n[0]) * 19 + q;
  }
  void step() {
    std::vector<double> after = f, streamed = f;
    const auto is_solid = [&](const Nodes& node) { return solid && solid->at(domain, node); };
    for_each_node(domain.block, [&](int x, int y, int z) {
      if (is_solid({x, y, z})) return;
      const double* in[19];
      double* out[19];
      for (int q = 0; q < 19; ++q) in[q] = &f[at(q, {x, y, z})], out[q] = &after[at(q, {x, y, z})];
      rouleau_collision_block_f64 block{};
      block.struct_size = sizeof block;
      block.count = 1;
      block.in = in;
      block.out = out;
      collision.table->collide_f64(collision.self.get(), &block);
    });
    for_each_node(domain.block, [&](int x, int y, int z) {
      for (int q = 0; q < 19 && !is_solid({x, y, z}); ++q) {
        const auto& c = D3Q19::velocity[q];
        Nodes to{x + c[0], y + c[1], z + c[2]};
        double speed = 0;
        if (domain.wrapped(1, to[1]) < 0) speed = to[1] < 0 ? walls.lower : walls.upper;
        bool plane = false;
        for (int k = 0; k < 3; ++k) plane = plane || (to[k] = domain.wrapped(k, to[k])) < 0;
        const bool wall = plane || is_solid(to);
        const double here = after[at(q, {x, y, z})];
        if (wall) {
          const int back = D3Q19::opposite[q];
          Nodes behind{x - c[0], y - c[1], z - c[2]};
          bool alone = is_solid(behind);
          for (int k = 0; k < 3; ++k) alone = alone || (behind[k] = domain.wrapped(k, behind[k])) < 0;
          const double cut = solid ? solid->cut({x, y, z}, {c[0], c[1], c[2]}) : 0.5;
          const double share = alone || (plane && cut > 0.5) ? 0.5 : cut;
          if (plane && cut < 0.5) speed = 0;  // a wall that rests lies before the plane
          streamed[at(back, {x, y, z})] = here - 6 * D3Q19::weight[q] * c[0] * speed;
          if (share != 0.5) {
            const double factor = (1 - 2 * share) / (1 + 2 * share);
            streamed[at(back, {x, y, z})] += factor * (after[at(q, behind)] - after[at(back, {x, y, z})]);
          }
        } else {
          streamed[at(q, to)] = here;
        }
      }
    });
    f = streamed;
  }
};

}  // namespace

TEST_CASE(
    "in three dimensions in-place streaming gives the same populations as two arrays, whatever closes y and z, and "
    "with solid nodes") {
  const bool periodic_y = GENERATE(false, true), periodic_z = GENERATE(false, true);
  const int workers = GENERATE(1, 3);
  const Solid kind = GENERATE(Solid::none, Solid::half_way, Solid::interpolated);
  const double tau = 0.8;
  const Domain<3> domain({18, 5, 4}, {true, periodic_y, periodic_z});
  FluidSetting<3> setting{.domain = domain, .relaxation_rate = 1 / tau, .inertia = true};
  if (!periodic_y) setting.walls = {-0.01, 0.02};
  setting.solid = some_solid(domain.size, kind);
  Fluid3<double> fluid(setting, trt_in_space(tau, true));
  fluid.set_state(noisy_state<double>);
  TwoArrayFluid plain{domain, setting.solid, setting.walls, trt_in_space(tau, true),
                      std::vector<double>(18 * 5 * 4 * 19)};
  fluid.settle();
  const auto each = [&](auto function) {
    for_each_node(domain.block, [&](int x, int y, int z) {
      if (setting.solid && setting.solid->at({x, y, z})) return;
      for (int q = 0; q < 19; ++q) function(plain.f[plain.at(q, {x, y, z})], fluid.population(q, x, {y, z}));
    });
  };
  each([](double& own, double other) { own = other; });
  const double mass = fluid.mass();
  for (int step = 0; step < 7; ++step) {
    for (int w = workers - 1; w >= 0; --w) fluid.step(Worker{w, workers}.share(fluid.rows().end));
    fluid.end_step();
    plain.step();
    fluid.settle();
    double difference = 0;
    each([&](double own, double other) { difference = std::max(difference, std::abs(own - other)); });
    CAPTURE(periodic_y, periodic_z, workers, static_cast<int>(kind), step);
    REQUIRE(difference < 1e-16);
    if (kind != Solid::interpolated) REQUIRE(fluid.mass() == Approx(mass).margin(1e-15));
  }
}

namespace {

/// With forces in some nodes, velocities there and in the halo, and viscosities, as cells would have them.
template <class T>
std::unique_ptr<Fluid3<T>> noisy_fluid(FluidSetting<3> setting, const Domain<3>& domain, const Ranks<3>& ranks) {
  setting.domain = domain;
  auto fluid = std::make_unique<Fluid3<T>>(setting, trt_in_space(1 / setting.relaxation_rate, true), ranks);
  fluid->set_state(noisy_state<T>);
  for (int i = 0; i < fluid->rows().end; ++i) {
    const auto [y, z] = row_of(domain.block, i);
    const int row_y = y + domain.block.begin[1], row_z = z + domain.block.begin[2];
    fluid->mask().mark(i, 3 + row_y, 20 + row_z);
    for (int x = 0; x < domain.block.size(0); ++x) {
      const double rate = setting.relaxation_rate * (1 + 100 * noise(x + domain.block.begin[0], row_y, row_z, 6));
      if (fluid->mask().active(x, i)) fluid->relaxation_rate().row(y, z)[x] = static_cast<T>(rate);
    }
  }
  return fluid;
}

template <class T>
void noisy_step(Fluid3<T>& fluid, int number) {
  const Box<3>& block = fluid.setting().domain.block;
  fluid.clear_force(fluid.rows());
  for_each_node(block, [&](int x, int y, int z) {
    if (!fluid.mask().active(x, y + block.size(1) * z)) return;
    for (int k = 0; k < 3; ++k)
      fluid.force()[k].row(y, z)[x] +=
          static_cast<T>(noise(x + block.begin[0], y + block.begin[1], z + block.begin[2], number + 7 * k));
  });
  fluid.step(fluid.rows());
  fluid.end_step();
  fluid.begin_halo();
  fluid.end_halo();
}

}  // namespace

TEMPLATE_TEST_CASE("a lattice of three dimensions cut into blocks has the same bits as in one piece, halo included", "",
                   double, float) {
  const bool periodic_y = GENERATE(false, true), periodic_z = GENERATE(false, true);
  const Solid kind = GENERATE(Solid::none, Solid::half_way, Solid::interpolated);
  const Nodes parts = GENERATE(Nodes{2, 1, 1}, Nodes{1, 2, 3}, Nodes{3, 2, 2}, Nodes{1, 1, 6});
  const Domain<3> whole_domain({22, 7, 6}, {true, periodic_y, periodic_z});
  FluidSetting<3> setting{.domain = whole_domain,
                          .relaxation_rate = 1.1,
                          .inertia = true,
                          .body_force = {1e-5, 0, 2e-5},
                          .membranes = true,
                          .viscosity_contrast = true};
  if (!periodic_y && kind != Solid::interpolated) setting.walls = {-0.01, 0.02};
  setting.solid = some_solid(whole_domain.size, kind);
  const auto cut = Decomposition<3>::even(whole_domain, parts);
  const int steps = GENERATE(4, 5);
  const auto whole = noisy_fluid<TestType>(setting, whole_domain, {});
  for (int i = 0; i < steps; ++i) noisy_step(*whole, i);
  whole->settle();
  const auto ends = make_loopback(cut.ranks());
  std::vector<std::unique_ptr<Fluid3<TestType>>> blocks(ends.size());
  std::vector<double> mass(ends.size()), dissipation(ends.size());
  std::vector<std::thread> threads;
  for (int rank = 0; rank < cut.ranks(); ++rank) {
    threads.emplace_back([&, rank] {
      blocks[rank] = noisy_fluid<TestType>(setting, cut.domain(rank), {&cut, ends[rank].get()});
      for (int i = 0; i < steps; ++i) noisy_step(*blocks[rank], i);
      blocks[rank]->settle();
      mass[rank] = blocks[rank]->mass();
      dissipation[rank] = blocks[rank]->energetics().dissipation;
    });
  }
  for (std::thread& thread : threads) thread.join();
  long different = 0, velocities = 0;
  for (const auto& block : blocks) {
    const Box<3>& box = block->setting().domain.block;
    for_each_node(box, [&](int x, int y, int z) {
      const Nodes at{x + box.begin[0], y + box.begin[1], z + box.begin[2]};
      for (int q = 0; q < 19 && !(setting.solid && setting.solid->at(at)); ++q)
        different += block->population(q, x, {y, z}) != whole->population(q, at[0], {at[1], at[2]}) ? 1 : 0;
      if (!whole->mask().active(at[0], at[1] + whole_domain.size[1] * at[2])) return;
      // What a stencil with this base node reads: each node of the halo is an image of one in the whole lattice, or lies
      // beyond a wall there, too.
      for (int j = 0; j < 64; ++j) {
        const Nodes step{j % 4 - 1, j / 4 % 4 - 1, j / 16 - 1};
        Nodes to;
        bool known = true;
        std::array<int, 2> mirror{};
        for (int k = 0; k < 3; ++k) {
          to[k] = whole_domain.wrapped(k, at[k] + step[k]);
          if (to[k] < 0) to[k] = at[k] + step[k];
          if (k > 0) {
            const int n = whole_domain.size[k];
            mirror[k - 1] = to[k] >= 0 && to[k] < n ? to[k] : mirrored(to[k], n);
          }
        }
        known = whole->mask().active(to[0], mirror[0] + whole_domain.size[1] * mirror[1]);
        if (!known) continue;
        ++velocities;
        for (int k = 0; k < 3; ++k)
          different += block->velocity()[k].row(y + step[1], z + step[2])[x + step[0]] !=
                               whole->velocity()[k].row(to[1], to[2])[to[0]]
                           ? 1
                           : 0;
      }
    });
  }
  CAPTURE(periodic_y, periodic_z, static_cast<int>(kind), parts[0], parts[1], parts[2], steps);
  CHECK(different == 0);
  CHECK(velocities > 0);
  for (const double value : mass) CHECK(value == whole->mass());
  for (const double value : dissipation) CHECK(value == whole->energetics().dissipation);
}

TEST_CASE(
    "the velocity beyond a wall across z is that of its mirror image reversed, and in the edge of two walls itself") {
  const Domain<3> domain({16, 6, 5}, {true, false, false});
  VectorField<double, 3> velocity;
  for (auto& component : velocity) component = Field<double, 3>({16, 6, 5});
  const auto value = [](int k, int x, int y, int z) { return noise(x, y, z, k); };
  for_each_node(domain.block, [&](int x, int y, int z) {
    for (int k = 0; k < 3; ++k) velocity[k].row(y, z)[x] = value(k, x, y, z);
  });
  const WallVelocity walls{-0.1, 0.3};
  for (int i = 0; i < row_count(domain.block); ++i)
    fill_velocity_halo<double, 3>(velocity, row_of(domain.block, i), domain, walls);
  for (int k = 0; k < 3; ++k) {
    const double upper = k == 0 ? 2 * walls.upper : 0;
    CHECK(velocity[k].row(3, -1)[4] == -value(k, 4, 3, 0));
    CHECK(velocity[k].row(3, 6)[4] == -value(k, 4, 3, 3));
    CHECK(velocity[k].row(6, 2)[4] == upper - value(k, 4, 5, 2));
    CHECK(velocity[k].row(7, -2)[4] == Approx(value(k, 4, 4, 1) - upper).epsilon(1e-15));
    CHECK(velocity[k].row(3, -1)[-2] == -value(k, 14, 3, 0));
  }
}

TEMPLATE_TEST_CASE("in three dimensions mass, speed and energy are those of the moments", "", float, double) {
  const Domain<3> domain({21, 6, 5}, {true, false, true});
  const FluidSetting<3> setting{.domain = domain, .relaxation_rate = 1.0, .body_force = {1e-3, -2e-3, 5e-4}};
  Fluid3<TestType> fluid(setting, trt_in_space(1, false));
  fluid.set_state(noisy_state<TestType>);
  fluid.settle();
  double mass = 0, square = 0, kinetic = 0;
  for (const Moments<3>& m : fluid.all_moments()) {
    double own = 0;
    for (const double u : m.velocity) own += u * u;
    mass += m.density, square = std::max(square, own), kinetic += own / 2;
  }
  const double rounding = std::numeric_limits<TestType>::epsilon();
  const auto found = fluid.mass_and_speed();
  CHECK(found.mass == Approx(mass).margin(21 * 6 * 5 * 0.01 * rounding));
  CHECK(found.speed == Approx(std::sqrt(square)).epsilon(10 * rounding));
  CHECK(fluid.energetics().kinetic == Approx(kinetic).epsilon(1e-12));
}

TEST_CASE("the flow rate of a duct is exact for velocities that are parabolas from wall to wall in both directions") {
  const Domain<3> domain({4, 12, 7}, {true, false, false});
  std::vector<double> rows;
  for (int i = 0; i < row_count(domain.block); ++i) {
    const auto [y, z] = row_of(domain.block, i);
    const double a = (y + 0.5) / 12, b = (z + 0.5) / 7;
    rows.push_back(a * (1 - a) * b * (1 - b));
  }
  CHECK(flow_rate(rows, {}, domain) == Approx(12.0 * 7 / 36).epsilon(2e-4));  // the corrections' product is left out
}

TEST_CASE(
    "solid nodes have no moments, no speed and no share in the mass, and count as nodes at rest in the flow rate") {
  const Domain<3> domain({18, 5, 4}, {true, false, true});
  FluidSetting<3> setting{.domain = domain, .relaxation_rate = 1.0, .body_force = {1e-3, 0, 0}};
  setting.solid = some_solid(domain.size);
  Fluid3<double> fluid(setting, trt_in_space(1, false));
  fluid.set_state(noisy_state<double>);
  for (int step = 0; step < 3; ++step) {
    fluid.settle();
    const auto moments = fluid.all_moments();
    double mass = 0, square = 0, sum = 0, moved = 0;
    for (int i = 0; i < row_count(domain.block); ++i) {
      const auto [y, z] = row_of(domain.block, i);
      for (int x = 0; x < 18; ++x) {
        const Moments<3>& m = moments[static_cast<std::size_t>(18 * i + x)];
        double own = 0;
        for (const double u : m.velocity) own += u * u;
        if (setting.solid->at({x, y, z})) moved += own + std::abs(m.density);
        mass += m.density, square = std::max(square, own), sum += m.velocity[0];
      }
    }
    CHECK(moved == 0);
    const auto found = fluid.mass_and_speed();
    CHECK(found.mass == Approx(mass).margin(1e-15));
    CHECK(found.speed == Approx(std::sqrt(square)).epsilon(1e-14));
    for (const auto& rows : {fluid.row_velocities(), fluid.row_velocities_without_membranes()})
      CHECK(18 * flow_rate(rows, {}, domain, true) == Approx(sum).epsilon(1e-12));
    CHECK(std::isnan(fluid.wall_stress().lower));
    fluid.step(fluid.rows());
    fluid.end_step();
  }
  std::vector<double> values;
  fluid.copy_populations(3, values);
  for (int i = 0; i < row_count(domain.block); ++i) {
    const auto [y, z] = row_of(domain.block, i);
    for (int x = 0; x < 18; ++x) {
      if (setting.solid->at({x, y, z})) CHECK(values[static_cast<std::size_t>(18 * i + x)] == 0);
    }
  }
}
