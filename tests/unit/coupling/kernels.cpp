// Kernels of the immersed boundary: moments wherever a node may be, shapes, and what happens beside a wall.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/coupling/coupling.hpp"
#include "core/coupling/kernel.hpp"
#include "core/coupling/slip_constants.hpp"
#include "core/fluid/periodic.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// The weights for a coordinate, and where their nodes lie against it.
template <class Kernel>
struct Stencil {
  static constexpr int points = Kernel::points;
  double weight[points], distance[points];
  explicit Stencil(double fraction) {
    using One = rouleau::Pack<double, 1>;
    One p, q;
    Kernel::keep(One(fraction), p, q);
    const auto weights = KernelWeights<Kernel, double>(p.vector[0], q.vector[0]).weight;
    const SpreadWeights<Kernel, double> one_by_one(p.vector[0], q.vector[0]);
    for (int k = 0; k < points; ++k) {
      weight[k] = weights.at(k);
      distance[k] = k + Kernel::first - (fraction - Kernel::shift);
      REQUIRE(one_by_one.weight[k].vector[2] == Approx(weight[k]).margin(1e-15));
    }
  }
  [[nodiscard]] double moment(int order) const {
    double sum = 0;
    for (int k = 0; k < points; ++k) sum += weight[k] * std::pow(distance[k], order);
    return sum;
  }
};

/// Largest deviation of a moment from a value over the unit interval, its ends included.
template <class Kernel>
double largest_moment(int order, double from) {
  double worst = 0;
  for (int i = 0; i <= 20000; ++i) {
    const double fraction = i < 20000 ? i / 20000.0 : 1 - 1e-16;
    worst = std::max(worst, std::abs(Stencil<Kernel>(fraction).moment(order) - from));
  }
  return worst;
}

constexpr double rounding = 1e-14;

}  // namespace

TEMPLATE_TEST_CASE("the weights of every kernel sum to one and none is negative", "", Peskin4, Cosine4, Roma3,
                   Linear2) {
  CHECK(largest_moment<TestType>(0, 1) < rounding);
  for (int i = 0; i < 1000; ++i) {
    for (const double weight : Stencil<TestType>(i / 1000.0).weight) REQUIRE(weight > -rounding);
  }
}

TEMPLATE_TEST_CASE("kernels that a membrane may use have no first moment", "", Peskin4, Roma3, Linear2, Sharp6) {
  CHECK(largest_moment<TestType>(1, 0) < rounding);
}

TEST_CASE(
    "the sharp kernel sums to one, has no second moment in the mean over places, and as much on even as on odd nodes") {
  CHECK(largest_moment<Sharp6>(0, 1) < rounding);
  constexpr int places = 20000;
  double mean = 0, most = 0;
  for (int i = 0; i < places; ++i) {
    const Stencil<Sharp6> stencil((i + 0.5) / places);
    const double second = stencil.moment(2);
    mean += second / places;
    most = std::max(most, std::abs(second));
    const auto& w = stencil.weight;
    REQUIRE(w[0] + w[2] + w[4] == Approx(0.5).margin(rounding));
  }
  CHECK(std::abs(mean) < 1e-4);
  CHECK(most < 0.025);
}

TEMPLATE_TEST_CASE("how a wave of forces comes back through a kernel is what the semi-implicit step takes", "", Peskin4,
                   Sharp6) {
  const KernelKind kind = std::is_same_v<TestType, Sharp6> ? KernelKind::sharp6 : KernelKind::peskin4;
  constexpr int places = 500;
  constexpr double shift = 0.4;
  double squares = 0, stretching = 0, bending = 0, shifted = 0;
  for (double k = 0.01; k < M_PI; k += 0.01) {
    double transform = 0;
    squares = 0;
    for (int i = 0; i < places; ++i) {
      const Stencil<TestType> stencil((i + 0.5) / places);
      for (int j = 0; j < TestType::points; ++j) {
        transform += stencil.weight[j] * std::cos(k * stencil.distance[j]) / places;
        squares += stencil.weight[j] * stencil.weight[j] / places;
      }
    }
    stretching = std::max(stretching, k * k * transform * transform);
    bending = std::max(bending, k * k * k * k * transform * transform);
    shifted = std::max(shifted, k * k * k * k * transform * transform * (1 + k * k * shift * shift));
  }
  const KernelResponse response = kernel_response(kind);
  CHECK(response.gain == Approx(squares / 0.375).epsilon(5e-3));
  CHECK(response.stretching == Approx(stretching).epsilon(5e-3));
  CHECK(response.bending == Approx(bending).epsilon(5e-3));
  CHECK(shift_gain(kind, 0) == 1);
  CHECK(shift_gain(kind, shift) == Approx(shifted / bending).epsilon(5e-3));
  CHECK(shift_gain(kind, -shift) == shift_gain(kind, shift));
}

