// Which part of a node's cube lies inside a surface, and the viscosity and the marks that follow from it.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>

#include "core/coupling/viscosity_field.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/fluid/relaxation.hpp"
#include "core/surface/triangle_surface.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;

namespace {

Surfaces ellipsoid_at(const Vec<3>& center, int n = 16) {
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(n, {6, 5, 3}))));
  add_cell(s, 0, center, Eigen::AngleAxisd(0.7, Vec<3>(1, 2, 3).normalized()).toRotationMatrix());
  return s;
}

double sum(const CellFraction<3>& fraction) {
  return std::accumulate(fraction.value.begin(), fraction.value.end(), 0.0);
}

constexpr std::array<int, 3> box = {24, 22, 20};

struct Rates {
  Field<double, 3> rate{box};
  NodeMask mask;
};

Rates updated(const Surfaces& s, double ratio, double plain, const Domain<3>& domain, int workers) {
  Rates rates{.mask = NodeMask(domain)};
  rates.rate.fill(plain);
  ViscosityField<double, 3> field(s, {ratio}, ViscosityMean::arithmetic, 0, plain, domain);
  for (int w = 0; w < workers; ++w) field.measure({w, workers}, s);
  for (int w = 0; w < workers; ++w) field.cover({w, workers}, s);
  REQUIRE(field.due());
  for (int w = 0; w < workers; ++w) field.update({w, workers}, s, rates.rate, rates.mask);
  return rates;
}

}  // namespace

TEST_CASE("the fraction inside is 1 or 0 away from a surface, and its sum is the volume, to second order") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  for (int trial = 0; trial < 5; ++trial) {
    const Surfaces s = ellipsoid_at({10 + place(random), 11 + place(random), -4 + place(random)});
    const double volume = enclosed_volume(s.type_of(0).mesh, s.nodes(0));
    CellFraction<3> fraction;
    cover(s, 0, fraction);
    CHECK(sum(fraction) == Approx(volume).epsilon(4e-3));
    for (int k = 0; k < fraction.size[2]; ++k) {
      for (int j = 0; j < fraction.size[1]; ++j) {
        for (int i = 0; i < fraction.size[0]; ++i) {
          const double value = fraction.row(k * fraction.size[1] + j)[i];
          CHECK(value >= -1e-12);
          CHECK(value <= 1 + 1e-12);
          const Vec<3> node(fraction.first[0] + i, fraction.first[1] + j, fraction.first[2] + k);
          const bool whole = value > 1 - 1e-9, none = value < 1e-9;
          if (whole || none) CHECK(encloses(s.type_of(0).mesh, s.nodes(0), node) == whole);
        }
      }
    }
    std::vector<double> scratch;
    const CellFraction<3> sharp = fraction;
    smooth(fraction, scratch);
    CHECK(sum(fraction) == Approx(sum(sharp)).epsilon(1e-12));
    Surfaces twice = s;
    for (auto& places : twice.position) {
      for (double& place_along : places) place_along *= 2;
    }
    cover(twice, 0, fraction);
    CHECK(sum(fraction) == Approx(8 * volume).epsilon(1e-3));
  }
}

TEST_CASE("a surface whose edges and nodes lie on lines through the lattice is covered all the same") {
  // An octahedron that is centred on a line: every line through a node or an edge counts once.
  Surfaces s;
  const auto octahedron = [] {
    core::TriangleSurface made;
    made.nodes = {{4, 0, 0}, {-4, 0, 0}, {0, 4, 0}, {0, -4, 0}, {0, 0, 4}, {0, 0, -4}};
    made.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return core::rest_surface(made);
  };
  s.types.push_back(std::make_shared<const RestSurface>(octahedron()));
  add_cell(s, 0, {0, 0.25, 0.25});
  CellFraction<3> fraction;
  cover(s, 0, fraction);
  CHECK(sum(fraction) == Approx(4.0 / 3 * 64).epsilon(0.02));
  CHECK(*std::max_element(fraction.value.begin(), fraction.value.end()) == Approx(1));
  CHECK(*std::min_element(fraction.value.begin(), fraction.value.end()) == 0);
}

