#include <catch2/catch.hpp>
#include <string>

#include "units/dimension_names.hpp"
#include "units/units.hpp"

using Catch::Matchers::Contains;
using rouleau::units::Dimension;
using rouleau::units::UnitError;
using rouleau::units::Units;

namespace {

/// Conversions multiply a handful of factors, each rounded once.
Approx about(double value) { return Approx(value).epsilon(16 * std::numeric_limits<double>::epsilon()).scale(0); }

}  // namespace

TEST_CASE("every unit string of the contract's scene has its value in SI") {
  const Units units;
  CHECK(units.to_si("50.176 um", "m", "x") == about(50.176e-6));
  CHECK(units.to_si("1 g/cm3", "kg/m3", "x") == about(1000));
  CHECK(units.to_si("1.2 cP", "Pa s", "x") == about(1.2e-3));
  CHECK(units.to_si("6e-3 dyn/cm", "N/m", "x") == about(6e-6));
  CHECK(units.to_si("3.6e-12 dyn cm", "J", "x") == about(3.6e-19));
  CHECK(units.to_si("90 deg", "rad", "x") == about(1.5707963267948966));
  CHECK(units.to_si("5.2e-8 J/m2", "J/m2", "x") == about(5.2e-8));
  CHECK(units.to_si("3.84 1/um", "1/m", "x") == about(3.84e6));
  CHECK(units.to_si("7 s", "s", "x") == 7.0);
  CHECK(units.to_si("20 1/s", "1/s", "x") == 20.0);
}

TEST_CASE("units of the field and ways of writing them are understood") {
  const Units units;
  CHECK(units.scale("dyn cm") == about(1e-7));
  CHECK(units.scale("uJ/um2") == about(1e6));
  CHECK(units.scale("N s/m") == 1.0);
  CHECK(units.scale("cm3 mol/g2") == about(1.0));
  CHECK(units.scale("1/cm") == about(100));
  CHECK(units.scale("P") == about(0.1));
  CHECK(units.scale("Pa") == 1.0);
  CHECK(units.scale("kDa") == about(1.66053906660e-24));
  CHECK(units.scale("Da") == about(1.66053906660e-27));
  CHECK(units.scale("g/dL") == about(10));
  CHECK(units.scale("1 / um") == about(1e6));
  CHECK(units.scale("um^-1") == about(1e6));
  CHECK(units.scale("s-1") == 1.0);
  CHECK(units.scale("m**2") == 1.0);
  CHECK(units.scale("J/(mol K)") == 1.0);
  CHECK(units.scale("\xC2\xB5m") == about(1e-6));
  CHECK(units.scale("m\xC2\xB2\xC2\xB7s") == 1.0);
  CHECK(units.scale("N-m") == 1.0);
  CHECK(units.scale("cmH2O") == Approx(98.0665).epsilon(1e-4));
  CHECK(units.scale("J/degC") == 1.0);
  CHECK(units.scale("1") == 1.0);
  CHECK(units.to_si("10um", "m", "x") == about(1e-5));
  CHECK(units.to_si("  +10\tum ", "m", "x") == about(1e-5));
  CHECK(units.to_si("0.1875", "1", "x") == 0.1875);
  CHECK(units.to_si("45 %", "1", "x") == about(0.45));
}

TEST_CASE("dimensions are exponents of kg, m, s, K, mol and A, and angles have none") {
  const Units units;
  CHECK(units.dimension("dyn/cm") == Dimension{{1, 0, -2, 0, 0, 0}});
  CHECK(units.dimension("J/m2") == units.dimension("N/m"));
  CHECK(units.dimension("cm3 mol/g2") == Dimension{{-2, 3, 0, 0, 1, 0}});
  CHECK(units.dimension("C/m2") == Dimension{{0, -2, 1, 0, 0, 1}});
  CHECK(units.dimension("J/K") == Dimension{{1, 2, -2, -1, 0, 0}});
  CHECK(units.dimension("deg") == Dimension{});
  CHECK(units.dimension("rad/s") == units.dimension("1/s"));
}

TEST_CASE("a quantity of the wrong kind says what it is and what is wanted") {
  const Units units;
  CHECK_THROWS_WITH(units.to_si("6 Pa", "N/m", "shear_modulus"),
                    "\"6 Pa\" is a pressure; shear_modulus wants N/m (for example \"6e-6 N/m\" or \"6e-3 dyn/cm\")");
  CHECK_THROWS_WITH(units.to_si("6 um2", "m", "radius"), Contains("is an area; radius wants m"));
  CHECK_THROWS_WITH(units.to_si("6 N/m", "J", "modulus"),
                    Contains("is a surface tension or an energy per area; modulus wants J"));
  CHECK_THROWS_WITH(units.to_si("6 J", "J/m2", "depth"),
                    Contains("is an energy; depth wants J/m2 (for example \"5.2e-8 J/m2\""));
  CHECK_THROWS_WITH(units.to_si("2", "m", "radius"), Contains("has no unit"));
  CHECK_THROWS_WITH(units.to_si("2 m", "1", "magic"), Contains("is a length; magic wants a plain number"));
  CHECK_THROWS_WITH(units.to_si("2 kg3", "m", "radius"), Contains("is of the dimension kg3"));
}

