// Depletion against numbers worked out apart from the plugin, and what the model promises: a bell in concentration,
// continuity, repulsion down to contact, the same well regularised.
#include <catch2/catch.hpp>

#include "shipped_models.hpp"

using namespace rouleau::test;

namespace {

struct Minimum {
  double distance, energy;
};

/// Deepest point on a grid of 0.001 nm between 0.001 and 60 nm.
Minimum deepest(const Shipped& potential) {
  std::vector<double> at;
  for (int i = 1; i <= 60000; ++i) at.push_back(i * 1e-3);
  const std::vector<double> energy = potential(at).energy;
  const auto least = std::min_element(energy.begin(), energy.end());
  return {at[static_cast<std::size_t>(least - energy.begin())], *least};
}

Shipped physical(double kilodalton, double gram_per_decilitre, double second_virial) {
  return {*open_depletion(0), dextran(kilodalton, gram_per_decilitre, second_virial, 0)};
}

std::string refusal(const Setup& setup) {
  void* self = nullptr;
  const auto [code, error] = create(*open_depletion(0)->models[0], setup, &self);
  CHECK(code != 0);
  return error;
}

}  // namespace

TEST_CASE("dextran of 70 kDa at 3 g/dL gives a well of 11.3 uJ/m2 at 11.9 nm") {
  // Worked out before this program was written, at 298 K; the digits given are the tolerance.
  const Minimum minimum = deepest(physical(70, 3, 5e-4));
  CHECK(minimum.energy == Approx(-11.3).margin(0.05));
  CHECK(minimum.distance == Approx(11.9).margin(0.05));
}

TEST_CASE("depletion energies are those of a separate evaluation of Neu and Meiselman's formulas") {
  // Python, double precision, SI units throughout; the energy in uJ/m2 at the distance in nm. There the molar mass was
  // given in kg/mol: 1 Da x Avogadro's number is 1 g/mol only to 3.5e-10, which differences of w_D and w_E show up.
  struct Row {
    double kilodalton, concentration, second_virial, distance, energy;
  };
  const std::vector<Row> rows = {{70, 3, 5e-4, 5.5, 173.8226729039},       {70, 3, 5e-4, 8, 73.24425736957},
                                 {70, 3, 5e-4, 11.9, -11.30088653167},     {70, 0.5, 5e-4, 13.78, -2.738760361655},
                                 {70, 6, 5e-4, 15, 0.03609814749249},      {150, 2, 3.8e-4, 12.8, -8.447750720768},
                                 {500, 0.5, 2e-4, 15.16, -1.320293552207}, {500, 0.5, 2e-4, 40, -0.426653521774},
                                 {500, 1, 2e-4, 9, 48.52125572634}};
  for (const Row& row : rows) {
    CAPTURE(row.kilodalton, row.concentration, row.distance);
    const Shipped potential = physical(row.kilodalton, row.concentration, row.second_virial);
    CHECK(potential.energy(row.distance) == Approx(row.energy).epsilon(2e-9));
  }
}

TEST_CASE("the well grows and shrinks again with the concentration and is gone at 8 g/dL") {
  struct Dextran {
    double kilodalton, second_virial;
  };
  for (const Dextran dextran : {Dextran{70, 5e-4}, Dextran{150, 3.8e-4}, Dextran{500, 2e-4}}) {
    CAPTURE(dextran.kilodalton);
    std::vector<double> depth;
    for (double c = 0.25; c < 6.3; c += 0.25) {
      depth.push_back(-deepest(physical(dextran.kilodalton, c, dextran.second_virial)).energy);
    }
    const auto most = std::max_element(depth.begin(), depth.end());
    CHECK(std::is_sorted(depth.begin(), most));
    CHECK(std::is_sorted(most, depth.end(), std::greater<>()));
    CHECK(*most > 5);
    CHECK(depth.front() < 0.25 * *most);
    CHECK(depth.back() < 0.25 * *most);
    CHECK(deepest(physical(dextran.kilodalton, 8, dextran.second_virial)).energy > -1e-12);
  }
}

