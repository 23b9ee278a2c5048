// Models of which only the energy is written: what is derived from it is what a hand derives, to rounding.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>
#include <rouleau/functions.hpp>

#include "instruction_sets.hpp"
#include "shipped_models.hpp"

#define rouleau_open_v1 open_logarithmic_spring
#include "examples/logarithmic-spring/logarithmic-spring.cpp"
#undef rouleau_open_v1

#include <rouleau/interaction.hpp>
#include <rouleau/membrane.hpp>

/// Morse's potential, as docs and shipped plugin have it, without its derivatives.
struct MorseEnergy {
  double De, beta, r0, rc;
  explicit MorseEnergy(const rouleau::Parameters& p)
      : De{p["depth"]}, beta{p["decay"]}, r0{p["zero_force_distance"]}, rc{p["cutoff"]} {}
  double cutoff() const { return rc; }

  template <class S>
  S energy(const S& r) const {
    const S s = exp(beta * (r0 - r));
    return De * s * (s - 2.0);
  }
};

/// Bending and a whole cell's area and perimeter, together in one energy of area times perimeter.
struct BendingEnergy {
  explicit BendingEnergy(const rouleau::Parameters&) {}
  template <class S>
  S energy(const rouleau::Vertex<S>& vertex) const {
    const S bent = vertex.curvature - vertex.rest_curvature;
    return 0.5 * bent * bent * bent;
  }
};
struct CellEnergy {
  explicit CellEnergy(const rouleau::Parameters&) {}
  template <class S>
  S energy(const rouleau::Cell<S>& cell) const {
    return log(cell.area / cell.rest_area) * cell.perimeter * cell.perimeter / cell.rest_perimeter;
  }
};

namespace {

using namespace rouleau::test;
using Number = rouleau::Dual<double>;

const Setup well{{{"depth", 1.3}, {"decay", 0.4}, {"zero_force_distance", 2.5}, {"cutoff", 10}}};

/// Derivatives as the sixth-order difference quotient gives them: errors of h^6 and of rounding over h^2.
void check_function(const char* name, const std::function<Number(const Number&)>& f,
                    const std::vector<double>& arguments) {
  constexpr double h = 0.01;
  for (const double x : arguments) {
    CAPTURE(name, x);
    const auto at = [&](int k) { return static_cast<long double>(f(Number(x + k * h)).value); };
    const Number result = f(Number::argument(x));
    const long double first = (45 * (at(1) - at(-1)) - 9 * (at(2) - at(-2)) + (at(3) - at(-3))) / (60 * h);
    const long double second =
        (270 * (at(1) + at(-1)) - 27 * (at(2) + at(-2)) + 2 * (at(3) + at(-3)) - 490 * at(0)) / (180 * h * h);
    CHECK(result.value == f(Number(x)).value);
    CHECK(result.first == Approx(static_cast<double>(first)).epsilon(1e-7).margin(1e-8));
    CHECK(result.second == Approx(static_cast<double>(second)).epsilon(1e-7).margin(1e-7));
  }
}

}  // namespace

TEST_CASE("every function and operation of a dual number has the derivatives of its value") {
  const std::vector<double> positive = {0.7, 1.0, 1.9, 4.2}, any = {-2.1, -0.4, 0.0, 0.3, 1.7};
  check_function(
      "sum", [](const Number& x) { return 2 + (x + 1) - (3 - x) * 0.5 + (x - x * x) - 4; }, any);
  check_function(
      "product", [](const Number& x) { return (x * x - 1.0) * (2 * x + 1.0) * -x; }, any);
  check_function(
      "quotient", [](const Number& x) { return (x * x + 1.0) / (x + 5.0) + x / 3; }, any);
  check_function(
      "inverse", [](const Number& x) { return 2.5 / (x + 5.0); }, any);
  check_function(
      "assignments",
      [](const Number& x) {
        Number y = x;
        y += x * x, y -= 3.0, y *= x;
        return y;
      },
      any);
  check_function(
      "sqrt", [](const Number& x) { return sqrt(x * x + 1.0); }, any);
  check_function(
      "1/sqrt", [](const Number& x) { return sqrt_and_inverse(x * x + 1.0).inverse; }, any);
  check_function(
      "exp", [](const Number& x) { return exp(-0.5 * x * x); }, any);
  check_function(
      "log", [](const Number& x) { return x * log(x); }, positive);
  check_function(
      "expm1", [](const Number& x) { return x * expm1(-0.5 * x); }, any);
  check_function(
      "log1p", [](const Number& x) { return x * log1p(x); }, positive);
  check_function(
      "sin, cos", [](const Number& x) { return sin(1.5 * x) + x * cos(x * x * 0.3); }, any);
  check_function(
      "tanh", [](const Number& x) { return x * tanh(x); }, any);
  check_function(
      "erf", [](const Number& x) { return x * erf(x); }, any);
  check_function(
      "power", [](const Number& x) { return pow(x, 2.7) + pow(x, -1.5); }, positive);
  check_function(
      "whole power", [](const Number& x) { return pow(x, 3.0) + pow(x, 2) - pow(x, 1) + pow(x, 0); }, any);
  check_function(
      "exponent", [](const Number& x) { return pow(x, x) + pow(1.7, x); }, positive);
  check_function("min, max, abs", [](const Number& x) { return min(x * x, 0.01 + x) + max(x, 1.3 * x) + abs(x) * x; },
                 {-2.1, -0.4, 0.3, 1.7});
  check_function("select", [](const Number& x) { return select(x < 0.1, x * x, select(x >= 1.0, sin(x), 2 * x)); },
                 {-2.1, -0.4, 0.3, 1.7});
}