TEST_CASE("inside a surface the relaxation rate is that of its viscosity, across periodic borders, for any workers") {
  const Domain<3> domain{box, {true, false, true}};
  const double plain = 1 / 0.9, ratio = 5;
  const Surfaces s = ellipsoid_at({1.3, 11, 19.2});
  const Rates rates = updated(s, ratio, plain, domain, 1), shared = updated(s, ratio, plain, domain, 3);
  const double inside = 1 / relaxation_time_of(ratio * viscosity_of(0.9));
  double excess = 0;
  int marked = 0;
  for (int z = 0; z < box[2]; ++z) {
    for (int y = 0; y < box[1]; ++y) {
      for (int x = 0; x < box[0]; ++x) {
        const double rate = rates.rate.row(y, z)[x];
        REQUIRE(shared.rate.row(y, z)[x] == rate);
        REQUIRE(shared.mask.active(x, y + box[1] * z) == rates.mask.active(x, y + box[1] * z));
        excess += (viscosity_of(1 / rate) / viscosity_of(0.9) - 1) / (ratio - 1);
        if (rate != plain) REQUIRE(rates.mask.active(x, y + box[1] * z));
        marked += rates.mask.active(x, y + box[1] * z) ? 1 : 0;
      }
    }
  }
  CHECK(rates.rate.row(11, 19)[1] == Approx(inside));
  CHECK(rates.rate.row(11, 9)[12] == plain);
  CHECK(excess == Approx(enclosed_volume(s.type_of(0).mesh, s.nodes(0))).epsilon(4e-3));
  CHECK(marked < box[0] * box[1] * box[2] / 2);
  // Every node of the stencil of every node of the surface is marked.
  for (int i = 0; i < s.node_count(); ++i) {
    for (int k = 0; k < 64; ++k) {
      const int x = domain.wrapped(0, static_cast<int>(std::floor(s.position[0][i])) - 1 + k % 4),
                y = static_cast<int>(std::floor(s.position[1][i])) - 1 + k / 4 % 4,
                z = domain.wrapped(2, static_cast<int>(std::floor(s.position[2][i])) - 1 + k / 16);
      REQUIRE(rates.mask.active(x, y + box[1] * z));
    }
  }
}

TEST_CASE("in layers the inside of a surface keeps its viscosity, and what it leaves gets that of the layer again") {
  const Domain<3> domain{box, {true, false, true}};
  const double tau = 0.8;
  const std::vector<double> rows = viscosity_of_rows({{0, 10.25, 3}}, box[1]);
  const auto rate_of = [&](double viscosity) { return 1 / (0.5 + 0.3 * viscosity); };
  const double ratio = GENERATE(5.0, 1.0, 3.0);  // that of no fluid around it, and of either
  CAPTURE(ratio);
  Surfaces s = ellipsoid_at({12, 10, 10});
  Rates rates{.mask = NodeMask(domain)};
  for (int z = 0; z < box[2]; ++z) {
    for (int y = 0; y < box[1]; ++y) std::fill_n(rates.rate.row(y, z), box[0], rate_of_layer(1 / tau, rows[y]));
  }
  ViscosityField<double, 3> field(s, {ratio}, ViscosityMean::arithmetic, 0, 1 / tau, domain, rows);
  CHECK(field.varies());
  const auto update = [&] {
    field.measure({}, s);
    field.cover({}, s);
    REQUIRE(field.due());
    field.update({}, s, rates.rate, rates.mask);
  };
  const auto is = [&](int x, int y, int z, double viscosity) {
    return rates.rate.row(y, z)[x] == Approx(rate_of(viscosity)).epsilon(1e-14);
  };
  update();
  CHECK(is(12, 9, 10, ratio));
  CHECK(is(12, 11, 10, ratio));
  CHECK(is(12, 2, 10, 3));
  CHECK(is(12, 19, 10, 1));
  CHECK(is(2, 10, 0, rows[10]));  // the row that the border cuts
  for (double& z : s.position[2]) z += 10;
  update();
  CHECK(is(12, 9, 0, ratio));
  CHECK(is(12, 12, 0, ratio));
  for (int y = 0; y < box[1]; ++y) REQUIRE(rates.rate.row(y, 10)[12] == rate_of_layer(1 / tau, rows[y]));
}

TEST_CASE("where a surface has been the fluid is the plain one again") {
  const Domain<3> domain{box, {true, true, true}};
  Surfaces s = ellipsoid_at({12, 11, 10}, 8);
  Rates rates{.mask = NodeMask(domain)};
  rates.rate.fill(0.8);
  ViscosityField<double, 3> field(s, {3.0}, ViscosityMean::arithmetic, 0, 0.8, domain);
  const auto update = [&] {
    field.measure({}, s);
    field.cover({}, s);
    REQUIRE(field.due());
    field.update({}, s, rates.rate, rates.mask);
  };
  update();
  REQUIRE(rates.rate.row(11, 10)[12] < 0.8);
  for (double& z : s.position[2]) z += 10;
  update();
  CHECK(rates.rate.row(11, 10)[12] == 0.8);
  CHECK_FALSE(rates.mask.active(12, 11 + box[1] * 10));
  CHECK(rates.rate.row(11, 0)[12] < 0.8);
  const Rates fresh = updated(s, 3, 0.8, domain, 1);
  for (int z = 0; z < box[2]; ++z) {
    for (int y = 0; y < box[1]; ++y) {
      for (int x = 0; x < box[0]; ++x) REQUIRE(rates.rate.row(y, z)[x] == fresh.rate.row(y, z)[x]);
    }
  }
}
