// Constants of the plan that are known from elsewhere.
#include "plan/constants.hpp"

#include <catch2/catch.hpp>

using rouleau::plan::kernel_named;

TEST_CASE("the cosine kernel alone has a first moment, as large as the test of kernels finds it") {
  CHECK(kernel_named("cosine4").first_moment == Approx(0.0211));  // tests/unit/coupling/kernels.cpp
  for (const char* name : {"peskin4", "roma3", "linear2", "sharp6"}) CHECK(kernel_named(name).first_moment == 0);
}