TEST_CASE("a power of zero has its derivatives, infinite where they are") {
  const Number zero = Number::argument(0);
  const auto is = [](const Number& n, double value, double first, double second) {
    CHECK(n.value == value);
    CHECK(n.first == first);
    CHECK((n.second == second || (std::isnan(n.second) && std::isnan(second))));
  };
  is(pow(zero, 0), 1, 0, 0);
  is(pow(zero, 1), 0, 1, 0);
  is(pow(zero, 2), 0, 0, 2);
  is(pow(zero, 4.5), 0, 0, 0);
  is(pow(zero, 1.5), 0, 0, HUGE_VAL);
}

TEST_CASE("Morse's energy alone gives the shipped potential for each instruction set") {
  std::vector<double> at;
  for (int i = 0; i < 1001; ++i) at.push_back(0.01 * i);
  const Values by_hand = Shipped(*open_morse(0), well)(at);
  const rouleau_model model = rouleau::interaction<MorseEnergy>("energy", "1");
  const Self self = make(model, well);
  CHECK(model.interaction->cutoff(self.get()) == 10);
  for (const auto& set : instruction_sets()) {
    using Loop = rouleau::detail::InteractionLoop<MorseEnergy>;
    const auto compute = pick_for<Loop, const void*, const rouleau_interaction_block*>(set);
    const auto fill_pair = [](auto& block, const double* in, double* slope, double* derivative) {
      fill(block, in, slope, derivative);
    };
    const Values derived = evaluate<rouleau_interaction_block>(at, at.size(), fill_pair, compute, self.get());
    CAPTURE(set);
    for (std::size_t i = 0; i < at.size(); ++i) {
      // Terms of the formulas cancel near the well; against their size at contact these are a few roundings.
      CHECK(derived.energy[i] == Approx(by_hand.energy[i]).margin(1e-14));
      CHECK(derived.slope[i] == Approx(by_hand.slope[i]).margin(1e-14));
      CHECK(derived.slope_by_argument[i] == Approx(by_hand.slope_by_argument[i]).margin(1e-14));
    }
  }
}

TEST_CASE("a law of segments made of its energy has the tension and the stiffness that a hand derives") {
  const Shipped law(*open_logarithmic_spring(0), {{{"stretching_modulus", 1.7}}});
  for (const double e : {0.01, 0.3, 1.0, 1.2, 5.0}) {
    CAPTURE(e);
    CHECK(law.energy(e) == Approx(1.7 / 4 * (e * e - 1 - 2 * std::log(e))).epsilon(1e-14).margin(1e-15));
    CHECK(law.slope(e) == Approx(1.7 / 2 * (e - 1 / e)).epsilon(1e-14).margin(1e-15));
    CHECK(law.derivative(e) == Approx(1.7 / 2 * (1 + 1 / (e * e))).epsilon(1e-14));
  }
}

