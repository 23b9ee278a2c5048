// Contacts over periodic images, clusters, and when outputs are due.
#include "observe/aggregates.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "core/contact/crossing.hpp"
#include "core/contact/triangle_contacts.hpp"
#include "core/contact/wall_gap.hpp"
#include "core/membrane/geometry.hpp"
#include "core/surface/triangle_surface.hpp"
#include "scene/output_schedule.hpp"
#include "unit/periodic_box.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;
using namespace rouleau::plan;

namespace {

/// Circles of radius 5 with n nodes at the given centres.
Membranes circles(const std::vector<std::array<double, 2>>& centres, int n = 60) {
  std::vector<double> x, y;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    x.push_back(5 * std::cos(angle));
    y.push_back(5 * std::sin(angle));
  }
  Membranes m;
  m.types.push_back(std::make_shared<const RestShape>(make_rest_shape(std::move(x), std::move(y))));
  for (const auto& c : centres) add_cell(m, 0, c[0], c[1], 0);
  return m;
}

std::vector<double> gaps_of(const Membranes& m, const Domain<2>& domain) {
  Surroundings<2> all(m);
  return smallest_gaps(all, domain);
}

}  // namespace

TEST_CASE("two circles are in contact exactly when their gap is below the reach") {
  const Membranes m = circles({{20, 20}, {32, 20}});
  CHECK(find_touching_cells(m, test::periodic_box(100), 1.9).empty());
  const auto contacts = find_touching_cells(m, test::periodic_box(100), 2.1);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(2).epsilon(1e-12));
  CHECK(contacts[0].image == ImageShift{0, 0});
  CHECK(contacts[0].contact_length > 0);
}

TEST_CASE("the gap to a wall is that of the nearer one, less than nothing beyond it, and none between periodic sides") {
  const Membranes m = circles({{20, 6}, {50, 12.25}, {80, 3.5}});
  const Domain<2> channel({100, 20}, {true, false});
  CHECK(wall_gap(m, m.cells[0], channel) == Approx(1.5));
  CHECK(wall_gap(m, m.cells[1], channel) == Approx(19.5 - 17.25));
  CHECK(wall_gap(m, m.cells[2], channel) == Approx(-1));
  CHECK(std::isnan(wall_gap(m, m.cells[0], test::periodic_box(100, 20))));
  Membranes broken = m;
  broken.position[0][7] = std::nan("");
  CHECK(std::isnan(wall_gap(broken, broken.cells[0], channel)));
}

TEST_CASE("a contact across the periodic border is found and flagged, however far the cells have drifted") {
  const double drift = GENERATE(0.0, 300.0, -700.0);
  const Membranes m = circles({{4 + drift, 20}, {95, 20}, {50, 20}});
  const auto contacts = find_touching_cells(m, test::periodic_box(100), 1.0);
  REQUIRE(contacts.size() == 1);
  const Aggregates a = find_aggregates(3, contacts);
  CHECK(a.count == 2);
  CHECK(a.label == std::vector<int>{0, 0, 2});
  CHECK(a.through_image == std::vector<bool>{true, true, false});
}

TEST_CASE("a cell can touch its own image in a small box, and is then one aggregate") {
  const Membranes m = circles({{4, 20}});
  const auto contacts = find_touching_cells(m, test::periodic_box(11), 1.5);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].cell_a == contacts[0].cell_b);
  CHECK(find_aggregates(1, contacts).count == 1);
}

TEST_CASE(
    "contacts and smallest gaps of many cells are those of a search through all pairs, to the bit and in its order") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (const Domain<2>& domain : {test::periodic_box(200), test::periodic_box(200, 300), test::periodic_box(64, 40)}) {
    std::uniform_real_distribution<double> x(-domain.period(0), 2 * domain.period(0)), y(0, 300);
    std::vector<std::array<double, 2>> centres;
    for (int cell = 0; cell < (domain.period(0) > 64 ? 120 : 2); ++cell) centres.push_back({x(random), y(random)});
    const Membranes m = circles(centres, 30);
    constexpr double reach = 3;
    const int cells = static_cast<int>(m.cells.size());
    std::vector<CellContact> expected;
    std::vector<double> gaps;
    for (int a = 0; a < cells; ++a) {
      double gap = std::numeric_limits<double>::infinity();
      for (int b = 0; b < cells; ++b) {
        const CellRange &cell = m.cells[a], &other = m.cells[b];
        gap = std::min(gap, smallest_gap(m, a, b, domain, 200));  // no gap is as large
        if (b < a) continue;
        for_each_image(box_of<2>(m, cell), box_of<2>(m, other), reach, domain, [&](ImageShift shift) {
          if (a == b && (shift.y < 0 || (shift.y == 0 && shift.x <= 0))) return;
          const double distance = outline_distance(m, cell, other, shift, domain, reach);
          if (distance < reach)
            expected.push_back({a, b, shift, distance, facing_length(m, cell, other, shift, domain, reach)});
        });
      }
      gaps.push_back(gap);
    }
    const auto contacts = find_touching_cells(m, domain, reach);
    REQUIRE(contacts.size() == expected.size());
    if (domain.period(0) > 64) CHECK(contacts.size() > 25);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const CellContact &c = contacts[k], &e = expected[k];
      CHECK((c.cell_a == e.cell_a && c.cell_b == e.cell_b && c.image == e.image));
      CHECK((c.gap == e.gap && c.contact_length == e.contact_length));
    }
    CHECK(gaps_of(m, domain) == gaps);
  }
  CHECK(gaps_of(circles({}), test::periodic_box(100)).empty());
}

