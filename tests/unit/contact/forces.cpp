// Membrane laws and interactions as forces: gradients, balances, independence of the workers.
#include <catch2/catch.hpp>
#include <limits>

#include "core/contact/interactions.hpp"
#include "core/membrane/geometry.hpp"
#include "core/membrane/membrane_forces.hpp"
#include "core/membrane/turning_angle.hpp"
#include "unit/cell_fixture.hpp"
#include "unit/contact/contact_list.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

const std::vector<Placed> rouleau_of_three = {{0, -18, 0.05}, {2, 0, 0.0}, {-1, 18, -0.08}};

MembraneForces membrane_forces(Membranes& m, MembraneLaws laws) { return {m, {.laws = {std::move(laws)}}}; }

void run(Interactions<2>& forces, Membranes& m, int workers = 1) {
  for (int phase = 0; phase < Interactions<2>::phases; ++phase) {
    run_pass(workers, [&](Worker worker) { forces.run(worker, phase, m); });
  }
}
void clear(Membranes& m) {
  std::fill(m.force[0].begin(), m.force[0].end(), 0.0);
  std::fill(m.force[1].begin(), m.force[1].end(), 0.0);
}

}  // namespace

TEST_CASE("the turning angle is the two-argument arc tangent to 1e-14") {
  double worst = 0;
  for (int k = -200000; k <= 200000; ++k) {
    const double angle = k * (3.141592653589793 / 200000);
    for (const double tiny : {1.0, 1e-5}) {
      const double s = std::sin(angle * tiny), c = std::cos(angle * tiny), exact = std::atan2(s, c);
      const double error = std::abs(turning_angle<double>(s, c) - exact);
      if (exact != 0) worst = std::max(worst, error / std::abs(exact));
    }
  }
  CHECK(worst < 1e-14);
  CHECK(turning_angle<double>(0.0, 0.0) == 0);
  CHECK(turning_angle<double>(0.0, 1.0) == 0);
  CHECK(std::abs(turning_angle<double>(0.0, -1.0)) == Approx(3.141592653589793));
}

TEST_CASE("membrane forces are minus the gradient of the energy") {
  const unsigned seed = GENERATE(1u, 2u, 3u);
  auto random = generator(seed);
  const bool elastic = GENERATE(true, false);
  Membranes m = biconcave_cells({{100, 60, 0.4}, {160, 70, 2}}, elastic ? 100 : 93);
  deform(m, random, 4, 0.2);
  MembraneForces forces = membrane_forces(m, {elastic ? neo_hookean(0.1) : bending(0.5)});
  forces.run({}, m);
  // Central differences: truncation 1e-4^2, rounding 1e-16 E / (1e-4 F).
  CHECK(gradient_error(
            m, [&] { return forces.energy(m); }, 1e-4) < 1e-7);
}

TEST_CASE("membrane forces have no net force and no net torque") {
  auto random = generator(11);
  Membranes m = biconcave_cells({{100, 60, 0.4}, {160, 70, 2}});
  deform(m, random, 6, 0.3);
  const MembraneLaws laws = GENERATE(MembraneLaws{neo_hookean(0.1)}, MembraneLaws{bending(0.5)},
                                     MembraneLaws{neo_hookean(0.1), bending(0.5), neo_hookean(0.3)});
  MembraneForces forces = membrane_forces(m, laws);
  forces.run({}, m);
  const ForceSums sums = force_sums(m);
  REQUIRE(sums.size > 0);
  CHECK(std::abs(sums.x) < 1e-12 * sums.size);
  CHECK(std::abs(sums.y) < 1e-12 * sums.size);
  CHECK(std::abs(sums.torque) < 1e-12 * sums.lever);
}

