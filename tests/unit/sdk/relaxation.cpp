// What a collision operator promises of each moment: rates, equilibria, symmetry, and which operators are the same.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "nodes.hpp"
#include "operators.hpp"

namespace {

using namespace rouleau::test;
namespace d2q9 = rouleau::d2q9;
using Populations = std::array<double, 9>;

constexpr std::size_t node_count = 61;
constexpr double rate = 1.25;
// Populations are about 0.01; the longest formula adds about sixty such terms, each rounded once.
constexpr double rounding = 64 * 0.02 * 2.3e-16;

/// Equilibrium and half of the source, written down for populations, and n = f - f_eq + S/2, which relaxes.
struct Parts {
  Populations equilibrium, half_source, relaxing;
  double u, v;
};

/// Maxwellian of one component of the velocity on {-1, 0, 1}, exact in its first three moments, and its derivative by
/// u.
double maxwellian(int c, double u) { return c == 0 ? 2.0 / 3.0 - u * u : 1.0 / 6.0 + 0.5 * c * u + 0.5 * u * u; }
double maxwellian_slope(int c, double u) { return c == 0 ? -2 * u : 0.5 * c + u; }

/// `maxwellian` gives the products of the above, as the central moments have them; else second order in u.
Parts parts(const Nodes<double>& nodes, std::size_t x, bool inertia, bool product, bool forced) {
  Parts p{};
  const double fx = forced ? nodes.force[0][x] : 0, fy = forced ? nodes.force[1][x] : 0;
  double density = 0;
  p.u = fx / 2, p.v = fy / 2;
  for (std::size_t q = 0; q < 9; ++q) {
    density += nodes.f[q][x];
    p.u += d2q9::velocity[q][0] * nodes.f[q][x];
    p.v += d2q9::velocity[q][1] * nodes.f[q][x];
  }
  for (std::size_t q = 0; q < 9; ++q) {
    const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
    const double w = d2q9::weight[q], along = cx * p.u + cy * p.v, push = cx * fx + cy * fy;
    if (inertia && product) {
      p.equilibrium[q] = w * density + maxwellian(cx, p.u) * maxwellian(cy, p.v) - w;
      p.half_source[q] = 0.5 * (fx * maxwellian_slope(cx, p.u) * maxwellian(cy, p.v) +
                                fy * maxwellian(cx, p.u) * maxwellian_slope(cy, p.v));
    } else {
      const double quadratic = inertia ? 4.5 * along * along - 1.5 * (p.u * p.u + p.v * p.v) : 0;
      const double power = inertia ? 9 * along * push - 3 * (p.u * fx + p.v * fy) : 0;
      p.equilibrium[q] = w * (density + 3 * along + quadratic);
      p.half_source[q] = 0.5 * w * (3 * push + power);
    }
    p.relaxing[q] = nodes.f[q][x] - p.equilibrium[q] + p.half_source[q];
  }
  return p;
}

/// Sum of n (cx - u)^a (cy - v)^b.
double moment(const Populations& n, int a, int b, double u = 0, double v = 0) {
  double sum = 0;
  for (std::size_t q = 0; q < 9; ++q) {
    sum += n[q] * std::pow(d2q9::velocity[q][0] - u, a) * std::pow(d2q9::velocity[q][1] - v, b);
  }
  return sum;
}

/// What a collision has left of n.
Populations left(const Nodes<double>& after, std::size_t x, const Parts& before) {
  Populations n{};
  for (std::size_t q = 0; q < 9; ++q) n[q] = after.f[q][x] - before.equilibrium[q] - before.half_source[q];
  return n;
}

Nodes<double> collided(const Operator& op, const Nodes<double>& before, const Collide& how = {.own_rates = false}) {
  return collide(op.f64, op.self.get(), before, how);
}

double largest_difference(const Nodes<double>& a, const Nodes<double>& b) {
  double largest = 0;
  for (std::size_t x = 0; x < a.count; ++x) {
    for (std::size_t q = 0; q < 9; ++q) largest = std::max(largest, std::abs(a.f[q][x] - b.f[q][x]));
  }
  return largest;
}

/// Calls test(one, other) for two operators, with the inertia settings and instruction sets given.
template <class Test>
void compare(const std::string& one, const NamedValues& of_one, const std::string& other, const NamedValues& of_other,
             std::initializer_list<bool> inertias, Test test) {
  for (const bool inertia : inertias) {
    for (const auto& set : instruction_sets()) {
      CAPTURE(one, other, inertia, set);
      test(make_operator(one, set, rate, inertia, of_one), make_operator(other, set, rate, inertia, of_other));
    }
  }
}

NamedValues mrt(double energy, double energy_square, double heat_flux, double magic) {
  return {
      {"energy_rate", energy}, {"energy_square_rate", energy_square}, {"heat_flux_rate", heat_flux}, {"magic", magic}};
}
NamedValues central(double bulk, double third, double fourth, double magic) {
  return {{"bulk_rate", bulk}, {"third_order_rate", third}, {"fourth_order_rate", fourth}, {"magic", magic}};
}

}  // namespace