TEST_CASE("the unit that is suggested has the wanted dimension where one is near") {
  const Units units;
  CHECK_THROWS_WITH(units.to_si("1.2 mPas", "Pa s", "viscosity"), Contains("\"mPas\" (did you mean \"mPa s\"?)"));
  CHECK_THROWS_WITH(units.to_si("1.2 mPas", "Pa", "pressure"), Contains("\"mPas\" (did you mean \"mPa\"?)"));
  CHECK_THROWS_WITH(units.to_si("1 gcm3", "kg/m3", "density"), Contains("\"gcm3\" (did you mean \"g/cm3\"?)"));
  CHECK_THROWS_WITH(units.to_si("70 kDA", "N/m", "modulus"), Contains("\"kDA\" (did you mean \"kDa\"?)"));
}

TEST_CASE("an unknown symbol is named, with the nearest that is known") {
  const Units units;
  CHECK_THROWS_WITH(units.scale("dyne/cmm"), Contains("unknown unit \"cmm\" (did you mean \"cm\"?)"));
  CHECK_THROWS_WITH(units.scale("Ns/m"), Contains("unknown unit \"Ns\""));
  CHECK_THROWS_WITH(units.scale("xyzzy"), "unknown unit \"xyzzy\"");
}

TEST_CASE("a logarithmic unit is not possible, alone or within others") {
  const Units units;
  for (const char* unit : {"dBZ", "m dBZ", "m(BZ)s", "N/(m dBm)"}) {
    CHECK_THROWS_WITH(units.scale(unit), Contains(unit) && Contains(" is not possible: "));
  }
  CHECK(units.scale("N/(m per s)") == 1);
}

TEST_CASE("every unit that is suggested is known, and every example has its unit's dimension") {
  const Units units;
  for (const auto symbol : rouleau::units::usual_units()) {
    INFO(symbol);
    CHECK_NOTHROW(units.dimension(symbol));
  }
  for (const char* unit :
       {"1",     "rad", "deg",   "m",      "m2",     "m3",         "1/m", "s",    "1/s",  "m/s", "m/s2",
        "m2/s",  "kg",  "kg/m3", "N",      "N/m",    "J/m2",       "Pa",  "Pa/m", "N/m3", "J",   "Pa s",
        "N s/m", "K",   "mol",   "mol/m3", "kg/mol", "m3 mol/kg2", "A",   "C",    "C/m2"}) {
    const auto words = rouleau::units::wanted_unit(unit, units.dimension(unit));
    CHECK_THAT(words, Contains("(for example"));
    for (auto at = words.find('"'); at != std::string::npos;) {
      const auto end = words.find('"', at + 1);
      INFO(words);
      CHECK_NOTHROW(units.to_si(words.substr(at + 1, end - at - 1), unit, "x"));
      at = words.find('"', end + 1);
    }
  }
}

TEST_CASE("a slip of the pen is no unit") {
  const Units units;
  for (const char* text :
       {"3 10 um", "3 um 2",      "3 2e-3 N/m", "6-3 dyn/cm", "3 um m -1", "3 K @ 5",    "3 10/um",   "3 (m",
        "3 m)",    "3 m--2",      "3 m s)",     "3 /",        "3 m 3 s",   "3 m.2",      "3 1e400 m", "3 m99999999999",
        "3 m 0s",  "1 e1-0z3201", "1 m-0s",     "1 m^s",      "1 m^-",     "1 m from s", "1 m * / s", "1 m after"}) {
    INFO(text);
    CHECK_THROWS_AS(units.to_si(text, "m", "x"), UnitError);
  }
  CHECK_THROWS_AS(units.to_si("3 " + std::string(100000, 'm'), "m", "x"), UnitError);
  CHECK_THROWS_AS(units.to_si("3 " + std::string(90, '('), "m", "x"), UnitError);
  CHECK_THROWS_AS(units.to_si(std::string("3 m\0m", 5), "m", "x"), UnitError);
}

TEST_CASE("shifted, logarithmic and other unfit units are refused with the reason") {
  const Units units;
  CHECK_THROWS_WITH(units.scale("degC"), Contains("its zero is shifted; use K"));
  CHECK_THROWS_WITH(units.scale("lg(re mW)"), Contains("logarithmic"));
  CHECK_THROWS_WITH(units.scale("s since 1990-01-01"), Contains("is no unit"));
  CHECK_THROWS_WITH(units.scale("cd"), Contains("only kg, m, s, K, mol, A"));
  CHECK(units.to_si("25 degC", "K", "temperature") == about(298.15));
  CHECK(units.to_si("77 degF", "K", "temperature") == Approx(298.15).epsilon(1e-12));
}

TEST_CASE("numbers that are not finite are refused") {
  const Units units;
  for (const char* text : {"nan m", "inf m", "-inf m", "1e999 m", "1e308 Mm", "infinity um", "m", "", " ", "-"}) {
    INFO(text);
    CHECK_THROWS_AS(units.to_si(text, "m", "x"), UnitError);
  }
}
