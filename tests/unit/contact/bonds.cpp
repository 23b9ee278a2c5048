// Interactions that remember: bonds between cells form, break, stay with their cells, and balance.
#include <catch2/catch.hpp>

#include "core/contact/interactions.hpp"
#include "unit/cell_fixture.hpp"
#include "unit/contact/contact_list.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

constexpr double sites = 0.7, stiffness = 0.3, bond_length = 2.5, on = 0.02, off = 0.03, forward_share = 0.4,
                 thermal = 0.9;

rouleau::core::Potential bridging(double on_rate = on, double off_rate = off, double cutoff = 8) {
  return potential("bridging", {sites, stiffness, bond_length, on_rate, off_rate, forward_share, thermal, cutoff});
}

Interactions<2> bonds_between(Membranes& m, rouleau::core::Potential bond,
                              core::Domain<2> domain = periodic_box(10000)) {
  return {m, {{{0, 0}, std::move(bond)}}, domain};
}

void run_cleared(Interactions<2>& forces, Membranes& m, int workers = 1) {
  for (auto* force : {&m.force[0], &m.force[1]}) std::fill(force->begin(), force->end(), 0.0);
  for (int phase = 0; phase < Interactions<2>::phases; ++phase) {
    run_pass(workers, [&](Worker worker) { forces.run(worker, phase, m); });
  }
}

/// Bond density of every contact of a cell with its only neighbour, in the order of the list.
std::vector<double> densities(const Interactions<2>& forces, const Membranes& m, int cell) {
  std::vector<double> values;
  const ContactList list = contact_list(forces.contacts(), m, cell);
  for (int i = 0; i < list.count; ++i) {
    const auto node = static_cast<std::size_t>(list.node[static_cast<std::size_t>(i)] -
                                               m.cells[static_cast<std::size_t>(cell)].first);
    values.push_back(m.contacts.of_cell[static_cast<std::size_t>(cell)].at(0).value[node]);
  }
  return values;
}

void move(Membranes& m, int cell, double x, double y) {
  const CellRange& range = m.cells[static_cast<std::size_t>(cell)];
  for (auto i = static_cast<std::size_t>(range.first); i < static_cast<std::size_t>(range.end()); ++i) {
    m.position[0][i] += x;
    m.position[1][i] += y;
  }
}

/// Gives the nodes bonds that depend on their distance and vanish towards the cutoff.
void set_bonds(const Interactions<2>& forces, Membranes& m) {
  for (int cell = 0; cell < m.cell_count(); ++cell) {
    const ContactList list = contact_list(forces.contacts(), m, cell);
    for (ContactState& state : m.contacts.of_cell[static_cast<std::size_t>(cell)]) {
      for (int i = 0; i < list.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const auto node = static_cast<std::size_t>(list.node[k] - m.cells[static_cast<std::size_t>(cell)].first);
        state.value[node] = list.distance[k] < 9 ? 0.5 + 0.01 * static_cast<double>(node) : 0;
      }
    }
  }
}

}  // namespace

TEST_CASE("bonds at a fixed distance follow the solution of their rate equation and end at its balance") {
  Membranes m = biconcave_cells({{0, 0, 0}, {1, 18, 0.03}});
  Interactions<2> forces = bonds_between(m, bridging());
  int done = 0;
  for (const int steps : {1, 9, 40, 2000}) {
    for (; done < steps; ++done) run_cleared(forces, m);
    for (const int cell : {0, 1}) {
      const std::vector<double> found = densities(forces, m, cell);
      REQUIRE(found.size() > 20);
      for (std::size_t i = 0; i < found.size(); ++i) {
        const double r = contact_list(forces.contacts(), m, cell).distance[i];
        const double energy = stiffness / 2 * (r - bond_length) * (r - bond_length) / thermal;
        const double forming = on * std::exp(-forward_share * energy),
                     rate = forming + off * std::exp((1 - forward_share) * energy);
        REQUIRE(found[i] == Approx(sites * forming / rate * (1 - std::exp(-steps * rate))).epsilon(1e-11));
      }
    }
  }
}

TEST_CASE("unstretched bonds in balance fill on/(on + off) of the sites") {
  Membranes m = biconcave_cells({{0, 0, 0}, {0, 18, 0}});
  Interactions<2> forces = bonds_between(m, bridging());
  run_cleared(forces, m);
  const ContactList list = contact_list(forces.contacts(), m, 0);
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(list.count); ++i) {
    if (std::abs(list.distance[i] - bond_length) < std::abs(list.distance[nearest] - bond_length)) nearest = i;
  }
  move(m, 1, 0, bond_length - list.distance[nearest]);
  for (int step = 0; step < 3000; ++step) run_cleared(forces, m);
  double most = 0;
  for (const double n : densities(forces, m, 0)) most = std::max(most, n);
  // No node is at exactly that distance; balance is flat there: 0.1 away costs stiffness/2 0.01/thermal = 0.2 %.
  CHECK(most <= sites * on / (on + off));
  CHECK(most == Approx(sites * on / (on + off)).epsilon(2e-3));
}

TEST_CASE("bonds stay with a node while the other surface slides past, and are lost beyond the cutoff") {
  Membranes m = biconcave_cells({{0, 0, 0}, {0, 18, 0}});
  Interactions<2> forces = bonds_between(m, bridging(0, 1e-300, 12));  // nothing forms or breaks
  run_cleared(forces, m);
  set_bonds(forces, m);
  const std::vector<double> before = m.contacts.of_cell[0].at(0).value;
  for (int step = 0; step < 30; ++step) {
    move(m, 1, 0.1, 0);  // three segments
    run_cleared(forces, m);
  }
  const ContactList list = contact_list(forces.contacts(), m, 0);
  int kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(list.count); ++i) {
    const auto node = static_cast<std::size_t>(list.node[i]);
    if (list.distance[i] > 10) continue;
    CHECK(m.contacts.of_cell[0].at(0).value[node] == before[node]);
    ++kept;
  }
  CHECK(kept > 20);
  move(m, 1, 0, 40);
  run_cleared(forces, m);
  CHECK(m.contacts.of_cell[0].empty());
  move(m, 1, 0, -40);
  run_cleared(forces, m);
  for (const double n : m.contacts.of_cell[0].at(0).value) CHECK(n == 0);
}