TEST_CASE("the cosine kernel has a first moment of up to 0.0211 spacings") {
  const double largest = largest_moment<Cosine4>(1, 0);
  // e(g) = 1/2 - g + (sin(pi g / 2) - cos(pi g / 2)) / 2 is largest where cos(pi g / 2) + sin(pi g / 2) = 4 / pi.
  const double g = 2 / M_PI * (M_PI / 4 - std::acos(4 / M_PI / std::sqrt(2.0)));
  CHECK(largest == Approx(std::abs(0.5 - g + (std::sin(M_PI * g / 2) - std::cos(M_PI * g / 2)) / 2)).epsilon(1e-6));
  CHECK(largest == Approx(0.0211).epsilon(0.01));  // what plan/constants.cpp says
}

TEST_CASE("each kernel is the function of distance that its paper gives") {
  const auto peskin = [](double r) {
    return r < 1 ? (3 - 2 * r + std::sqrt(1 + 4 * r - 4 * r * r)) / 8
                 : (5 - 2 * r - std::sqrt(std::max(0.0, -7 + 12 * r - 4 * r * r))) / 8;
  };
  const auto roma = [](double r) {
    if (r < 0.5) return (1 + std::sqrt(1 - 3 * r * r)) / 3;
    return r < 1.5 ? (5 - 3 * r - std::sqrt(std::max(0.0, 1 - 3 * (1 - r) * (1 - r)))) / 6 : 0.0;
  };
  for (int i = 1; i < 100; ++i) {
    const Stencil<Peskin4> a(i / 100.0);
    const Stencil<Cosine4> b(i / 100.0);
    const Stencil<Roma3> c(i / 100.0);
    const Stencil<Linear2> d(i / 100.0);
    for (int k = 0; k < 4; ++k) {
      CHECK(a.weight[k] == Approx(peskin(std::abs(a.distance[k]))).margin(1e-14));
      CHECK(b.weight[k] == Approx((1 + std::cos(M_PI * b.distance[k] / 2)) / 4).margin(1e-14));
      CHECK(c.weight[k] == Approx(roma(std::abs(c.distance[k]))).margin(1e-14));
      CHECK(d.weight[k] == Approx(std::max(0.0, 1 - std::abs(d.distance[k]))).margin(1e-14));
    }
  }
}

TEST_CASE("beside a moving wall linear flow is interpolated exactly, by every kernel without a first moment") {
  const KernelKind kernel = GENERATE(KernelKind::peskin4, KernelKind::roma3, KernelKind::linear2, KernelKind::sharp6);
  const int nx = 24, ny = 16;
  const double rate = 0.02, lower = -0.1;
  VectorField<double, 2> velocity{Field<double, 2>({nx, ny}), Field<double, 2>({nx, ny})};
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) velocity[0].row(y)[x] = lower + rate * (y + 0.5);
  }
  for (int y = 0; y < ny; ++y)
    fill_velocity_halo<double, 2>(velocity, {y}, {{nx, ny}, {true, false}}, {lower, lower + rate * ny});
  Membranes m = biconcave_cells({{12, 8, 0}}, 64);
  auto random = generator(77);
  std::uniform_real_distribution<double> along(0, nx), gap(0, 2);
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    m.position[0][i] = along(random);
    m.position[1][i] = i % 2 == 0 ? -0.5 + gap(random) : ny - 0.5 - gap(random);
  }
  Coupling<double, 2> coupling(kernel, {{nx, ny}, {true, false}});
  coupling.reserve(m);
  coupling.locate({}, m, m.positions());
  REQUIRE(coupling.escaped(m) == -1);
  coupling.interpolate({}, m, velocity);
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(m.velocity[0][i] == Approx(lower + rate * (m.position[1][i] + 0.5)).margin(1e-14));
    REQUIRE(m.velocity[1][i] == Approx(0).margin(1e-15));
  }
}
