// Closest points: the lists against brute force while cells move.
#include "core/contact/segment_contacts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <tuple>

#include "core/membrane/geometry.hpp"
#include "unit/cell_fixture.hpp"
#include "unit/contact/contact_list.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

constexpr double cutoff = 18;

void run(SegmentContacts& contacts, const Membranes& m, int workers = 1) {
  run_pass(workers, [&](Worker worker) { contacts.measure(worker, m); });
  run_pass(workers, [&](Worker worker) { contacts.refresh(worker, m); });
}

/// The rectangle around an outline: what is farther from it than the cutoff is farther from the outline.
struct Rectangle {
  double x_min, x_max, y_min, y_max;
  Rectangle(const Membranes& m, const CellRange& cell) {
    const auto [left, right] =
        std::minmax_element(m.position[0].begin() + cell.first, m.position[0].begin() + cell.end());
    const auto [low, high] =
        std::minmax_element(m.position[1].begin() + cell.first, m.position[1].begin() + cell.end());
    x_min = *left, x_max = *right, y_min = *low, y_max = *high;
  }
  [[nodiscard]] double distance(double x, double y) const {
    return std::hypot(std::max({x_min - x, 0.0, x - x_max}), std::max({y_min - y, 0.0, y - y_max}));
  }
};

/// Smallest distance of a node to an outline moved by (dx, dy).
double brute_distance(const Membranes& m, int node, const CellRange& other, double dx, double dy) {
  const double px = m.position[0][static_cast<std::size_t>(node)] - dx,
               py = m.position[1][static_cast<std::size_t>(node)] - dy;
  double best = 1e300;
  for (int j = other.first; j < other.end(); ++j) {
    const auto a = static_cast<std::size_t>(j), b = static_cast<std::size_t>(other.next(j));
    const double ux = m.position[0][b] - m.position[0][a], uy = m.position[1][b] - m.position[1][a],
                 wx = px - m.position[0][a], wy = py - m.position[1][a];
    const double square = ux * ux + uy * uy;
    const double s = square > 0 ? std::min(1.0, std::max(0.0, (wx * ux + wy * uy) / square)) : 0.0;
    best = std::min(best, std::hypot(wx - s * ux, wy - s * uy));
  }
  return best;
}

struct Tally {
  long contacts = 0, missing = 0, wrong = 0, extra = 0;
};

/// Every node against every cell and every image near enough.
void compare(const SegmentContacts& contacts, const Membranes& m, const core::Domain<2>& domain, Tally& tally) {
  for (int c = 0; c < static_cast<int>(m.cells.size()); ++c) {
    const CellRange& cell = m.cells[static_cast<std::size_t>(c)];
    const ContactList list = contact_list(contacts, m, c);
    const auto& pairs = contacts.neighbours().list(c).pairs;
    std::map<std::tuple<int, int, int, int>, double> found;  // node, other, shift
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      for (int i = list.ranges[p].begin; i < list.ranges[p].end; ++i) {
        const auto k = static_cast<std::size_t>(i);
        found[{list.node[k], pairs[p].other, pairs[p].shift.x, pairs[p].shift.y}] = list.distance[k];
      }
    }
    tally.contacts += static_cast<long>(found.size());
    const int far_y = domain.periodic[1] ? 3 : 0;
    long expected = 0;
    for (int b = 0; b < static_cast<int>(m.cells.size()); ++b) {
      const CellRange& other = m.cells[static_cast<std::size_t>(b)];
      const Rectangle around(m, other);
      for (int sx = -3; sx <= 3; ++sx) {
        for (int sy = -far_y; sy <= far_y; ++sy) {
          if (b == c && sx == 0 && sy == 0) continue;
          const double dx = sx * domain.period(0), dy = sy * domain.period(1);
          for (int i = cell.first; i < cell.end(); ++i) {
            const auto node = static_cast<std::size_t>(i);
            if (around.distance(m.position[0][node] - dx, m.position[1][node] - dy) > cutoff + 1e-9) continue;
            const double d = brute_distance(m, i, other, dx, dy);
            if (d > cutoff) continue;
            ++expected;
            const auto at = found.find({i, b, sx, sy});
            if (at == found.end()) {
              tally.missing += d < cutoff - 1e-9 ? 1 : 0;
            } else if (std::abs(at->second - std::max(d, least_distance)) > 1e-11) {
              ++tally.wrong;
            }
          }
        }
      }
    }
    tally.extra += static_cast<long>(found.size()) > expected + 2 ? 1 : 0;
  }
}

}  // namespace

