// The shipped potentials one by one: where their wells lie, how they end, what they write.
#include <catch2/catch.hpp>

#include "shipped_models.hpp"

using namespace rouleau::test;

namespace {

const Setup well{{{"depth", 1.3}, {"decay", 0.4}, {"zero_force_distance", 2.5}, {"cutoff", 10}}};

}  // namespace

TEST_CASE("the Morse potential is deepest at the distance without force and agrees with its formula") {
  const Shipped morse(*open_morse(0), well);
  CHECK(morse.cutoff() == 10);
  const Values values = morse({2.5, 1.0, 5.0});
  CHECK(values.energy[0] == -1.3);
  CHECK(values.slope[0] == 0);
  CHECK(values.slope[1] > 0);
  CHECK(values.slope[2] < 0);
  const double s = std::exp(0.4 * 1.5);
  CHECK(values.energy[1] == Approx(1.3 * s * (s - 2)).epsilon(1e-14));
}

TEST_CASE("the Lennard-Jones potential is deepest at the distance without force and zero at 2^(-1/6) of it") {
  const Shipped potential(*open_lennard_jones(0), well);
  CHECK(potential.cutoff() == 10);
  CHECK(potential.energy(2.5) == Approx(-1.3).epsilon(1e-15));
  CHECK(std::abs(potential.slope(2.5)) < 1e-15);
  CHECK(potential.derivative(2.5) == Approx(-72 * 1.3 / (2.5 * 2.5)).epsilon(1e-14));
  CHECK(std::abs(potential.energy(2.5 * std::pow(2, -1.0 / 6))) < 1e-14);
  // The attraction is strongest where s = (r0/r)^6 is 7/13.
  CHECK(std::abs(potential.derivative(2.5 * std::pow(13.0 / 7, 1.0 / 6))) < 1e-14);
  CHECK(potential.slope(0.1) > 1e10);
}

TEST_CASE("broken off, the Lennard-Jones potential keeps its force to the cutoff; shifted, it ends without a jump") {
  const Shipped broken(*open_lennard_jones(0), well, 0), shifted(*open_lennard_jones(0), well, 1);
  const double s = std::pow(2.5 / 10, 6);
  CHECK(broken.energy(10) == Approx(1.3 * s * (s - 2)).epsilon(1e-14));
  CHECK(broken.slope(10) == Approx(12 * 1.3 * s * (s - 1) / 10).epsilon(1e-14));
  CHECK(std::abs(shifted.energy(10)) < 1e-16);
  CHECK(std::abs(shifted.slope(10)) < 1e-18);
  // What the shift costs is stated in the source: 2 (7 - 6/n) n^-6 of the depth at a cutoff of n zero-force distances.
  const double lost = shifted.energy(2.5) + 1.3;
  CHECK(lost > 0);
  CHECK(lost == Approx(1.3 * 2 * (7 - 6.0 / 4) * std::pow(4, -6)).epsilon(1e-3));
}

TEST_CASE("the pure repulsion repels at every distance, ever less, and ends with energy, force and stiffness zero") {
  const Shipped repulsion(*open_repulsion(0), {{{"strength", 1.3}, {"cutoff", 5}}});
  CHECK(repulsion.cutoff() == 5);
  CHECK(repulsion.energy(0) == 1.3);
  CHECK(repulsion.slope(0) == Approx(3 * 1.3 / 5).epsilon(1e-15));
  double before = 2 * repulsion.slope(0);
  for (int i = 0; i < 500; ++i) {
    const double force = repulsion.slope(i * 0.01);
    REQUIRE(force > 0);
    REQUIRE(force < before);
    before = force;
  }
  for (const double at : {5.0, 5.5}) {
    CHECK(repulsion.energy(at) == 0);
    CHECK(repulsion.slope(at) == 0);
    CHECK(repulsion.derivative(at) == 0);
  }
}

TEST_CASE("outputs that the host does not want are not written") {
  const Shipped morse(*open_morse(0), well);
  const double distance[3] = {1, 2, 3};
  double force[3] = {};
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = 3;
  block.distance = distance;
  block.force = force;
  open_morse(0)->models[0]->interaction->compute(morse.self(), &block);
  CHECK(force[0] > 0);
  CHECK(force[2] < 0);
}