TEST_CASE("equilibrium is a fixed point") {
  for_each_operator([&](const Operator& op) {
    auto equilibrium = Nodes<double>::random(node_count, 1);
    for (std::size_t x = 0; x < node_count; ++x) {
      const Parts p = parts(equilibrium, x, op.inertia, op.id == "central-moment", false);
      for (std::size_t q = 0; q < 9; ++q) equilibrium.f[q][x] = p.equilibrium[q];
    }
    CHECK(largest_difference(collided(op, equilibrium, {.forced = false}), equilibrium) < rounding);
  });
}

TEST_CASE("a collision leaves 1 - 1/tau of the shear stress and what the bulk rate leaves of the pressure's") {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  for_each_operator([&](const Operator& op) {
    for (const bool own_rates : {false, true}) {
      const auto after = collided(op, before, {.own_rates = own_rates});
      for (std::size_t x = 0; x < node_count; ++x) {
        const Parts p = parts(before, x, op.inertia, op.id == "central-moment", true);
        const Populations rest = left(after, x, p);
        const double omega = own_rates ? before.rate[x] : rate;
        const double bulk = op.id == "mrt" ? 1.64 : op.id == "central-moment" ? 0.8 : omega;
        const double keep = 1 - omega;
        REQUIRE(std::abs(moment(rest, 1, 1) - keep * moment(p.relaxing, 1, 1)) < 9 * rounding);
        REQUIRE(std::abs(moment(rest, 2, 0) - moment(rest, 0, 2) -
                         keep * (moment(p.relaxing, 2, 0) - moment(p.relaxing, 0, 2))) < 9 * rounding);
        REQUIRE(std::abs(moment(rest, 2, 0) + moment(rest, 0, 2) -
                         (1 - bulk) * (moment(p.relaxing, 2, 0) + moment(p.relaxing, 0, 2))) < 9 * rounding);
      }
    }
  });
}

TEST_CASE("a collision knows no direction: turned and mirrored nodes give the turned and mirrored result") {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  const auto before = Nodes<double>::random(node_count, seed);
  // The square's eight symmetries as matrices {xx, xy, yx, yy}.
  const int symmetries[8][4] = {{1, 0, 0, 1},  {0, -1, 1, 0}, {-1, 0, 0, -1}, {0, 1, -1, 0},
                                {-1, 0, 0, 1}, {1, 0, 0, -1}, {0, 1, 1, 0},   {0, -1, -1, 0}};
  const auto turn = [&](const Nodes<double>& nodes, const int(&m)[4]) {
    auto turned = nodes;
    for (std::size_t q = 0; q < 9; ++q) {
      const int cx = m[0] * d2q9::velocity[q][0] + m[1] * d2q9::velocity[q][1];
      const int cy = m[2] * d2q9::velocity[q][0] + m[3] * d2q9::velocity[q][1];
      for (std::size_t p = 0; p < 9; ++p) {
        if (d2q9::velocity[p][0] == cx && d2q9::velocity[p][1] == cy) turned.f[p] = nodes.f[q];
      }
    }
    for (std::size_t x = 0; x < nodes.count; ++x) {
      for (std::size_t k = 0; k < 2; ++k) {
        turned.force[k][x] = m[2 * k] * nodes.force[0][x] + m[2 * k + 1] * nodes.force[1][x];
      }
    }
    return turned;
  };
  for_each_operator([&](const Operator& op) {
    const auto after = collided(op, before);
    for (const auto& symmetry : symmetries) {
      CHECK(largest_difference(collided(op, turn(before, symmetry)), turn(after, symmetry)) < rounding);
    }
  });
}

TEST_CASE("rates that are all equal make TRT, MRT and central moments BGK") {
  const auto before = Nodes<double>::random(node_count, 7);
  const double half = 1 / rate - 0.5;
  const auto equal = [&](const Operator& one, const Operator& other) {
    CHECK(largest_difference(collided(one, before), collided(other, before)) < rounding);
  };
  compare("bgk", {}, "trt", {{"magic", half * half}}, {false, true}, equal);
  compare("bgk", {}, "mrt", mrt(rate, rate, rate, 0), {false, true}, equal);
  compare("bgk", {}, "mrt", mrt(0, 0, 0, 0), {false, true}, equal);
  // With inertia the central moments' equilibrium goes on to third and fourth order in u.
  compare("bgk", {}, "central-moment", central(rate, rate, rate, 0), {false}, equal);
  compare("bgk", {}, "central-moment", central(0, 0, 0, 0), {false}, equal);
  // At tau = 1 nothing of n is left: all that makes operators different.
  for (const bool inertia : {false, true}) {
    const auto bgk = make_operator("bgk", "baseline", 1, inertia, {});
    equal(bgk, make_operator("regularised", "baseline", 1, inertia, {}));
    equal(bgk, make_operator("mrt", "baseline", 1, inertia, mrt(0, 0, 0, 0.25)));
  }
}