TEST_CASE("between openings gaps are looked for along the whole length, and a lone cell has none") {
  const Domain<2> open({120, 40}, {false, false});
  const Membranes three = circles({{20, 20}, {100, 20}, {110, 31}}, 30);
  const std::vector<double> gaps = gaps_of(three, open);
  CHECK(gaps[0] == smallest_gap(three, 0, 1, open, 200));
  CHECK(gaps[1] == smallest_gap(three, 1, 2, open, 200));
  CHECK(std::isinf(gaps_of(circles({{20, 20}}), open).front()));
  const Domain<3> in_space({60, 20, 20}, {false, false, false});
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(3, {2, 2, 2}))));
  add_cell(s, 0, {10, 10, 10});
  Surroundings<3> alone(s);
  CHECK(std::isinf(smallest_gaps(alone, in_space).front()));
  add_cell(s, 0, {50, 10, 10});
  Surroundings<3> around(s);
  for (const double gap : smallest_gaps(around, in_space)) CHECK(gap == Approx(36).margin(0.2));
}

namespace {

/// Discs, spheres among them, at random places and turns; some touch or overlap.
Surfaces crowd(int count, const Domain<3>& domain, std::mt19937& random) {
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::biconcave_disc(5, 3))));
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(3, {2, 2, 2}))));
  std::uniform_real_distribution<double> any(-0.5, 1.5);
  for (int cell = 0; cell < count; ++cell) {
    const Vec<3> center(any(random) * domain.size[0], any(random) * domain.size[1], any(random) * domain.size[2]);
    add_cell(s, cell % 2, center, Eigen::Quaterniond::UnitRandom().toRotationMatrix());
  }
  return s;
}

}  // namespace

TEST_CASE("smallest gaps of surfaces are those of a search through all contacts within half a period, to the bit") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937 random(seed);
  std::srand(seed);  // of Eigen
  for (const auto& [domain, count] : {std::pair(Domain<3>({40, 36, 44}, {true, true, true}), 14),
                                      std::pair(Domain<3>({30, 60, 24}, {true, false, true}), 5),
                                      std::pair(Domain<3>({14, 13, 12}, {true, true, true}), 1)}) {
    const Surfaces s = crowd(count, domain, random);
    double most = domain.period(0) / 2;
    for (int k = 1; k < 3; ++k) most = domain.periodic[k] ? std::min(most, domain.period(k) / 2) : most;
    std::vector<double> expected(s.cells.size(), std::numeric_limits<double>::infinity());
    const TriangleContacts all = TriangleContacts::within(most, s, domain);
    std::vector<TriangleContact> of_cell;
    for (int cell = 0; cell < count; ++cell) {
      all.find(cell, s, of_cell);
      for (const TriangleContact& contact : of_cell) {
        for (const int both : {cell, contact.other}) expected[both] = std::min(expected[both], contact.distance);
      }
    }
    Surroundings<3> around(s);
    CHECK(smallest_gaps(around, domain) == expected);
  }
}

TEST_CASE("the deepest node inside another surface is found, over a border too, and none where none is") {
  const Domain<3> domain({30, 30, 30}, {true, true, true});
  for (const double depth : {0.7, 1.6, -0.3}) {
    Surfaces s;
    s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(8, {4, 4, 4}))));
    for (const double x : {2.0, 15.0, 24 + depth}) add_cell(s, 0, {x, 10, 10});  // the last and the first, over x
    const auto found = find_crossing(s, domain);
    REQUIRE(found.has_value() == depth > 0);
    if (!found) continue;
    CHECK(found->depth == Approx(depth).epsilon(0.03));
    CHECK(found->cell + found->other == 2);
    CHECK(found->cell != 1);  // which touches neither
    CHECK(s.position[0][found->node] == Approx(found->cell == 0 ? -2 : 28 + depth).epsilon(0.02));
  }
}

TEST_CASE("an aggregate is a connected chain of contacts, labelled by its smallest cell") {
  const auto contact = [](int a, int b) { return CellContact{a, b, {0, 0}, 0.1, 1}; };
  const Aggregates a = find_aggregates(6, {contact(4, 5), contact(3, 4), contact(1, 3)});
  CHECK(a.label == std::vector<int>{0, 1, 2, 1, 1, 1});
  CHECK(a.count == 3);
}

TEST_CASE("an output is due at the steps nearest to multiples of its interval") {
  scene::StageSetting setting{};
  setting.shear_rate = 0.003;
  setting.units = {1e-7, 1e-5, 1};
  setting.max_steps = 100000;
  const scene::OutputSchedule schedule({0.25, std::nullopt}, setting, true);
  long count = 0;
  for (long step = 0; step <= 8333; ++step) count += schedule.due(step) ? 1 : 0;
  CHECK(count == 101);  // strain 0 to 25 in steps of a quarter
  CHECK(schedule.due(83));
  CHECK_FALSE(schedule.due(84));
  CHECK(schedule.due(167));
  const scene::OutputSchedule never({}, setting, true);
  CHECK_FALSE(never.due(0));
}

TEST_CASE("a stage at rest writes forty rows where only a strain is asked for") {
  scene::StageSetting setting{};
  setting.units = {1e-7, 1e-5, 1};
  setting.max_steps = 4000;
  const scene::OutputSchedule schedule({0.25, std::nullopt}, setting, true);
  long count = 0;
  for (long step = 0; step <= 4000; ++step) count += schedule.due(step) ? 1 : 0;
  CHECK(count == 41);
}