TEST_CASE("laws of one cell type add up") {
  auto random = generator(12);
  Membranes m = biconcave_cells({{100, 60, 0.4}});
  deform(m, random, 4, 0.1);
  Membranes together = m, one = m, two = m;
  membrane_forces(m, {neo_hookean(0.1), bending(0.4)}).run({}, together);
  membrane_forces(m, {neo_hookean(0.1)}).run({}, one);
  membrane_forces(m, {bending(0.4)}).run({}, two);
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(together.force[0][i] == Approx(one.force[0][i] + two.force[0][i]).margin(1e-14));
  }
  MembraneForces forces = membrane_forces(m, {neo_hookean(0.1), bending(0.4)});
  const std::vector<double> tension = forces.tensions(m, 0);
  const double dx = m.position[0][1] - m.position[0][0], dy = m.position[1][1] - m.position[1][0],
               e = std::hypot(dx, dy) / m.types[0]->rest_length[0];
  CHECK(tension[0] == Approx(0.1 * (std::pow(e, 1.5) - std::pow(e, -1.5))));
}

TEST_CASE("cells feel the laws of their own type alone, in any order") {
  auto random = generator(13);
  Membranes m = biconcave_cells({{100, 60, 0.4}, {160, 70, 2}, {220, 60, 1}, {280, 60, 0}});
  deform(m, random, 4, 0.1);
  const std::vector<MembraneLaws> laws = {{neo_hookean(0.1), bending(0.4)}, {bending(0.3)}, {neo_hookean(0.2)}, {}};
  std::vector<Membranes> alone;
  for (const MembraneLaws& list : laws) {
    alone.push_back(m);
    membrane_forces(m, list).run({}, alone.back());
  }
  const std::vector<int> order = GENERATE(std::vector<int>{0, 1, 2, 3}, std::vector<int>{0, 3, 2, 1});
  for (std::size_t c = 0; c < order.size(); ++c) m.cells[c].type = order[c];
  MembraneForces(m, {.laws = laws}).run({}, m);
  for (const CellRange& cell : m.cells) {
    const Membranes& expected = alone[static_cast<std::size_t>(cell.type)];
    for (auto i = static_cast<std::size_t>(cell.first); i < static_cast<std::size_t>(cell.end()); ++i) {
      REQUIRE(m.force[0][i] == expected.force[0][i]);
      REQUIRE(m.force[1][i] == expected.force[1][i]);
    }
  }
}

TEST_CASE("a cell at rest feels no force, and a law that does nothing leaves none behind") {
  Membranes m = biconcave_cells({{100, 60, 0.4}});
  std::fill(m.force[0].begin(), m.force[0].end(), 7.0);
  membrane_forces(m, {neo_hookean(0.1), bending(0.4)}).run({}, m);
  for (const double force : m.force[0]) REQUIRE(std::abs(force) < 1e-12);
  std::fill(m.force[0].begin(), m.force[0].end(), 7.0);
  membrane_forces(m, {}).run({}, m);
  for (const double force : m.force[0]) REQUIRE(force == 0);
}

TEST_CASE("interaction forces are minus the gradient of the energy") {
  const unsigned seed = GENERATE(21u, 22u);
  auto random = generator(seed);
  const core::Domain<2> domain = GENERATE(periodic_box(10000), periodic_box(47), periodic_box(47, 54));
  Membranes m = biconcave_cells(rouleau_of_three);
  deform(m, random, 2, 0.02);
  // A deep cutoff: at 18 the Morse energy is e^-11 of its depth, so that nodes that come and go do not show.
  Interactions<2> forces(m, {{{0, 0}, morse(0.2, 0.75, 2.5, 18)}}, domain);
  run(forces, m);
  const auto energy = [&] {
    run(forces, m);
    return forces.energy(m);
  };
  // At a node whose closest point is about to jump to another segment the energy has a kink; few nodes are at one.
  CHECK(gradient_error(m, energy, 1e-5) < 1e-7);
}

TEST_CASE("interaction forces have no net force and no net torque") {
  auto random = generator(31);
  Membranes m = biconcave_cells(rouleau_of_three);
  deform(m, random, 3, 0.1);
  Interactions<2> forces(m, {{{0, 0}, morse(0.2, 0.75, 2.5, 18)}}, periodic_box(10000));
  run(forces, m);
  const ForceSums sums = force_sums(m);
  REQUIRE(sums.size > 0);
  CHECK(std::abs(sums.x) < 1e-12 * sums.size);
  CHECK(std::abs(sums.y) < 1e-12 * sums.size);
  CHECK(std::abs(sums.torque) < 1e-12 * sums.lever);
}

