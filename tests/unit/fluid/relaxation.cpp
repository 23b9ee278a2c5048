// Relaxation time, viscosity and the step in seconds.
#include "core/fluid/relaxation.hpp"

#include <catch2/catch.hpp>

using namespace rouleau::core;

TEST_CASE("a relaxation time of one step is a viscosity of a sixth, and of half a step none") {
  CHECK(viscosity_of(1) == Approx(1.0 / 6));
  CHECK(viscosity_of(0.5) == 0);
}

TEST_CASE("a viscosity's relaxation time has that viscosity") {
  for (const double viscosity : {1e-6, 0.01, 1.0 / 6, 2.5}) {
    CHECK(viscosity_of(relaxation_time_of(viscosity)) == Approx(viscosity).epsilon(1e-9));
  }
}

TEST_CASE("in a step of that many seconds the lattice has the fluid's viscosity") {
  const double spacing = 0.2e-6, plasma = 1.2e-6, step = time_step(0.8, spacing, plasma);
  CHECK(viscosity_of(0.8) * spacing * spacing / step == Approx(plasma));
}
