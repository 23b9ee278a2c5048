// Error bars from values that are made up with a known truth.
#include "accuracy/error_bars.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "accuracy/measure_errors.hpp"

using namespace rouleau;
using namespace rouleau::accuracy;

namespace {

Quantity quantity(const std::string& name, double value) { return {.name = name, .value = value, .principal = true}; }

/// Companions of a run on a lattice with twice the spacing, and with half the density.
Companions three_companions() {
  Companions companions;
  companions.runs = {{Role::lattice, {}, "coarse", "", -1},
                     {Role::start, {}, "developed", "", 0},
                     {Role::inertia, {}, "light", "", 1}};
  companions.refinement = 2;
  companions.order = 2;
  companions.density = 0.5;
  companions.relaxed = 1;
  return companions;
}

std::vector<Measured> three_measured(const std::string& name, double lattice, double start, double inertia) {
  return {{Role::lattice, "coarse", {quantity(name, lattice)}},
          {Role::start, "developed", {quantity(name, start)}},
          {Role::inertia, "light", {quantity(name, inertia)}}};
}

}  // namespace

TEST_CASE("a bar holds an error of second order in the spacing, of the start, and in proportion to the density") {
  // truth + c h^2 + s (impulsive) + d f, with h = f = 1 in the run.
  const double truth = 0.4;
  for (const double c : {0.01, -0.003}) {
    for (const double s : {0.0, 0.02, -0.02}) {
      for (const double d : {0.0, 0.01, -0.02}) {
        const std::vector<ErrorBar> bars =
            error_bars({quantity("deformation", truth + c + s + d)}, three_companions(),
                       three_measured("deformation", truth + 4 * c + s + d, truth + 4 * c + d, truth + 4 * c + d / 2));
        REQUIRE(bars.size() == 1);
        CHECK(bars[0].shares.lattice == Approx(c).margin(1e-12));
        CHECK(bars[0].shares.start == Approx(s).margin(1e-12));
        CHECK(bars[0].shares.inertia == Approx(d).margin(1e-12));
        REQUIRE(bars[0].error);
        CHECK(*bars[0].error >= std::abs(c + s + d));
        CHECK(*bars[0].error <= 1.5 * (std::abs(c) + std::abs(s)) + 2 * std::abs(d) + 1e-12);
      }
    }
  }
}

TEST_CASE("the share of the density is that of an error in proportion, of a denser companion that of a power of 0.7") {
  Companions companions = three_companions();
  const auto share = [&](double density, double power) {
    companions.density = density;
    companions.runs = {{Role::lattice, {}, "coarse", "", -1}, {Role::inertia, {}, "other", "", 0}};
    const double companion = 1 + 0.01 * std::pow(density, power);
    return error_bars({quantity("deformation", 1.01)}, companions,
                      {{Role::lattice, "coarse", {quantity("deformation", 1.01)}},
                       {Role::inertia, "other", {quantity("deformation", companion)}}})[0]
        .shares.inertia;
  };
  CHECK(share(0.5, 1) == Approx(0.01));
  CHECK(share(0.8, 1) == Approx(0.01));
  CHECK(share(2, 0.7) == Approx(0.01));
  CHECK(share(2, 1) > 0.01);
}

TEST_CASE("two coarser lattices find an error of second and fourth order, and one of fourth alone") {
  const double r = 1.6, s = 2;
  const auto share = [&](double second, double fourth) {
    const auto at = [&](double h) { return 0.3 + second * h * h + fourth * std::pow(h, 4); };
    return lattice_share(at(1), at(r), r, at(s), s, 2, 2);
  };
  for (const auto& [second, fourth] :
       {std::pair{0.01, 0.0}, {0.01, 0.01}, {0.0, 0.01}, {-0.01, -0.002}, {0.01, -0.001}}) {
    CHECK(share(second, fourth).error == Approx(second + fourth));
    CHECK(share(second, fourth).doubt >= 0.5 * std::abs(second + fourth) * (1 - 1e-9));
  }
  // One coarser lattice alone takes all for the second order.
  const double alone = lattice_share(0.31, 0.3 + 0.01 * std::pow(r, 4), r, std::nan(""), 1, 2, 2).error;
  CHECK(alone > 2 * 0.01);
}

