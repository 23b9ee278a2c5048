// When aggregates come apart.
#include "study/quantity.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rouleau;
using namespace rouleau::study;

TEST_CASE("aggregates come apart in the sheared stage at the first output that finds enough of them", "[history]") {
  // At rest: 4, then 1 by time 2; shear from time 3; 3 at strain 8.75, 4 at 10, 3 once more at 12.5, 4 again at 13.
  const std::vector<CountChange> changes{{0, 0, 4},    {2, 0, 1},      {3.4, 8.75, 3},
                                         {3.5, 10, 4}, {3.6, 12.5, 3}, {3.7, 13, 4}};
  Column outputs;
  for (int i = 0; i <= 60; ++i) outputs.push_back(0.25 * i);
  const Dissociation first = dissociation(changes, outputs, 3, 0, 4, false);
  CHECK(first.strain == 10);
  CHECK(first.uncertainty == 0.25);
  CHECK(dissociation(changes, outputs, 3, 0, 3, false).strain == 8.75);
  CHECK(dissociation(changes, outputs, 3, 0, 4, true).strain == 13);
  CHECK(dissociation(changes, outputs, 3, 0, 3, true).strain == 8.75);
  CHECK(std::isnan(dissociation(changes, outputs, 3, 0, 5, false).strain));
  // Apart when shear begins already.
  const Dissociation apart = dissociation(changes, outputs, 1, 0, 4, false);
  CHECK(apart.at_start);
  CHECK(std::isnan(apart.strain));
}

TEST_CASE("strain is counted from the start of the sheared stage", "[history]") {
  const Dissociation d = dissociation({{0, 0, 1}, {5, 7, 2}}, {0, 3, 5, 7, 9}, 4, 3, 2, false);
  CHECK(d.strain == 4);
  CHECK(d.uncertainty == 2);
}
