// The models that "rouleau new" begins with keep what their manifests and comments say.
#include <catch2/catch.hpp>
#include <cmath>

#include "nodes.hpp"
#include "operators.hpp"
#include "shipped_models.hpp"

#define rouleau_open_v1 open_template_interaction
#define ModelType TemplateWell
#include "template/interaction/model-name.cpp"
#undef ModelType
#undef rouleau_open_v1
#define rouleau_open_v1 open_template_membrane
#define ModelType TemplateMembrane
#include "template/membrane/model-name.cpp"
#undef ModelType
#undef rouleau_open_v1
#define rouleau_open_v1 open_template_collision
#define ModelType TemplateCollision
#include "template/collision/model-name.cpp"
#undef ModelType
#undef rouleau_open_v1

namespace {

using namespace rouleau::test;

constexpr double De = 1.3, beta = 0.4, r0 = 2.5;

Shipped well(double steepness) {
  return {*open_template_interaction(0),
          {{{"depth", De}, {"decay", beta}, {"zero_force_distance", r0}, {"steepness", steepness}, {"cutoff", 10}}}};
}

/// Central differences err by h^2/6 of the third derivative and by rounding over h: 1e-9 with h = 1e-5 and values of
/// order one.
void check_derivatives(const Shipped& model, double sign, const std::vector<double>& arguments) {
  constexpr double h = 1e-5;
  for (const double at : arguments) {
    CAPTURE(at);
    CHECK(model.slope(at) == Approx(sign * (model.energy(at + h) - model.energy(at - h)) / (2 * h)).margin(1e-8));
    CHECK(model.derivative(at) == Approx((model.slope(at + h) - model.slope(at - h)) / (2 * h)).margin(1e-8));
  }
}

/// Largest difference between two operators at random nodes, with a force.
double difference(const rouleau_model& one, const Setup& setup, const rouleau_model& other, const Setup& other_setup) {
  const Self a = make(one, setup), b = make(other, other_setup);
  const Nodes<double> before = Nodes<double>::random(37, 20261122);
  Collide how;
  how.own_rates = false;
  const Nodes<double> after_one = collide(one.collision->collide_f64, a.get(), before, how);
  const Nodes<double> after_other = collide(other.collision->collide_f64, b.get(), before, how);
  double largest = 0;
  for (std::size_t q = 0; q < 9; ++q) {
    for (std::size_t x = 0; x < before.count; ++x) {
      largest = std::max(largest, std::abs(after_one.f[q][x] - after_other.f[q][x]));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("the template's well with steepness 2 is Morse's") {
  const Shipped morse(*open_morse(0), {{{"depth", De}, {"decay", beta}, {"zero_force_distance", r0}, {"cutoff", 10}}});
  for (const double r : {0.1, 1.0, 2.5, 4.0, 9.9}) {
    CHECK(well(2).energy(r) == Approx(morse.energy(r)).margin(1e-14));
    CHECK(well(2).slope(r) == Approx(morse.slope(r)).margin(1e-14));
    CHECK(well(2).derivative(r) == Approx(morse.derivative(r)).margin(1e-14));
  }
}

TEST_CASE("the template's well is deepest at the distance without force, and its force is the derivative") {
  for (const double steepness : {1.01, 3.0, 6.0}) {
    CAPTURE(steepness);
    CHECK(well(steepness).energy(r0) == Approx(-De).epsilon(1e-13));  // 1.01: divided by 0.01
    CHECK(std::abs(well(steepness).slope(r0)) < 1e-12);
    CHECK(well(steepness).cutoff() == 10);
    check_derivatives(well(steepness), -1, {1.0, 2.0, 2.5, 3.0, 5.0, 8.0});
  }
  // s = 1/2, by hand.
  const double r = r0 + std::log(2) / beta;
  CHECK(well(3).energy(r) == Approx(-11.0 / 16 * De).epsilon(1e-14));
  CHECK(well(3).slope(r) == Approx(-9.0 / 16 * De * beta).epsilon(1e-14));
  CHECK(well(3).derivative(r) == Approx(3.0 / 16 * De * beta * beta).epsilon(1e-14));
}

TEST_CASE("the template's membrane is at rest unstretched, is Hooke's near rest and stiffens") {
  const Shipped law(*open_template_membrane(0), {{{"stretching_modulus", 1.7}, {"stiffening", 4}}});
  CHECK(law.energy(1) == 0);
  CHECK(law.slope(1) == 0);
  CHECK(law.derivative(1) == 1.7);
  check_derivatives(law, 1, {0.5, 0.8, 0.99, 1.0, 1.01, 1.2, 1.4});
  // a x^2 = 1, by hand.
  const double e = std::exp(1.0);
  CHECK(law.energy(1.5) == Approx(1.7 / 8 * (e - 1)).epsilon(1e-14));
  CHECK(law.slope(1.5) == Approx(1.7 / 2 * e).epsilon(1e-14));
  CHECK(law.slope(0.5) == Approx(-1.7 / 2 * e).epsilon(1e-14));
  CHECK(law.derivative(1.5) == Approx(3 * 1.7 * e).epsilon(1e-14));
}

TEST_CASE("the template's collision is BGK with one rate for all, and TRT with the magic number of its two rates") {
  const rouleau_model& model = *open_template_collision(0)->models[0];
  for (const bool inertia : {false, true}) {
    for (const double omega : {0.7, 1.25, 1.8}) {
      CAPTURE(inertia, omega);
      const auto with = [&](const NamedValues& parameters) { return Setup{parameters, omega, inertia}; };
      // Populations are of the order 0.01, sums of nine rounded by 1e-18 each time.
      CHECK(difference(model, with({{"odd_rate", omega}}), collision_model("bgk"), with({})) < 1e-16);
      const double magic = (1 / omega - 0.5) * (1 / 1.2 - 0.5);
      CHECK(difference(model, with({{"odd_rate", 1.2}}), collision_model("trt"), with({{"magic", magic}})) < 1e-16);
      CHECK(difference(model, with({{"odd_rate", 1.1}}), collision_model("trt"), with({{"magic", magic}})) > 1e-5);
    }
  }
}
