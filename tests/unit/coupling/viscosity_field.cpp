// Fraction of lattice nodes by cells, the relaxation rate made from it, and the marks of active nodes.
#include "core/coupling/viscosity_field.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "core/coupling/cell_fraction.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/membrane/geometry.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

Membranes polygon(const std::vector<std::pair<double, double>>& nodes) {
  Membranes m;
  for (const auto& [x, y] : nodes) m.position[0].push_back(x), m.position[1].push_back(y);
  m.cells.push_back({{0, m.node_count()}, 0, 0, 0});
  for (auto* values : {&m.force[0], &m.force[1], &m.velocity[0], &m.velocity[1]})
    values->assign(m.position[0].size(), 0.0);
  return m;
}

double value_at(const CellFraction<2>& fraction, int x, int y) {
  const int i = x - fraction.first[0], j = y - fraction.first[1];
  if (i < 0 || j < 0 || i >= fraction.size[0] || j >= fraction.size[1]) return 0;
  return fraction.row(j)[i];
}
double total(const CellFraction<2>& fraction) {
  double sum = 0;
  for (int j = 0; j < fraction.size[1]; ++j) {
    for (int i = 0; i < fraction.size[0]; ++i) sum += fraction.row(j)[i];
  }
  return sum;
}

/// Length of [a, b] within the unit interval around n.
double overlap(double a, double b, int n) { return std::max(0.0, std::min(b, n + 0.5) - std::max(a, n - 0.5)); }

/// Area of a polygon within the unit square around (x, y), by clipping (Sutherland and Hodgman, Commun. ACM 17, 1974).
double clipped_area(std::vector<Eigen::Vector2d> p, int x, int y) {
  const Eigen::Vector2d corner(x - 0.5, y - 0.5);
  for (int side = 0; side < 4; ++side) {
    const auto inside = [&](const Eigen::Vector2d& q) {
      const double d = side % 2 == 0 ? q.x() - corner.x() : q.y() - corner.y();
      return side < 2 ? d : 1 - d;
    };
    std::vector<Eigen::Vector2d> kept;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Eigen::Vector2d &a = p[i], &b = p[(i + 1) % p.size()];
      const double da = inside(a), db = inside(b);
      if (da >= 0) kept.push_back(a);
      if ((da >= 0) != (db >= 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    p = kept;
  }
  double area = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Eigen::Vector2d a = p[i] - corner, b = p[(i + 1) % p.size()] - corner;
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return area;
}

template <class T>
Field<T, 2> plain_rate(int nx, int ny, double rate) {
  Field<T, 2> field({nx, ny});
  field.fill(static_cast<T>(rate));
  return field;
}

template <class T>
void update(ViscosityField<T, 2>& viscosity_field, const Membranes& m, Field<T, 2>& rate, NodeMask& mask) {
  viscosity_field.measure({}, m);
  REQUIRE(viscosity_field.due());
  viscosity_field.cover({}, m);
  viscosity_field.update({}, m, rate, mask);
  viscosity_field.measure({}, m);
  REQUIRE_FALSE(viscosity_field.due());
}

}  // namespace

TEST_CASE("the fraction of a rectangle is exact, on and off the lattice's edges") {
  const double x0 = GENERATE(3.0, 3.5, 3.2, -7.9), y0 = GENERATE(4.0, 4.5, 4.8, -2.1);
  const double x1 = x0 + GENERATE(0.3, 1.0, 5.4), y1 = y0 + GENERATE(0.2, 1.0, 3.7);
  const Membranes m = polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
  CellFraction<2> fraction;
  cover(m, 0, fraction);
  for (int y = -5; y < 15; ++y) {
    for (int x = -10; x < 15; ++x) {
      REQUIRE(value_at(fraction, x, y) == Approx(overlap(x0, x1, x) * overlap(y0, y1, y)).margin(1e-14));
    }
  }
}

TEST_CASE("the fraction of triangles is that of clipping them to every node's square") {
  auto random = generator(81);
  std::uniform_real_distribution<double> uniform(-10, 10);
  double worst = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Eigen::Vector2d> p;
    for (int k = 0; k < 3; ++k)
      p.emplace_back(uniform(random), trial % 5 == 0 ? std::round(uniform(random)) + 0.5 : uniform(random));
    const double turn = (p[1] - p[0]).x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x();
    if (turn < 0) std::swap(p[1], p[2]);
    const Membranes m = polygon({{p[0].x(), p[0].y()}, {p[1].x(), p[1].y()}, {p[2].x(), p[2].y()}});
    CellFraction<2> fraction;
    cover(m, 0, fraction);
    for (int y = -12; y <= 12; ++y) {
      for (int x = -12; x <= 12; ++x)
        worst = std::max(worst, std::abs(value_at(fraction, x, y) - clipped_area(p, x, y)));
    }
  }
  CHECK(worst < 1e-12);
}

