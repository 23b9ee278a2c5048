// Flow between openings at the ends of an axis, by velocity and by pressure.
#include "core/fluid/openings/opening.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <thread>

#include "core/domain/decomposition.hpp"
#include "core/domain/transport.hpp"
#include "core/fluid/openings/section.hpp"
#include "unit/flow_fixture.hpp"
#include "unit/shipped_models.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

Opening velocity(double value) { return {Opening::Kind::velocity, value}; }
Opening pressure(double value) { return {Opening::Kind::pressure, value}; }

template <int D>
FluidSetting<D> open_setting(const Domain<D>& domain, double tau, const Opening& lower, const Opening& upper) {
  return {.domain = domain, .relaxation_rate = 1 / tau, .openings = std::array{lower, upper}};
}

/// Steps in which what is missing in a channel of this height has become less than its e^-times.
long settled(double height, double tau, double times) {
  return std::lround(times * height * height / (M_PI * M_PI * (tau - 0.5) / 3));
}

/// L2 error of the velocity in a plane channel over its L2 norm, where this gradient drives it.
double poiseuille_error(Fluid<double>& fluid, double gradient) {
  const auto [nx, ny] = fluid.setting().domain.size;
  const double viscosity = (1 / fluid.setting().relaxation_rate - 0.5) / 3;
  double error = 0, norm = 0;
  std::vector<Moments<2>> row;
  fluid.settle();
  for (int y = 0; y < ny; ++y) {
    fluid.moments(y, row);
    const double s = y - (ny - 1) / 2.0, exact = gradient / (2 * viscosity) * (ny * ny / 4.0 - s * s);
    for (int x = 0; x < nx; ++x) {
      error += std::pow(row[x].velocity[0] - exact, 2) + std::pow(row[x].velocity[1], 2);
      norm += exact * exact;
    }
  }
  return std::sqrt(error / norm);
}

/// Of a channel twice as long as it is high, with a mean velocity of 0.01 over its height.
double error_between_openings(bool by_velocity, int height, double tau) {
  const double mean = 0.01 / height, gradient = 12 * (tau - 0.5) / 3 * mean / (height * height);
  const Domain<2> domain{{2 * height, height}, {false, false}};
  Fluid<double> fluid(
      open_setting(domain, tau, by_velocity ? velocity(mean) : pressure(gradient * domain.size[0]), pressure(0)),
      trt(tau, false));
  advance(fluid, settled(height, tau, 30));
  return poiseuille_error(fluid, gradient);
}

template <class T, class Set>
std::unique_ptr<Fluid<T, Set>> started(FluidSetting<Set::dimension> setting, const Domain<Set::dimension>& domain,
                                       const Ranks<Set::dimension>& ranks) {
  setting.domain = domain;
  const double tau = 1 / setting.relaxation_rate;
  auto fluid = std::make_unique<Fluid<T, Set>>(setting, trt(tau, setting.inertia, Set::dimension), ranks);
  const auto noise = [](int x, int y, int z) {
    NodeState<Set::dimension> state{};
    state.density = 1e-4 * ((x * 73 + y * 191 + z * 37) % 101 - 50);
    state.velocity[1] = 1e-4 * ((x * 31 + y * 17 + z * 91) % 103 - 51);
    return state;
  };
  if constexpr (Set::dimension == 2) {
    fluid->set_state([&](int x, int y) { return noise(x, y, 0); });
  } else {
    fluid->set_state(noise);
  }
  return fluid;
}

