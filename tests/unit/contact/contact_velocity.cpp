// Velocities at contacts: the rate of the distance, and sliding that both cells see alike.
#include <catch2/catch.hpp>
#include <cmath>

#include "unit/cell_fixture.hpp"
#include "unit/contact/contact_list.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

constexpr double reach = 10;

std::vector<ContactList> search(const Membranes& m) {
  Cutoffs cutoffs(1);
  cutoffs.raise(0, 0, reach);
  SegmentContacts contacts(m, cutoffs, periodic_box(120));
  contacts.measure({}, m);
  contacts.refresh({}, m);
  std::vector<ContactList> found;
  for (int cell = 0; cell < m.cell_count(); ++cell) {
    found.push_back(contact_list(contacts, m, cell));
    contacts.measure_velocities(cell, m, found.back());
  }
  return found;
}

/// Three cells above one another, the lowest also beside its own image.
Membranes facing_cells(std::mt19937& random) {
  Membranes m = biconcave_cells({{0, 0, 0}, {5, 17, 0.05}, {100, 2, -0.1}});
  deform(m, random, 0.5);
  return m;
}

Membranes moved(Membranes m, double time) {
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    m.position[0][i] += time * m.velocity[0][i];
    m.position[1][i] += time * m.velocity[1][i];
  }
  return m;
}

}  // namespace

TEST_CASE("the normal velocity of a contact is the rate at which its distance changes") {
  auto random = generator(91);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Membranes m = facing_cells(random);
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    m.velocity[0][i] = uniform(random), m.velocity[1][i] = uniform(random);
  const double step = 1e-5;
  const std::vector<ContactList> now = search(m), before = search(moved(m, -step)), after = search(moved(m, step));
  int compared = 0;
  for (std::size_t cell = 0; cell < now.size(); ++cell) {
    const ContactList &list = now[cell], &earlier = before[cell], &later = after[cell];
    if (list.count != earlier.count || list.count != later.count) continue;
    for (std::size_t i = 0; i < static_cast<std::size_t>(list.count); ++i) {
      // Where the closest point goes over to another segment, the distance has a kink.
      if (list.segment[i] != earlier.segment[i] || list.segment[i] != later.segment[i]) continue;
      if (list.node[i] != earlier.node[i] || list.node[i] != later.node[i]) continue;
      const double rate = (later.distance[i] - earlier.distance[i]) / (2 * step);
      // Differences: rounding of distances up to ten over the step, and step^2 over the smallest distance.
      REQUIRE(list.normal_velocity[i] == Approx(rate).margin(1e-9));
      ++compared;
    }
  }
  CHECK(compared > 100);
}

TEST_CASE("two cells that slide against each other see the same sliding, and its size with the approach is the speed") {
  auto random = generator(92);
  Membranes m = facing_cells(random);
  const double u = 0.3, v = -0.4;
  const CellRange& upper = m.cells[1];
  for (auto i = static_cast<std::size_t>(upper.first); i < static_cast<std::size_t>(upper.end()); ++i) {
    m.velocity[0][i] = u;
    m.velocity[1][i] = v;
  }
  const std::vector<ContactList> found = search(m);
  double below = 0, above = 0;
  for (const std::size_t cell : {0UL, 1UL}) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(found[cell].count); ++i) {
      const double normal = found[cell].normal_velocity[i], tangential = found[cell].tangential_velocity[i];
      const double speed = std::hypot(normal, tangential);
      CHECK(found[cell].sliding_speed[i] == std::abs(tangential));
      CHECK((speed == Approx(0.5) || speed < 1e-15));  // against the upper cell, or against one that rests like it
      (cell == 0 ? below : above) += tangential;
    }
  }
  // The upper cell goes to the right: along its lower side that is counter-clockwise, and so it is for the lower cell,
  // which against it goes to the left along its upper side.
  CHECK(below > 0);
  CHECK(above > 0);
}

TEST_CASE("cells that move together neither approach nor slide") {
  auto random = generator(93);
  Membranes m = facing_cells(random);
  std::fill(m.velocity[0].begin(), m.velocity[0].end(), 0.7);
  std::fill(m.velocity[1].begin(), m.velocity[1].end(), -0.2);
  for (const ContactList& list : search(m)) {
    for (int i = 0; i < list.count; ++i) {
      CHECK(std::abs(list.normal_velocity[i]) < 1e-15);
      CHECK(std::abs(list.tangential_velocity[i]) < 1e-15);
    }
  }
}