TEST_CASE("the fraction adds up to the enclosed area, before and after smoothing") {
  auto random = generator(82);
  Membranes m = biconcave_cells({{30.3, 20.1, 0.3}, {-1000.7, 400.2, 1.2}, {3, 4, 2.2}});
  deform(m, random, 4, 0.2);
  std::vector<double> scratch;
  for (int c = 0; c < m.cell_count(); ++c) {
    CellFraction<2> fraction;
    cover(m, c, fraction);
    const double area = enclosed_area(m, m.cells[c]);
    CHECK(std::abs(total(fraction) - area) < 1e-12 * area);
    smooth(fraction, scratch);
    CHECK(std::abs(total(fraction) - area) < 1e-12 * area);
    for (int j = 0; j < fraction.size[1]; ++j) {
      for (int i = 0; i < fraction.size[0]; ++i) {
        const auto at = static_cast<std::size_t>(j);
        if (i < fraction.begin[at] || i >= fraction.end[at]) REQUIRE(fraction.row(j)[i] == 0);
      }
    }
  }
}

TEST_CASE("the relaxation rate follows the arithmetic mean of the viscosities, over periodic borders") {
  auto random = generator(83);
  const int nx = 80, ny = 64;
  const bool periodic_y = GENERATE(false, true);
  Membranes m = biconcave_cells({{-170.4, 20.1, 0.3}, {30.2, periodic_y ? 60.0 : 40.0, 1.2}, {32.1, 25.0, -0.2}});
  deform(m, random, 2, 0.1);
  m.cells[1].type = 1;
  const double tau = 0.8;
  ViscosityField<double, 2> viscosity_field(m, {5.0, 2.0}, ViscosityMean::arithmetic, 0, 1 / tau,
                                            {{nx, ny}, {true, periodic_y}});
  auto rate = plain_rate<double>(nx, ny, 1 / tau);
  NodeMask mask(core::Domain<2>({nx, ny}, {true, false}));
  for (int round = 0; round < 3; ++round) {
    update(viscosity_field, m, rate, mask);
    // Smoothed sum over cells, wrapped, node by node.
    std::vector<double> excess(static_cast<std::size_t>(nx) * ny, 0.0), scratch;
    for (int c = 0; c < m.cell_count(); ++c) {
      CellFraction<2> fraction;
      cover(m, c, fraction);
      smooth(fraction, scratch);
      for (int j = 0; j < fraction.size[1]; ++j) {
        for (int i = 0; i < fraction.size[0]; ++i) {
          const int x = ((fraction.first[0] + i) % nx + nx) % nx;
          int y = fraction.first[1] + j;
          if (periodic_y) y = (y % ny + ny) % ny;
          if (y < 0 || y >= ny) continue;
          excess[static_cast<std::size_t>(y * nx + x)] += (m.cells[c].type == 0 ? 4.0 : 1.0) * fraction.row(j)[i];
        }
      }
    }
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        const double expected = 1 / (0.5 + 0.3 * (1 + excess[static_cast<std::size_t>(y * nx + x)]));
        REQUIRE(rate.row(y)[x] == Approx(expected).epsilon(1e-13));
        if (rate.row(y)[x] != 1 / tau) REQUIRE(mask.active(x, y));
      }
    }
    for (std::size_t i = 0; i < m.position[0].size(); ++i)
      m.position[0][i] += 13.7, m.position[1][i] += periodic_y ? 20.3 : -0.3;
  }
}