/// Populations of all nodes and the flow at the ends after so many steps, in blocks that are ranks of one process.
template <class T, class Set>
void compare_with_blocks(const FluidSetting<Set::dimension>& setting, const Decomposition<Set::dimension>& cut,
                         int steps) {
  const auto whole = started<T, Set>(setting, setting.domain, {});
  advance(*whole, steps);
  whole->settle();
  const auto flows = whole->end_flows();
  const auto passed = whole->passed();
  const auto ends = make_loopback(cut.ranks());
  std::vector<long> different(ends.size());
  std::vector<std::thread> threads;
  for (int rank = 0; rank < cut.ranks(); ++rank) {
    threads.emplace_back([&, rank] {
      const auto block = started<T, Set>(setting, cut.domain(rank), {&cut, ends[rank].get()});
      for (int i = 0; i < steps; ++i) {
        block->step(block->rows());
        block->end_step();
        block->begin_halo();
        block->end_halo();
      }
      block->settle();
      const Box<Set::dimension>& box = block->setting().domain.block;
      for (int i = 0; i < block->rows().end; ++i) {
        const auto row = row_of(box, i);
        auto of_whole = row;
        std::array<int, Set::dimension> node;
        for (int k = 1; k < Set::dimension; ++k) node[k] = of_whole[k - 1] += box.begin[k];
        for (int x = 0; x < box.size(0); ++x) {
          node[0] = x + box.begin[0];
          if (setting.solid && setting.solid->at(node)) continue;
          for (int q = 0; q < Set::velocity_count; ++q)
            different[rank] += block->population(q, x, row) != whole->population(q, node[0], of_whole) ? 1 : 0;
        }
      }
      different[rank] += block->passed() != passed;
      const auto flows_too = block->end_flows();
      for (std::size_t end = 0; end < 2; ++end)
        different[rank] += flows_too[end].flow != flows[end].flow || flows_too[end].pressure != flows[end].pressure ||
                           flows_too[end].of_parts != flows[end].of_parts;
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const long count : different) CHECK(count == 0);
  CHECK(std::isfinite(flows[0].flow));
}

/// `noise` at the start, so that the fluid's mass changes, too.
template <class T, class Set>
void check_balance(const Domain<Set::dimension>& domain, const Opening& lower, double tolerance) {
  constexpr int steps = 500;
  FluidSetting<Set::dimension> setting = open_setting(domain, 0.9, lower, pressure(0));
  setting.inertia = true;
  const auto fluid = started<T, Set>(setting, domain, {});
  const double before = fluid->mass();
  advance(*fluid, steps);
  fluid->settle();
  const auto passed = fluid->passed();
  const double in = passed[0].at(0), out = -passed[1].at(0), gained = fluid->mass() - before;
  CHECK(in > 10);
  CHECK(std::abs(gained) > 1e3 * tolerance * in);
  CHECK(std::abs(in - out - gained) < tolerance * in);
  if (lower.kind == Opening::Kind::velocity)
    CHECK(in == Approx(lower.value * steps * static_cast<double>(domain.nodes()) / domain.size[0]).epsilon(tolerance));

  const auto other = started<T, Set>(setting, domain, {});
  other->restore(
      [&](int q) {
        std::vector<double> values;
        fluid->copy_populations(q, values);
        return values;
      },
      true);
  other->recall_links(fluid->link_memory());
  for (auto* const one : {fluid.get(), other.get()}) advance(*one, 3), one->settle();
  CHECK(other->passed() == fluid->passed());
}

/// x and another axis exchanged.
template <class V>
V turned(V along, int axis) {
  std::swap(along[0], along[static_cast<std::size_t>(axis)]);
  return along;
}

/// Open along an axis, with walls of solid nodes: the same for any axis, but for the exchange with x.
template <int D>
FluidSetting<D> turned_setting(int axis, const Opening& lower) {
  using Node = std::array<int, D>;
  Node size;
  std::array<bool, D> periodic;
  size.fill(9), periodic.fill(true);
  size[0] = 14, size[1] = 11, periodic[0] = false;
  Domain<D> domain(turned(size, axis), turned(periodic, axis));
  domain.open_axis = axis;
  FluidSetting<D> setting = open_setting(domain, 0.9, lower, pressure(0));
  setting.inertia = true;
  setting.body_force[axis] = 1e-5;
  const auto is_solid = [axis](const Node& there) {
    const Node at = turned(there, axis);
    const bool walls = at[1] < 2 || at[D - 1] == 0, block = at[0] > 4 && at[0] < 8 && at[1] > 7;
    return walls || block || (at[0] > 9 && at[1] == 5);
  };
  const auto cut = [](const Node&, const Node& to) {
    int links = 0;
    for (const int along : to) links += std::abs(along);
    return links == 1 ? 0.3 : 0.45;
  };
  setting.solid = std::make_shared<const SolidNodes<D>>(domain.size, is_solid, cut);
  return setting;
}

template <class Set>
std::unique_ptr<Fluid<double, Set>> turned_fluid(int axis, const Opening& lower) {
  constexpr int D = Set::dimension;
  const FluidSetting<D> setting = turned_setting<D>(axis, lower);
  auto fluid = std::make_unique<Fluid<double, Set>>(setting, trt(0.9, true, D));
  const auto noise = [axis](const std::array<int, D>& there) {
    const std::array<int, D> at = turned(there, axis);
    int mixed = 0;
    for (int k = 0; k < D; ++k) mixed = 31 * mixed + 17 * at[k];
    NodeState<D> state{};
    state.density = 1e-4 * (mixed % 101 - 50);
    for (int k = 0; k < D; ++k) state.velocity[k] = 1e-4 * ((k + 3) * mixed % 103 - 51);
    std::swap(state.velocity[0], state.velocity[axis]);
    return state;
  };
  if constexpr (D == 2) {
    fluid->set_state([&](int x, int y) { return noise({x, y}); });
  } else {
    fluid->set_state([&](int x, int y, int z) { return noise({x, y, z}); });
  }
  advance(*fluid, 23);
  fluid->settle();
  return fluid;
}

/// Populations, flows, what walls get and what is dissipated, against the same along x.
template <class Set>
void compare_turned(int axis, const Opening& lower) {
  constexpr int D = Set::dimension;
  const auto along_x = turned_fluid<Set>(0, lower), along_axis = turned_fluid<Set>(axis, lower);
  const Domain<D>& domain = along_x->setting().domain;
  double off = 0, largest = 0;
  for (int i = 0; i < row_count(domain.block); ++i) {
    const auto row = row_of(domain.block, i);
    for (int x = 0; x < domain.size[0]; ++x) {
      std::array<int, D> node{x};
      std::copy(row.begin(), row.end(), node.begin() + 1);
      if (along_x->setting().solid->at(node)) continue;
      const std::array<int, D> there = turned(node, axis);
      auto row_there = row;
      std::copy(there.begin() + 1, there.end(), row_there.begin());
      for (int q = 0; q < Set::velocity_count; ++q) {
        int to = 0;
        for (bool same = false; !same; to += same ? 0 : 1) {
          same = true;
          for (int k = 0; k < D; ++k)
            same = same && Set::velocity[to][k == 0 ? axis : k == axis ? 0 : k] == Set::velocity[q][k];
        }
        const double value = along_x->population(q, x, row);
        largest = std::max(largest, std::abs(value));
        off = std::max(off, std::abs(value - along_axis->population(to, there[0], row_there)));
      }
    }
  }
  CHECK(largest > 1e-5);
  CHECK(off < 1e-13);
  const auto flows = along_x->end_flows(), flows_too = along_axis->end_flows();
  for (const int end : {0, 1}) {
    CHECK(flows_too[end].flow == Approx(flows[end].flow).epsilon(1e-11));
    CHECK(flows_too[end].pressure == Approx(flows[end].pressure).margin(1e-14));
    CHECK(flows_too[end].of_parts.size() == flows[end].of_parts.size());
  }
  const auto forces = along_x->wall_forces(), forces_too = along_axis->wall_forces();
  for (int k = 0; k < D; ++k)
    CHECK(forces_too.all(k == 0 ? axis : k == axis ? 0 : k) == Approx(forces.all(k)).margin(1e-13));
  CHECK(along_axis->energetics().dissipation == Approx(along_x->energetics().dissipation).epsilon(1e-10));
}

}  // namespace

TEST_CASE("what has come in through openings, less what has left, is what the fluid has gained") {
  for (const Opening& lower : {velocity(0.02), pressure(0.004)}) {
    check_balance<double, D2Q9>({{14, 11}, {false, false}}, lower, 1e-12);
    check_balance<float, D2Q9>({{14, 11}, {false, false}}, lower, 1e-6);
    check_balance<double, D3Q19>({{14, 7, 5}, {false, false, true}}, lower, 1e-12);
  }
}

TEST_CASE("the developed flow of a section: exact between planes, uniform without walls") {
  const Domain<2> channel{{4, 9}, {false, false}};
  const Section plane = section_at<2>(channel, nullptr, {-0.5, 1}, 0);
  for (int y = 0; y < 9; ++y) {
    const double s = y - 4.0;
    CHECK(plane.driven[y] == Approx((4.5 * 4.5 - s * s) / 2).epsilon(1e-12));
    CHECK(plane.dragged[y] == Approx(0.25 + 1.5 * s / 9).margin(1e-12));
  }
  const Section open = section_at<2>({{4, 9}, {false, true}}, nullptr, {}, 0);
  CHECK(open.velocity(3, 0.2) == 0.2);
}

TEST_CASE("openings beside each other are numbered from the lowest, over periods, too") {
  const auto stripes = [](int height, bool periodic, const std::string& rows) {
    return parts_of_section<2>({{4, height}, {false, periodic}}, 0,
                               [&](const auto& node) { return rows.at(static_cast<std::size_t>(node[1])) == '.'; });
  };
  CHECK(stripes(8, false, "..##.#..") == std::vector<int>{0, 0, -1, -1, 1, -1, 2, 2});
  CHECK(stripes(8, true, "..##.#..") == std::vector<int>{0, 0, -1, -1, 1, -1, 0, 0});
  // A cross of walls parts a duct into four, numbered along y first; a hole in it joins two of them.
  for (const bool hole : {false, true}) {
    const auto parts = parts_of_section<3>({{2, 5, 5}, {false, false, false}}, 1, [&](const std::array<int, 3>& node) {
      return (hole && node[1] == 2 && node[2] == 4) || (node[1] != 2 && node[2] != 2);
    });
    CHECK((parts[0] == 0 && parts[3] == 1 && parts[2] == -1 && parts[12] == -1 && parts[15] == 2));
    CHECK(parts[24] == (hole ? 2 : 3));
  }
}

TEST_CASE("plane Poiseuille flow between openings is of second order, by velocity and by pressure") {
  const bool by_velocity = GENERATE(true, false);
  const double tau = GENERATE(0.8, 2.0);
  const double coarse = error_between_openings(by_velocity, 8, tau),
               fine = error_between_openings(by_velocity, 16, tau);
  CAPTURE(by_velocity, tau, coarse, fine);
  CHECK(fine < 3e-3);
  CHECK(std::log2(coarse / fine) > 1.8);
}

TEMPLATE_TEST_CASE("between openings blocks give the same bits as one lattice", "", float, double) {
  const bool by_velocity = GENERATE(true, false), periodic_y = GENERATE(false, true);
  const Opening lower = by_velocity ? velocity(0.01) : pressure(0.001);
  FluidSetting<2> flat = open_setting<2>({{13, 10}, {false, periodic_y}}, 0.8, lower, pressure(0));
  flat.inertia = true, flat.walls = {-0.01, 0.02}, flat.body_force = {1e-5, 0};
  for (const std::array<int, 2> cut : {std::array{2, 1}, std::array{1, 2}, std::array{3, 3}, std::array{13, 1}})
    compare_with_blocks<TestType, D2Q9>(flat, Decomposition<2>::even(flat.domain, cut), 17);
  const Domain<3> domain{{8, 11, 11}, {false, false, false}};
  FluidSetting<3> tube = open_setting(domain, 1.2, lower, pressure(0));
  tube.solid = std::make_shared<const SolidNodes<3>>(domain.size, tube_region(domain.size, 4.6));
  compare_with_blocks<TestType, D3Q19>(tube, Decomposition<3>::even(domain, {2, 2, 2}), 12);
}

TEST_CASE("flow between openings along any axis is that along x, turned") {
  const Opening lower = GENERATE(0, 1) == 0 ? velocity(0.01) : pressure(0.001);
  compare_turned<D2Q9>(1, lower);
  compare_turned<D3Q19>(1, lower);
  compare_turned<D3Q19>(2, lower);
}

TEST_CASE("between openings across rows blocks give the same bits as one lattice") {
  const Opening lower = GENERATE(0, 1) == 0 ? velocity(0.01) : pressure(0.001);
  const FluidSetting<2> flat = turned_setting<2>(1, lower);
  for (const std::array<int, 2> cut : {std::array{2, 1}, std::array{1, 2}, std::array{3, 3}})
    compare_with_blocks<double, D2Q9>(flat, Decomposition<2>::even(flat.domain, cut), 17);
  for (const int axis : {1, 2}) {
    const FluidSetting<3> deep = turned_setting<3>(axis, lower);
    compare_with_blocks<float, D3Q19>(deep, Decomposition<3>::even(deep.domain, {2, 2, 2}), 12);
  }
}

TEST_CASE("a fluid between openings goes on from its populations to the same bits") {
  const Domain<2> domain{{12, 8}, {false, false}};
  const FluidSetting<2> setting = open_setting(domain, 0.9, velocity(0.01), pressure(0));
  const int before = GENERATE(6, 7);
  const auto fluid = started<double, D2Q9>(setting, domain, {});
  advance(*fluid, before);
  fluid->settle();
  Fluid<double> resumed(setting, trt(0.9, false));
  resumed.restore(
      [&](int q) {
        std::vector<double> values;
        fluid->copy_populations(q, values);
        return values;
      },
      true);
  advance(*fluid, 9), advance(resumed, 9);
  fluid->settle(), resumed.settle();
  long different = 0;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 12; ++x) {
      for (int q = 0; q < 9; ++q) different += fluid->population(q, x, y) != resumed.population(q, x, y) ? 1 : 0;
    }
  }
  CHECK(different == 0);
}