TEST_CASE("the electrostatic energy and its force go smoothly through one and two glycocalyx thicknesses") {
  const Shipped potential = physical(70, 3, 5e-4);
  for (const double at : {5.0, 10.0}) {
    CAPTURE(at);
    constexpr double h = 1e-6;  // nm; over 2 h the energy changes by force and the force by stiffness times 2 h
    const Values sides = potential({at - h, at + h});
    CHECK(sides.energy[0] - sides.energy[1] == Approx(2 * h * sides.slope[1]).epsilon(1e-4));
    CHECK(std::abs(sides.slope[0] - sides.slope[1]) <
          1.01 * h * (std::abs(sides.slope_by_argument[0]) + std::abs(sides.slope_by_argument[1])));
  }
  // At two thicknesses even the stiffness is continuous, at one the formula breaks off and its continuation begins.
  const Values sides = potential({10 - 1e-6, 10 + 1e-6});
  CHECK(sides.slope_by_argument[0] == Approx(sides.slope_by_argument[1]).epsilon(1e-5));
}

TEST_CASE("depletion repels from the well all the way to contact, ever more below one glycocalyx thickness") {
  for (const double concentration : {0.1, 1.0, 3.0, 6.0, 10.0}) {
    CAPTURE(concentration);
    const Shipped potential = physical(70, concentration, 5e-4);
    double inner = 0;
    for (double d = 0; d < 10.9; d += 0.01) REQUIRE(potential.slope(d) > 0);
    for (double d = 5; d >= 0; d -= 0.01) {
      REQUIRE(potential.slope(d) > inner);
      inner = potential.slope(d);
    }
  }
}

TEST_CASE("beyond its range depletion has ended by itself") {
  const Shipped potential = physical(70, 3, 5e-4);
  const double depth = -deepest(potential).energy;
  CHECK(potential.cutoff() < 60);
  CHECK(std::abs(potential.energy(potential.cutoff())) < 1e-14 * depth);
  CHECK(std::abs(potential.slope(potential.cutoff())) < 1e-14 * depth);
}

TEST_CASE("depletion does not depend on the units of the lattice") {
  const Shipped nano = physical(150, 2, 3.8e-4);
  // Spacing 0.196 um, step 4e-7 s, fluid of density 3000 x 1 g/cm3.
  const double length = 0.196e-6, time = 4e-7, mass = 3e6 * length * length * length, energy = mass / (time * time);
  const Shipped lattice(*open_depletion(0), dextran(150, 2, 3.8e-4, 0, length, time, mass));
  for (const double nm : {2.0, 7.0, 12.8, 20.0}) {
    CAPTURE(nm);
    CHECK(1e6 * energy * lattice.energy(nm * 1e-9 / length) == Approx(nano.energy(nm)).epsilon(1e-11));
  }
}

TEST_CASE("the regularised form is a Morse potential of the physical depth at the given place and width") {
  const double depth = -deepest(physical(70, 3, 5e-4)).energy;
  const Shipped regularised(*open_depletion(0), dextran(70, 3, 5e-4, 1));
  // The grid's own point is at most half a grid step from the minimum: 4e4 uJ/m2/nm2 x (5e-4 nm)^2/2 too high at most.
  CHECK(-regularised.energy(490) == Approx(depth).epsilon(1e-3));
  CHECK(std::abs(regularised.slope(490)) < 1e-12);
  CHECK(regularised.cutoff() == Approx(3520));
  const Shipped morse(
      *open_morse(0),
      {{{"depth", -regularised.energy(490)}, {"decay", 3.84e-3}, {"zero_force_distance", 490}, {"cutoff", 3520}}});
  for (const double nm : {50.0, 300.0, 490.0, 800.0, 3000.0}) {
    CHECK(regularised.energy(nm) == Approx(morse.energy(nm)).epsilon(1e-12));
    CHECK(regularised.slope(nm) == Approx(morse.slope(nm)).margin(1e-15).epsilon(1e-12));
  }
}

TEST_CASE("depletion refuses a polymer that would press the cells into each other, and a well that is not there") {
  CHECK(refusal(dextran(70, 20, 5e-4, 0)).find("osmotic pressure") != std::string::npos);
  CHECK(refusal(dextran(70, 8, 5e-4, 1)).find("no well") != std::string::npos);
}