TEST_CASE("periodic images pull as other cells at the same places would") {
  Membranes one = biconcave_cells({{0, 0, 0}}), row = biconcave_cells({{-46, 0, 0}, {0, 0, 0}, {46, 0, 0}});
  Interactions<2> periodic(one, {{{0, 0}, morse(0.2, 0.4, 2.5, 18)}}, periodic_box(46));
  Interactions<2> open(row, {{{0, 0}, morse(0.2, 0.4, 2.5, 18)}}, periodic_box(100000));
  run(periodic, one);
  run(open, row);
  double size = 0;
  for (std::size_t i = 0; i < one.position[0].size(); ++i) {
    REQUIRE(one.force[0][i] == Approx(row.force[0][i + 100]).margin(1e-14));
    REQUIRE(one.force[1][i] == Approx(row.force[1][i + 100]).margin(1e-14));
    size += std::abs(one.force[0][i]);
  }
  CHECK(size > 1e-3);
  const ContactList list = contact_list(periodic.contacts(), one, 0);
  CHECK(*std::min_element(list.distance.begin(), list.distance.begin() + list.count) == Approx(6));
}

TEST_CASE("several potentials between two types add up, each within its own cutoff") {
  auto random = generator(41);
  Membranes m = biconcave_cells(rouleau_of_three);
  deform(m, random, 2);
  m.cells[1].type = 1;
  const auto far = morse(0.2, 0.3, 2.5, 18), near = morse(0.1, 0.5, 3, 6);
  Membranes both = m, first = m, second = m, other = m;
  Interactions<2> sum(m, {{{0, 1}, far}, {{1, 0}, near}}, periodic_box(10000)),
      a(m, {{{0, 1}, far}}, periodic_box(10000)), b(m, {{{0, 1}, near}}, periodic_box(10000)),
      c(m, {{{1, 1}, far}}, periodic_box(10000));
  run(sum, both), run(a, first), run(b, second), run(c, other);
  double size = 0;
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(both.force[1][i] == Approx(first.force[1][i] + second.force[1][i]).margin(1e-13));
    REQUIRE(other.force[1][i] == 0);
    size += std::abs(second.force[1][i]);
  }
  CHECK(size > 0);
  CHECK(sum.energy(both) == Approx(a.energy(first) + b.energy(second)));
}

TEST_CASE("the energies of pairs, from both sides, are the energy of all") {
  auto random = generator(43);
  Membranes m = biconcave_cells(rouleau_of_three);
  deform(m, random, 2);
  Interactions<2> forces(m, {{{0, 0}, morse(0.2, 0.3, 2.5, 18)}}, periodic_box(10000));
  run(forces, m);
  const std::vector<PairEnergy> pairs = forces.pair_energies(m);
  REQUIRE(pairs.size() == 4);  // the outer ones do not meet
  double sum = 0;
  for (const PairEnergy& pair : pairs) {
    CHECK(std::abs(pair.cell - pair.other) == 1);
    CHECK(pair.shift == ImageShift{});
    CHECK(pair.energy < 0);
    sum += pair.energy;
  }
  CHECK(sum == Approx(forces.energy(m)).epsilon(1e-12));
}

TEST_CASE("a strength is one value, a ramp or steps, and multiplies force and energy") {
  CHECK(Course{}.at(7) == 1);
  CHECK(Course{{0.3}}.at(7) == 0.3);
  const Course ramp{{1, 0.5}, false, 10}, steps{{1, 0.5, 0}, true, 30};
  CHECK(ramp.at(0) == 1);
  CHECK(ramp.at(5) == 0.75);
  CHECK(ramp.at(20) == 0.5);
  CHECK(steps.at(9) == 1);
  CHECK(steps.at(10) == 0.5);
  CHECK(steps.at(19) == 0.5);
  CHECK(steps.at(29) == 0);
  CHECK(steps.at(30) == 0);
  CHECK(ramp.changes());
  CHECK_FALSE(Course{{0.3}}.changes());

  auto random = generator(44);
  Membranes m = biconcave_cells(rouleau_of_three);
  deform(m, random, 2);
  Membranes whole = m, half = m;
  const auto potential = morse(0.2, 0.3, 2.5, 18);
  Interactions<2> as_it_is(m, {{{0, 0}, potential}}, periodic_box(10000)),
      ramped(m, {{{0, 0}, potential, {{1, 0}, false, 10}}}, periodic_box(10000));
  ramped.set_time(5);
  run(as_it_is, whole), run(ramped, half);
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    REQUIRE(half.force[1][i] == Approx(0.5 * whole.force[1][i]).margin(1e-15));
  CHECK(ramped.energy(half) == Approx(0.5 * as_it_is.energy(whole)));
  ramped.set_time(10);
  clear(half);
  run(ramped, half);
  for (const double force : half.force[0]) REQUIRE(force == 0);
}