TEST_CASE("in layers the inside of a cell keeps its viscosity, and what it leaves gets that of the layer again") {
  const int nx = 80, ny = 64;
  const double tau = 0.8;
  const auto mean = GENERATE(ViscosityMean::arithmetic, ViscosityMean::harmonic);
  const std::vector<double> rows = viscosity_of_rows({{0, 20.25, 3}}, ny);
  const auto rate_of = [&](double viscosity) { return 1 / (0.5 + 0.3 * viscosity); };
  Membranes m = biconcave_cells({{30.4, 19.1, 0.3}, {55.2, 40, 1.2}});
  m.cells[1].type = 1;
  const core::Domain<2> domain{{nx, ny}, {true, false}};
  ViscosityField<double, 2> viscosity_field(m, {5.0, 1.0}, mean, 0, 1 / tau, domain, rows);
  CHECK(viscosity_field.varies());
  Field<double, 2> rate({nx, ny});
  for (int y = 0; y < ny; ++y) std::fill_n(rate.row(y), nx, rate_of(rows[y]));
  const auto is = [&](int x, int y, double viscosity) {
    return rate.row(y)[x] == Approx(rate_of(viscosity)).epsilon(1e-14);
  };
  NodeMask mask(domain);
  update(viscosity_field, m, rate, mask);
  // The first cell lies across the border of the layer; the second is of the fluid above.
  CHECK(is(24, 17, 5));
  CHECK(is(37, 23, 5));
  CHECK(is(55, 40, 1));
  CHECK(is(55, 10, 3));
  CHECK(is(70, 20, 1 / (0.25 / 3 + 0.75)));
  const CellRange& second = m.cells[1];
  for (int i = second.first; i < second.end(); ++i) m.position[1][i] -= 30;
  update(viscosity_field, m, rate, mask);
  CHECK(is(58, 16, 1));
  for (double& y : m.position[1]) y += 40;
  update(viscosity_field, m, rate, mask);
  long different = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < nx; ++x) different += is(x, y, rows[y]) ? 0 : 1;
  }
  CHECK(different == 0);
}

TEST_CASE("every node that a membrane can reach before the next update is marked") {
  auto random = generator(84);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int nx = 160, ny = 64;
  const double ratio = GENERATE(1.0, 5.0);
  Membranes m = biconcave_cells({{-170.4, 20.1, 0.3}, {30.2, 40, 1.2}});
  deform(m, random, 2, 0.1);
  ViscosityField<float, 2> viscosity_field(m, {ratio}, ViscosityMean::arithmetic, 0, 1.0, {{nx, ny}, {true, false}});
  CHECK(viscosity_field.varies() == (ratio != 1));
  auto rate = plain_rate<float>(nx, ny, 1.0);
  NodeMask mask(core::Domain<2>({nx, ny}, {true, false}));
  update(viscosity_field, m, rate, mask);
  int active = 0;
  for (int i = 0; i < nx * ny; ++i) active += mask.active(i % nx, i / nx) ? 1 : 0;
  CHECK(active < 0.6 * nx * ny);
  CHECK(active > 0.1 * nx * ny);
  for (int trial = 0; trial < 20; ++trial) {
    for (std::size_t i = 0; i < m.position[0].size(); ++i) {
      const int x = static_cast<int>(std::floor(m.position[0][i] + 0.99 * uniform(random)));
      const int y = static_cast<int>(std::floor(m.position[1][i] + 0.99 * uniform(random)));
      for (int dy = -1; dy <= 2; ++dy) {
        for (int dx = -1; dx <= 2; ++dx) {
          if (y + dy < 0 || y + dy >= ny) continue;
          REQUIRE(mask.active(((x + dx) % nx + nx) % nx, y + dy));
        }
      }
    }
  }
}