TEST_CASE("values that turn back on the coarsest lattice leave a doubt of their distance") {
  const LatticeShare share = lattice_share(6.074, 6.093, 1.7, 6.051, 2, 2, 2);
  CHECK(share.error == Approx(0.019 / (1.7 * 1.7 - 1)));
  CHECK(share.doubt == Approx(0.023 / (1.7 * 1.7 - 1)));
  CHECK(lattice_share(1, 1, 1.7, 1.2, 2, 2, 2).error == 0);
}

TEST_CASE("where the order does not show it is the usual one, and the bar holds the lower one") {
  const double r = 2, error = 0.01, change = 0.01 * (r * r * r - 1);
  for (const LatticeShare& share :
       {lattice_share(1 + error, 1 + error + change, r, std::nan(""), 1, 2, 3),
        lattice_share(1 + error, 1 + error + change, r, 1 + error + change / 2, 2.5, 2, 3)}) {
    CHECK(share.error == Approx(error));
    CHECK(share.error + share.doubt >= change / (r * r - 1) * (1 - 1e-9));
  }
}

TEST_CASE("a quantity that the companion for the order does not have has a bar without it") {
  Companions companions = three_companions();
  companions.runs = {{Role::lattice, {}, "coarse", "", -1}, {Role::order, {}, "coarser", "", -1}};
  companions.coarsest = 2.5;
  const auto bars = error_bars({quantity("passage_strain_-90_deg", 1.01)}, companions,
                               {{Role::lattice, "coarse", {quantity("passage_strain_-90_deg", 1.04)}},
                                {Role::order, "coarser", {quantity("deformation", 0.3)}}});
  REQUIRE(bars[0].error);
  CHECK(bars[0].shares.lattice == Approx(0.01));
}

TEST_CASE("without slip correction the lattice's share is that of first order") {
  Companions companions = three_companions();
  companions.order = companions.usual_order = 1;
  const auto bars = error_bars({quantity("deformation", 1.01)}, companions,
                               {{Role::lattice, "coarse", {quantity("deformation", 1.02)}}});
  CHECK(bars[0].shares.lattice == Approx(0.01));
}

TEST_CASE("a value that happens to be the same on both lattices has a bar by the deformation's error") {
  Quantity viscosity{.name = "relative_viscosity", .value = 1.08, .part_of_cells = 0.08};
  const auto bars = error_bars({quantity("deformation", 1.01), viscosity}, three_companions(),
                               {{Role::lattice, "coarse", {quantity("deformation", 1.04), viscosity}}});
  REQUIRE(bars.size() == 2);
  REQUIRE(bars[1].error);
  CHECK(*bars[1].error == Approx(0.75 * 0.08 * 0.01 / 1.01));
}

TEST_CASE("what a companion does not have has no bar, and how says so") {
  const auto bars = error_bars({quantity("parted_strain_0+1", 9.5)}, three_companions(),
                               {{Role::lattice, "coarse", {quantity("deformation", 0.3)}}});
  CHECK_FALSE(bars[0].error);
  CHECK(bars[0].how.find("coarse") != std::string::npos);
  CHECK(to_json(bars)["parted_strain_0+1"]["error"].is_null());
}

TEST_CASE("a count is the same in the companions or differs by whole numbers, and other histories are told") {
  const auto count = [](double value) {
    return Quantity{.name = "aggregates", .value = value, .nature = Nature::count};
  };
  const auto same = error_bars({count(2)}, three_companions(), {{Role::lattice, "coarse", {count(2)}}});
  CHECK(*same[0].error == 0);
  const auto other = error_bars({quantity("deformation", 0.3), count(2)}, three_companions(),
                                {{Role::lattice, "coarse", {quantity("deformation", 0.3), count(4)}}});
  CHECK(*other[1].error == 2);
  CHECK(other[0].how.find("4 aggregates, not 2") != std::string::npos);
}