TEST_CASE("with rates of 0 equality with BGK, and with magic equality with TRT, hold where viscosity varies too") {
  const auto before = Nodes<double>::random(node_count, 8);
  const auto equal = [&](const Operator& one, const Operator& other) {
    CHECK(largest_difference(collided(one, before, {}), collided(other, before, {})) < rounding);
  };
  compare("bgk", {}, "mrt", mrt(0, 0, 0, 0), {false, true}, equal);
  compare("bgk", {}, "central-moment", central(0, 0, 0, 0), {false}, equal);
  compare("trt", {{"magic", 0.3}}, "mrt", mrt(0, 0, 0, 0.3), {false, true}, equal);
  compare("trt", {{"magic", 0.3}}, "central-moment", central(0, 0, 0, 0.3), {false}, equal);
}

TEST_CASE("MRT is the relaxation of Lallemand and Luo's nine moments, each of the source with 1 - s/2") {
  const auto before = Nodes<double>::random(node_count, 9);
  // Moments rho, e, epsilon, jx, qx, jy, qy, pxx, pxy as polynomials of the velocity, with squares of length.
  const auto polynomial = [](int k, double x, double y) {
    const double s = x * x + y * y;
    const double values[9] = {
        1, 3 * s - 4, 4 - 10.5 * s + 4.5 * s * s, x, (3 * s - 5) * x, y, (3 * s - 5) * y, x * x - y * y, x * y};
    return values[k];
  };
  const double rates[9] = {1, 1.1, 0.7, 1, 1.9, 1, 1.9, rate, rate};
  for (const bool inertia : {false, true}) {
    const auto op = make_operator("mrt", "baseline", rate, inertia, mrt(1.1, 0.7, 1.9, 0));
    const auto after = collided(op, before);
    for (std::size_t x = 0; x < node_count; ++x) {
      const Parts p = parts(before, x, inertia, false, true);
      Populations expected = p.equilibrium;
      for (std::size_t q = 0; q < 9; ++q) expected[q] += p.half_source[q];
      for (int k = 0; k < 9; ++k) {
        double norm = 0, amount = 0;
        for (std::size_t q = 0; q < 9; ++q) {
          const double m = polynomial(k, d2q9::velocity[q][0], d2q9::velocity[q][1]);
          norm += m * m;
          amount += m * p.relaxing[q];
        }
        for (std::size_t q = 0; q < 9; ++q) {
          expected[q] += (1 - rates[k]) * amount / norm * polynomial(k, d2q9::velocity[q][0], d2q9::velocity[q][1]);
        }
      }
      for (std::size_t q = 0; q < 9; ++q) REQUIRE(std::abs(after.f[q][x] - expected[q]) < 4 * rounding);
    }
  }
}

TEST_CASE("regularised: what is left of n is 9/2 w (cc - 1/3) : its stress, the half force not among it") {
  const auto before = Nodes<double>::random(node_count, 10);
  for (const bool inertia : {false, true}) {
    const auto after = collided(make_operator("regularised", "baseline", rate, inertia, {}), before);
    for (std::size_t x = 0; x < node_count; ++x) {
      const Parts p = parts(before, x, inertia, false, true);
      const Populations rest = left(after, x, p);
      const double xx = moment(p.relaxing, 2, 0), xy = moment(p.relaxing, 1, 1), yy = moment(p.relaxing, 0, 2);
      for (std::size_t q = 0; q < 9; ++q) {
        const int cx = d2q9::velocity[q][0], cy = d2q9::velocity[q][1];
        const double stress = (cx * cx - 1.0 / 3) * xx + 2 * cx * cy * xy + (cy * cy - 1.0 / 3) * yy;
        REQUIRE(std::abs(rest[q] - (1 - rate) * 4.5 * d2q9::weight[q] * stress) < 4 * rounding);
      }
    }
  }
}

TEST_CASE("central moments relax each at its own rate in the moving frame with inertia, at rest without") {
  const auto before = Nodes<double>::random(node_count, 11);
  for (const bool inertia : {false, true}) {
    const auto op = make_operator("central-moment", "baseline", rate, inertia, central(0.8, 1.9, 1.1, 0));
    const auto after = collided(op, before);
    for (std::size_t x = 0; x < node_count; ++x) {
      const Parts p = parts(before, x, inertia, true, true);
      const Populations rest = left(after, x, p);
      const double u = inertia ? p.u : 0, v = inertia ? p.v : 0;
      const auto check = [&](int a, int b, double s) {
        REQUIRE(std::abs(moment(rest, a, b, u, v) - (1 - s) * moment(p.relaxing, a, b, u, v)) < 9 * rounding);
      };
      check(1, 1, rate);
      check(2, 1, 1.9);
      check(1, 2, 1.9);
      check(2, 2, 1.1);
      REQUIRE(std::abs(moment(rest, 0, 0)) + std::abs(moment(rest, 1, 0)) + std::abs(moment(rest, 0, 1)) <
              18 * rounding);
    }
  }
}