TEST_CASE("closest points are those of brute force on moving, turning, deforming and overlapping cells") {
  const core::Domain<2> domain = GENERATE(periodic_box(90), periodic_box(90, 70), periodic_box(45));
  // Lists are made for the speed of the nodes where that is known, and for any speed where it is not.
  const bool known = GENERATE(false, true);
  const double speed = known ? GENERATE(0.02, 0.2) : 1.0;
  auto random = generator(61);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Tally tally;
  long renewals = 0;
  for (int scene = 0; scene < 6; ++scene) {
    std::vector<Placed> places;
    for (int k = 0; k < 5; ++k) places.push_back({60 * uniform(random), 30 * uniform(random), 3 * uniform(random)});
    Membranes m = biconcave_cells(places, 97 + scene);
    deform(m, random, 4, 0.2);
    Cutoffs cutoffs(1);
    cutoffs.raise(0, 0, cutoff);
    if (known) m.largest_step.assign(m.cells.size(), 0.001 * speed);
    SegmentContacts contacts(m, cutoffs, domain);
    for (int step = 0; step < 12; ++step) {
      run(contacts, m, 1 + step % 3);
      compare(contacts, m, domain, tally);
      // Move by up to the skin since the lists were made, by rigid motion and by single nodes.
      const auto old_x = m.position[0], old_y = m.position[1];
      for (const CellRange& cell : m.cells) {
        const double vx = speed * 0.06 * uniform(random), vy = speed * 0.06 * uniform(random),
                     turn = speed * 0.003 * uniform(random);
        const Eigen::Vector2d center = centroid(m, cell);
        for (int i = cell.first; i < cell.end(); ++i) {
          const auto k = static_cast<std::size_t>(i);
          const double rx = m.position[0][k] - center.x(), ry = m.position[1][k] - center.y();
          m.position[0][k] += vx - turn * ry + speed * 0.02 * uniform(random);
          m.position[1][k] += vy + turn * rx + speed * 0.02 * uniform(random);
        }
      }
      if (known)
        m.largest_step.assign(m.cells.size(),
                              largest_displacement(m, {old_x.data(), old_y.data(), nullptr}, {0, m.node_count()}));
    }
    renewals += contacts.neighbours().renewals();
  }
  std::cout << tally.contacts << " contacts, " << renewals << " lists made in 72 steps\n";
  CHECK(tally.contacts > 20000);
  CHECK(tally.missing == 0);
  CHECK(tally.wrong == 0);
  CHECK(tally.extra == 0);
  CHECK(renewals < 60);
}

TEST_CASE("a node that is nowhere makes no contact and spoils no other, over periodic borders too") {
  for (const std::size_t broken : {0u, 1u, 2u}) {
    Membranes m = biconcave_cells({{10, 10, 0}, {14, 28, 0}, {60, 40, 1}});
    const auto node = static_cast<std::size_t>(m.cells[broken].first + 3);
    m.position[0][node] = std::nan("");
    m.largest_step.assign(3, 0.001);
    m.largest_step[broken] = std::nan("");
    Cutoffs cutoffs(1);
    cutoffs.raise(0, 0, cutoff);
    SegmentContacts contacts(m, cutoffs, periodic_box(90, 70));
    run(contacts, m);
    for (int c = 0; c < 3; ++c) {
      const ContactList list = contact_list(contacts, m, c);
      for (std::size_t k = 0; k < static_cast<std::size_t>(list.count); ++k) {
        REQUIRE(list.distance[k] <= cutoff);
        for (const int i : {list.node[k], list.segment[k]}) REQUIRE(static_cast<std::size_t>(i) != node);
      }
    }
    CHECK(contact_list(contacts, m, 0).count > 0);
  }
}