TEST_CASE("an update is due once a node has moved by a tenth of a spacing, and for positions that are not numbers") {
  Membranes m = biconcave_cells({{30, 20, 0}, {30, 40, 0}});
  ViscosityField<double, 2> viscosity_field(m, {5.0}, ViscosityMean::arithmetic, 0, 1.0, {{80, 64}, {true, false}});
  auto rate = plain_rate<double>(80, 64, 1.0);
  NodeMask mask(core::Domain<2>({80, 64}, {true, false}));
  update(viscosity_field, m, rate, mask);
  m.position[0][150] += 0.099;
  viscosity_field.measure({}, m);
  CHECK_FALSE(viscosity_field.due());
  m.position[1][150] += 0.03;
  run_pass(2, [&](Worker worker) { viscosity_field.measure(worker, m); });
  CHECK(viscosity_field.due());
  const auto update_by_two = [&] {
    run_pass(2, [&](Worker worker) { viscosity_field.cover(worker, m); });
    run_pass(2, [&](Worker worker) { viscosity_field.update(worker, m, rate, mask); });
  };
  update_by_two();
  m.position[0][3] = std::nan("");
  m.position[1][160] = 1e300;
  viscosity_field.measure({}, m);
  CHECK(viscosity_field.due());
  update_by_two();
}

TEST_CASE("where no cell is any more, the plain rate is back to the last bit") {
  Membranes m = biconcave_cells({{30, 20, 0}});
  ViscosityField<float, 2> viscosity_field(m, {5.0}, ViscosityMean::arithmetic, 0, 1 / 0.7, {{160, 64}, {true, false}});
  auto rate = plain_rate<float>(160, 64, 1 / 0.7);
  NodeMask mask(core::Domain<2>({160, 64}, {true, false}));
  update(viscosity_field, m, rate, mask);
  CHECK(rate.row(20)[30] != static_cast<float>(1 / 0.7));
  for (double& x : m.position[0]) x += 80;
  update(viscosity_field, m, rate, mask);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 80; ++x) REQUIRE(rate.row(y)[x] == static_cast<float>(1 / 0.7));
  }
  CHECK_FALSE(mask.active(16, 20));
}

TEST_CASE("an update after some cells have moved gives what all cells anew would give, to the last bit") {
  auto random = generator(85);
  const int nx = 80, ny = 64;
  const bool periodic_y = GENERATE(false, true);
  Membranes m = biconcave_cells({{-170.4, 20.1, 0.3}, {30.2, 40, 1.2}, {32.1, 25.0, -0.2}, {60.0, 33.0, 0.9}});
  deform(m, random, 2, 0.1);
  ViscosityField<double, 2> kept(m, {5.0}, ViscosityMean::arithmetic, 0, 1.25, {{nx, ny}, {true, periodic_y}});
  auto rate = plain_rate<double>(nx, ny, 1.25);
  NodeMask mask(core::Domain<2>({nx, ny}, {true, false}));
  update(kept, m, rate, mask);
  for (int round = 0; round < 6; ++round) {
    const CellRange& cell = m.cells[static_cast<std::size_t>(round % 4)];
    for (int i = cell.first; i < cell.end(); ++i) {
      m.position[0][static_cast<std::size_t>(i)] += 3.3 * round;
      m.position[1][static_cast<std::size_t>(i)] -= 0.4;
    }
    update(kept, m, rate, mask);
    ViscosityField<double, 2> fresh(m, {5.0}, ViscosityMean::arithmetic, 0, 1.25, {{nx, ny}, {true, periodic_y}});
    auto fresh_rate = plain_rate<double>(nx, ny, 1.25);
    NodeMask fresh_activity(core::Domain<2>({nx, ny}, {true, false}));
    update(fresh, m, fresh_rate, fresh_activity);
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        REQUIRE(rate.row(y)[x] == fresh_rate.row(y)[x]);
        REQUIRE(mask.active(x, y) == fresh_activity.active(x, y));
      }
    }
  }
}
