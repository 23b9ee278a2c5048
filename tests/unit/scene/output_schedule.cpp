// When something is due between two steps.
#include "scene/output_schedule.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace rouleau;
using namespace rouleau::scene;

TEST_CASE("the next step of a schedule is the first one that is due") {
  scene::StageSetting setting{};
  setting.units.time = 1;
  setting.shear_rate = 1;
  setting.max_steps = 1000;
  Cadence cadence;
  const double interval = GENERATE(1.0, 1.4, 1.5, 2.5, 7.3, 100.0);
  cadence.seconds = interval;
  if (interval == 7.3) cadence.strain = 4.9;
  const scene::OutputSchedule schedule(cadence, setting, true);
  long next = schedule.next(0);
  for (long step = 1; step < 1000; ++step) {
    CAPTURE(interval, step);
    REQUIRE(schedule.due(step) == (step == next));
    if (step == next) next = schedule.next(step);
  }
}

TEST_CASE("a schedule without an interval is never due again") {
  scene::StageSetting setting{};
  setting.max_steps = 1000;
  CHECK(scene::OutputSchedule(Cadence{}, setting, true).next(0) == std::numeric_limits<long>::max());
}