TEST_CASE("a moment that lies between two outputs widens the bar by what is not known of it") {
  Quantity event = quantity("parted_strain_0+1", 10);
  event.uncertainty = 0.25;
  const auto bars =
      error_bars({event}, three_companions(), {{Role::lattice, "coarse", {quantity("parted_strain_0+1", 10)}}});
  CHECK(*bars[0].error == Approx(0.25));
}

TEST_CASE("values are written to the digit of their error, which is rounded up") {
  CHECK(with_error(0.34719, 0.0039) == "0.347 +- 0.004");
  CHECK(with_error(0.34719, 0.0031) == "0.347 +- 0.004");
  CHECK(with_error(0.34719, 0.00151) == "0.3472 +- 0.0016");
  CHECK(with_error(30.258, 0.2) == "30.3 +- 0.2");
  CHECK(with_error(-11.8, 3.0) == "-12 +- 3");
  CHECK(with_error(1.2803e-5, 2e-8) == "(1.280 +- 0.002) x 1e-05");
  CHECK(with_error(2, 0) == "2 +- 0");
}

TEST_CASE("what is told first is told with its bar, an angle in degrees; the worst of it is the largest relative one") {
  Quantity deformation = quantity("deformation", 0.3), angle = quantity("angle_rad", 0.5);
  ErrorBar first{deformation, {}, 0.003, 0.004, ""}, second{angle, {}, 0.008, 0.01, ""};
  const std::vector<std::string> lines = sentences({first, second});
  REQUIRE(lines.size() == 2);
  CHECK(lines[0] == "deformation 0.300 +- 0.004");
  CHECK(lines[1] == "angle 28.6 +- 0.6 deg");
  const std::optional<Worst> found = worst({first, second});
  REQUIRE(found);
  CHECK(found->name == "deformation");
  CHECK(found->error == Approx(0.01));
  // Of what moves on, the moments count, not where it is at the end.
  ErrorBar passage{quantity("passage_strain_0_deg", 6), {}, 0.03, 0.04, ""};
  passage.quantity.moment = true;
  CHECK(worst({first, second, passage})->name == "passage_strain_0_deg");
  CHECK(worst({first, second, passage})->error == Approx(0.005));
  // A strain near 0 has no relative error of its own.
  ErrorBar early{quantity("passage_strain_0_deg", 0.1), {}, 0.06, 0.08, ""};
  early.quantity.moment = true, early.quantity.least_whole = 5;
  CHECK(worst({early})->error == Approx(0.012));
}

TEST_CASE("a refined target is smaller by what was measured over the target, and leaves out what no lattice mends") {
  plan::NumericsChoice choice;
  choice.target = 0.01;
  choice.expected = {0.005, 0.003, 0};
  CHECK(refined_target(choice, {0.02, "deformation", {0.02, 0, 0}, 0}) == Approx(0.8 * 0.008 / 2));
  CHECK(refined_target(choice, {0.025, "passage", {0.02, 0, 0}, 0.005}) == Approx(0.8 * 0.008 * 0.005 / 0.02));
  CHECK_FALSE(refined_target(choice, {0.025, "passage", {0.02, 0, 0}, 0.012}) > 0);
}

TEST_CASE("a summary keeps the worst error") {
  nlohmann::json choice = nlohmann::json::object();
  CHECK_FALSE(measured(choice));
  add_measured(choice, Worst{0.03, "deformation", {0.02, -0.001, 0.01}, 0.004});
  const std::optional<Worst> back = measured(choice);
  REQUIRE(back);
  CHECK(back->error == 0.03);
  CHECK(back->name == "deformation");
  CHECK(back->shares.lattice == 0.02);
  CHECK(back->shares.start == -0.001);
  CHECK(back->shares.inertia == 0.01);
  CHECK(back->uncertainty == 0.004);
  nlohmann::json pinned;
  add_measured(pinned, Worst{});
  CHECK(pinned.is_null());
}