TEST_CASE("laws of nodes and of cells made of their energies have the moments and forces that a hand derives") {
  const rouleau_model bending = rouleau::membrane<BendingEnergy>("bending", "1"),
                      cell = rouleau::membrane<CellEnergy>("cell", "1");
  const double first[3] = {0.3, 1.1, 2.0}, rest_first[3] = {0.1, 1.5, 1.0}, second[3] = {4, 5, 7},
               rest_second[3] = {4, 6, 5};
  double energy[3], force[3], other[3];
  rouleau_membrane_block block{};
  block.struct_size = sizeof block;
  block.count = 3;
  block.energy = energy;
  block.curvature = first, block.rest_curvature = rest_first;
  block.moment = force, block.moment_by_curvature = other;
  bending.membrane->compute(make(bending, {}).get(), &block);
  for (int i = 0; i < 3; ++i) {
    const double bent = first[i] - rest_first[i];
    CHECK(energy[i] == Approx(0.5 * bent * bent * bent).epsilon(1e-14));
    CHECK(force[i] == Approx(1.5 * bent * bent).epsilon(1e-14));
    CHECK(other[i] == Approx(3 * bent).epsilon(1e-14));
  }
  block.curvature = block.rest_curvature = nullptr;
  block.moment = block.moment_by_curvature = nullptr;
  block.area = first, block.rest_area = rest_first, block.perimeter = second, block.rest_perimeter = rest_second;
  block.pressure = force, block.perimeter_tension = other;
  cell.membrane->compute(make(cell, {}).get(), &block);
  for (int i = 0; i < 3; ++i) {
    const double dilation = std::log(first[i] / rest_first[i]), length = second[i] * second[i] / rest_second[i];
    CHECK(energy[i] == Approx(dilation * length).epsilon(1e-14));
    CHECK(force[i] == Approx(-length / first[i]).epsilon(1e-14));
    CHECK(other[i] == Approx(2 * dilation * second[i] / rest_second[i]).epsilon(1e-14));
  }
}

namespace {

template <class F>
double nanoseconds(std::size_t count, const F& f) {
  double least = 1e300;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    f();
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    least = std::min(least, time.count() / static_cast<double>(count));
  }
  return least;
}

enum class Function { exp, log, log1p, expm1, pow, sin, cos, tanh, erf };
template <class T, Function function>
struct CostLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const T* from, T* to, std::uint32_t count) {
    using S = rouleau::Pack<T, register_bytes / static_cast<int>(sizeof(T))>;
    for (std::uint32_t i = 0; i < count; i += S::size) {
      const S x = S::load(from + i);
      if constexpr (function == Function::exp && sizeof(T) == 8) exp(x).store(to + i);
      if constexpr (function == Function::log) log(x).store(to + i);
      if constexpr (function == Function::log1p) log1p(x).store(to + i);
      if constexpr (function == Function::expm1) expm1(x).store(to + i);
      if constexpr (function == Function::pow) pow(x, 2.7).store(to + i);
      if constexpr (function == Function::sin) sin(x).store(to + i);
      if constexpr (function == Function::cos) cos(x).store(to + i);
      if constexpr (function == Function::tanh) tanh(x).store(to + i);
      if constexpr (function == Function::erf) erf(x).store(to + i);
    }
  }
};

template <class T, Function... functions>
void print_costs(const std::string& set) {
  std::vector<T> from(4096), to(4096);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<T>(0.01 + 0.001 * static_cast<double>(i));
  std::cout << set << (sizeof(T) == 8 ? " f64" : " f32");
  const auto print = [&](auto loop) {
    std::cout << "  " << nanoseconds(4096, [&] { loop(from.data(), to.data(), 4096U); });
  };
  (print(pick_for<CostLoop<T, functions>, const T*, T*, std::uint32_t>(set)), ...);
  std::cout << '\n';
}

}  // namespace

// unit_sdk "[cost]" prints them; sdk/README.md holds what it printed. Instructions:
// valgrind --tool=callgrind --toggle-collect='*InteractionLoop<Morse>*::avx2*' unit_sdk "[cost]", and the same of
// MorseEnergy; each is called 200 times for 4096 pairs.
TEST_CASE("the costs of functions and of derived forces", "[.][cost]") {
  std::cout.precision(3);
  std::cout << "nanoseconds a value          exp log pow sin cos tanh erf\n";
  for (const auto& set : instruction_sets()) {
    print_costs<double, Function::exp, Function::log, Function::pow, Function::sin, Function::cos, Function::tanh,
                Function::erf>(set);
    print_costs<float, Function::log, Function::pow, Function::sin, Function::cos, Function::tanh, Function::erf>(set);
  }
  std::vector<double> distance(4096), energy(4096), force(4096), derivative(4096);
  for (std::size_t i = 0; i < distance.size(); ++i) distance[i] = 0.1 + 0.002 * static_cast<double>(i);
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = 4096;
  block.distance = distance.data();
  block.energy = energy.data();
  block.force = force.data();
  block.force_by_distance = derivative.data();
  const rouleau_model derived = rouleau::interaction<MorseEnergy>("energy", "1");
  for (const rouleau_model* model : {open_morse(0)->models[0], &derived}) {
    const Self self = make(*model, well);
    std::cout << model->id << ": " << nanoseconds(4096, [&] { model->interaction->compute(self.get(), &block); })
              << " ns a pair with energy, force and stiffness\n";
  }
}