TEST_CASE("bins find every cell and image within reach, in boxes of any size, over periodic borders") {
  auto random = generator(64);
  std::uniform_real_distribution<double> uniform(0, 1);
  long found = 0, pairs = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const auto length = [&](int most) { return 30 + static_cast<int>(most * uniform(random)); };
    const core::Domain<2> domain = trial % 2 == 0 ? periodic_box(length(400)) : periodic_box(length(400), length(300));
    const double reach = 1 + 20 * uniform(random), largest = 5 + 50 * uniform(random);
    std::vector<BoundingBox<2>> boxes;
    for (int c = 0; c < 60; ++c) {
      const double x = (3 * uniform(random) - 1) * domain.period(0), y = (3 * uniform(random) - 1) * 200;
      boxes.push_back({{x, y}, {x + largest * uniform(random), y + largest * uniform(random)}});
    }
    boxes[17].least[0] = std::nan("");
    const CellGrid<2> grid(boxes, reach, domain);
    std::vector<int> near;
    for (int a = 0; a < 60; ++a) {
      grid.find(a, near);
      std::sort(near.begin(), near.end());
      REQUIRE(std::adjacent_find(near.begin(), near.end()) == near.end());
      found += static_cast<long>(near.size());
      for (int b = 0; b < 60; ++b) {
        bool images = false;
        for_each_image(boxes[a], boxes[b], reach, domain, [&](ImageShift) { images = true; });
        if (images) REQUIRE(std::binary_search(near.begin(), near.end(), b));
        pairs += images ? 1 : 0;
      }
    }
  }
  CHECK(pairs > 20000);
  CHECK(found < 200 * 60 * 60 / 2);
}

TEST_CASE("a remembered direction and place belong to the distance") {
  auto random = generator(62);
  Membranes m = biconcave_cells({{0, 0, 0.1}, {3, 17, 0}});
  deform(m, random, 2, 0.1);
  Cutoffs cutoffs(1);
  cutoffs.raise(0, 0, cutoff);
  SegmentContacts contacts(m, cutoffs, periodic_box(10000));
  run(contacts, m);
  for (int c = 0; c < 2; ++c) {
    const ContactList list = contact_list(contacts, m, c);
    REQUIRE(list.count > 50);
    for (int i = 0; i < list.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const auto a = static_cast<std::size_t>(list.segment[k]),
                 b = static_cast<std::size_t>(m.cells[static_cast<std::size_t>(1 - c)].next(list.segment[k]));
      const double px = (1 - list.along[k]) * m.position[0][a] + list.along[k] * m.position[0][b];
      const double py = (1 - list.along[k]) * m.position[1][a] + list.along[k] * m.position[1][b];
      const auto n = static_cast<std::size_t>(list.node[k]);
      REQUIRE(m.position[0][n] - px == Approx(list.distance[k] * list.direction_x[k]).margin(1e-12));
      REQUIRE(m.position[1][n] - py == Approx(list.distance[k] * list.direction_y[k]).margin(1e-12));
      REQUIRE(std::hypot(list.direction_x[k], list.direction_y[k]) == Approx(1).epsilon(1e-14));
    }
  }
}

TEST_CASE("every image is visited from both cells") {
  auto random = generator(63);
  std::uniform_real_distribution<double> uniform(-300, 300);
  long visits = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double ax = uniform(random), ay = uniform(random), bx = uniform(random), by = uniform(random);
    const BoundingBox<2> a{{ax, ay}, {ax + 40, ay + 13}}, b{{bx, by}, {bx + 13, by + 40}};
    // Boxes that touch exactly, too: the reach is a difference of coordinates.
    const double reach = trial % 2 == 0 ? 19 : std::abs(b.least[0] - a.most[0]);
    const core::Domain<2> domain = periodic_box(60 + trial % 7, trial % 3 == 0 ? 0 : 77);
    std::vector<ImageShift> there, back;
    for_each_image(a, b, reach, domain, [&](ImageShift shift) { there.push_back(shift); });
    for_each_image(b, a, reach, domain, [&](ImageShift shift) { back.push_back(-shift); });
    REQUIRE(there.size() == back.size());
    REQUIRE(std::is_permutation(there.begin(), there.end(), back.begin()));
    visits += static_cast<long>(there.size());
  }
  CHECK(visits > 10000);
}