TEST_CASE("forces are the same to the last bit for one, two and three workers") {
  auto random = generator(51);
  Membranes start = biconcave_cells({{0, -19, 0.05}, {2, 0, 0.0}, {-1, 18, -0.08}, {30, 30, 1.3}});
  deform(start, random, 2, 0.05);
  std::vector<Membranes> results;
  for (const int workers : {1, 2, 3}) {
    Membranes m = start;
    MembraneForces membrane = membrane_forces(m, {neo_hookean(0.1), bending(0.4)});
    Interactions<2> interaction(m, {{{0, 0}, morse(0.2, 0.3, 2.5, 18)}}, periodic_box(60, 90));
    for (int step = 0; step < 30; ++step) {
      run_pass(workers, [&](Worker worker) { membrane.run(worker, m); });
      run(interaction, m, workers);
      for (std::size_t i = 0; i < m.position[0].size(); ++i) {
        m.position[0][i] += 0.2 * m.force[0][i];
        m.position[1][i] += 0.2 * m.force[1][i];
      }
    }
    results.push_back(m);
  }
  for (std::size_t k = 1; k < results.size(); ++k) {
    CHECK(results[k].position[0] == results[0].position[0]);
    CHECK(results[k].force[1] == results[0].force[1]);
  }
}

TEST_CASE("coincident nodes and nodes on another outline give no NaN") {
  Membranes m = biconcave_cells({{0, 0, 0}, {0, 14, 0}});
  m.position[0][5] = m.position[0][4], m.position[1][5] = m.position[1][4];  // a segment without length
  // A node in the middle of a segment of the other cell, one on a node of it, one on its segment without length.
  m.position[0][150] = (m.position[0][20] + m.position[0][21]) / 2,
  m.position[1][150] = (m.position[1][20] + m.position[1][21]) / 2;
  m.position[0][160] = m.position[0][30], m.position[1][160] = m.position[1][30];
  m.position[0][170] = m.position[0][5], m.position[1][170] = m.position[1][5];
  membrane_forces(m, {bending(0.4)}).run({}, m);
  for (const double force : m.force[0]) REQUIRE(std::isfinite(force));
  clear(m);
  Interactions<2> interaction(m, {{{0, 0}, morse(0.2, 0.3, 2.5, 18)}}, periodic_box(10000));
  run(interaction, m);
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(std::isfinite(m.force[0][i]));
    REQUIRE(std::isfinite(m.force[1][i]));
  }
  const ForceSums sums = force_sums(m);
  CHECK(std::abs(sums.y) < 1e-12 * sums.size);
}

TEST_CASE("positions that are not numbers end no pass and cross no bound") {
  Membranes m = biconcave_cells({{0, 0, 0}, {0, 18, 0}});
  Interactions<2> interaction(m, {{{0, 0}, morse(0.2, 0.3, 2.5, 18)}}, periodic_box(60, 60));
  run(interaction, m);
  for (const double bad : {std::nan(""), 1e300, std::numeric_limits<double>::infinity()}) {
    Membranes broken = m;
    broken.position[0][7] = bad;
    broken.position[1][120] = -bad;
    run(interaction, broken);
    membrane_forces(broken, {neo_hookean(0.1), bending(0.4)}).run({}, broken);
  }
  SUCCEED();
}