TEST_CASE("a cell between two others has bonds with each of them, and with its own image") {
  Membranes m = biconcave_cells({{0, -18, 0}, {0, 0, 0}, {0, 18, 0}});
  Interactions<2> forces = bonds_between(m, bridging(), periodic_box(44));
  for (int step = 0; step < 5; ++step) run_cleared(forces, m);
  std::vector<int> others;
  for (const ContactState& state : m.contacts.of_cell[1]) {
    others.push_back(state.other);
    CHECK(*std::max_element(state.value.begin(), state.value.end()) > 0);
  }
  std::sort(others.begin(), others.end());
  CHECK(others == std::vector<int>{0, 1, 1, 2});
}

TEST_CASE("forces of bonds are minus the gradient of their energy while none forms or breaks") {
  auto random = generator(301);
  Membranes m = biconcave_cells({{0, -18, 0.05}, {2, 0, 0.0}, {-1, 18, -0.08}});
  deform(m, random, 2, 0.02);
  Interactions<2> forces = bonds_between(m, bridging(0, 1e-300, 14));
  run_cleared(forces, m);
  set_bonds(forces, m);
  run_cleared(forces, m);
  const auto energy = [&] {
    run_cleared(forces, m);
    return forces.energy(m);
  };
  CHECK(forces.energy(m) > 0);
  CHECK(gradient_error(m, energy, 1e-5) < 1e-7);
}

TEST_CASE("bonds pull without net force and torque, whatever their history") {
  auto random = generator(302);
  Membranes m = biconcave_cells({{0, -18, 0.05}, {2, 0, 0.0}, {-1, 18, -0.08}});
  deform(m, random, 3, 0.1);
  Interactions<2> forces = bonds_between(m, bridging());
  for (int step = 0; step < 20; ++step) {
    move(m, 1, 0.05, 0.01);
    run_cleared(forces, m);
  }
  const ForceSums sums = force_sums(m);
  REQUIRE(sums.size > 0);
  CHECK(std::abs(sums.x) < 1e-12 * sums.size);
  CHECK(std::abs(sums.y) < 1e-12 * sums.size);
  CHECK(std::abs(sums.torque) < 1e-12 * sums.lever);
}

TEST_CASE("bonds add to other potentials, with a cutoff of their own") {
  Membranes m = biconcave_cells({{0, 0, 0}, {1, 18, 0.03}});
  Membranes both = m, one = m, other = m;
  Interactions<2> together(both, {{{0, 0}, morse(0.2, 0.3, 2.5, 18)}, {{0, 0}, bridging()}}, periodic_box(10000));
  Interactions<2> first(one, {{{0, 0}, morse(0.2, 0.3, 2.5, 18)}}, periodic_box(10000)),
      second(other, {{{0, 0}, bridging()}}, periodic_box(10000));
  for (int step = 0; step < 5; ++step) run_cleared(together, both), run_cleared(first, one), run_cleared(second, other);
  CHECK(one.contacts.of_cell.empty());
  double size = 0;
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(both.force[1][i] == Approx(one.force[1][i] + other.force[1][i]).margin(1e-14));
    size += std::abs(other.force[1][i]);
  }
  CHECK(size > 1e-3);
  CHECK(together.energy(both) == Approx(first.energy(one) + second.energy(other)));
}

TEST_CASE("bonds are the same to the last bit for one, two and three workers, and looking at them changes none") {
  auto random = generator(303);
  Membranes start = biconcave_cells({{0, -19, 0.05}, {2, 0, 0.0}, {-1, 18, -0.08}, {30, 30, 1.3}});
  deform(start, random, 2, 0.05);
  std::vector<Membranes> results;
  for (const int workers : {1, 2, 3}) {
    Membranes m = start;
    Interactions<2> forces = bonds_between(m, bridging(), periodic_box(60, 90));
    for (int step = 0; step < 30; ++step) {
      run_cleared(forces, m, workers);
      if (workers == 2) (void)forces.energy(m);
      for (std::size_t i = 0; i < m.position[0].size(); ++i) {
        m.position[0][i] += 0.5 * m.force[0][i];
        m.position[1][i] += 0.5 * m.force[1][i];
      }
    }
    results.push_back(m);
  }
  for (std::size_t k = 1; k < results.size(); ++k) {
    CHECK(results[k].position[0] == results[0].position[0]);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto &found = results[k].contacts.of_cell[c], &expected = results[0].contacts.of_cell[c];
      REQUIRE(found.size() == expected.size());
      for (std::size_t p = 0; p < found.size(); ++p) CHECK(found[p].value == expected[p].value);
    }
  }
}

TEST_CASE("the state of contacts goes on in lattice units of another size") {
  Membranes m = biconcave_cells({{0, 0, 0}, {1, 18, 0.03}});
  Interactions<2> forces = bonds_between(m, bridging());
  run_cleared(forces, m);
  const double before = densities(forces, m, 0)[3];
  m.contacts.variables[0].initial = 0.1;
  m.contacts.change_unit(0, 4);  // 1/m2, with a spacing of half a metre
  CHECK(densities(forces, m, 0)[3] == Approx(before / 4));
  CHECK(m.contacts.variables[0].initial == Approx(0.1 / 4));
}
