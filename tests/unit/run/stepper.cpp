// The loop over the steps: which hook is called when, by any number of threads.
#include "run/stepper.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace rouleau;

namespace {

/// Passes "forces", "spread" and "fluid", of which the first worker notes that it was there.
class Loop final : public run::StepHooks {
 public:
  Loop() {
    passes.rows = 1, passes.observable = 2;
    passes.bands = [] { return core::RowBands{}; };
    for (const char* name : {"forces", "spread", "fluid"}) {
      passes.passes.push_back({.name = name, .run = [this, name](Worker worker) {
                                 if (worker.first()) said.emplace_back(name);
                               }});
      passes.names.emplace_back(name);
    }
  }
  bool before_forces(long step) override {
    said.push_back("before " + std::to_string(step));
    return step != refused;
  }
  [[nodiscard]] bool adds_forces() const override { return adds; }
  void add_forces() override { said.emplace_back("add"); }
  bool after_forces(long step, bool attended) override {
    said.push_back((attended ? "after " : "look at ") + std::to_string(step));
    stepper.attend_next(step + 2);
    return step != last;
  }
  [[nodiscard]] bool wants_a_look() const override { return looks; }

  core::StepPasses passes;
  run::Stepper stepper{*this};
  std::vector<std::string> said;
  long refused = -1, last = -1;
  bool adds = false, looks = false;
};

using Said = std::vector<std::string>;

}  // namespace

TEST_CASE("attended steps stop before and after their forces, others run through") {
  for (const int threads : {1, 2, 3}) {
    CAPTURE(threads);
    Loop loop;
    run::PassCosts costs;
    CHECK(loop.stepper.take(loop.passes, 0, 2, threads, &costs) == 2);
    CHECK(loop.said == Said{"before 0", "forces", "spread", "after 0", "fluid", "forces", "spread", "fluid"});
    REQUIRE(costs.passes().size() == 3);
    for (const run::PassCost& cost : costs.passes()) CHECK(cost.calls == 2);
  }
}

TEST_CASE("a hook ends the loop before the forces of a step, or when they are known") {
  Loop loop;
  loop.refused = 2;
  CHECK(loop.stepper.take(loop.passes, 0, run::Stepper::never, 2) == 2);
  CHECK_FALSE(loop.stepper.forces_known());
  CHECK(loop.said.back() == "before 2");
  loop.refused = -1, loop.last = 4;
  CHECK(loop.stepper.take(loop.passes, 2, run::Stepper::never, 2) == 4);
  CHECK(loop.stepper.forces_known());
  CHECK(loop.said.back() == "after 4");
}

TEST_CASE("forces that are known are not computed again, and a caller may add to them") {
  Loop loop;
  loop.adds = loop.looks = true;
  loop.stepper.compute_forces(loop.passes, 0);
  loop.stepper.compute_forces(loop.passes, 0);
  CHECK(loop.said == Said{"before 0", "forces", "add", "spread"});
  loop.said.clear();
  CHECK(loop.stepper.take(loop.passes, 0, 2, 2) == 2);
  CHECK(loop.said == Said{"after 0", "fluid", "forces", "add", "spread", "look at 1", "fluid"});
}

TEST_CASE("forces that are known are not computed again, but for another solver") {
  for (const bool another : {false, true}) {
    CAPTURE(another);
    Loop loop;
    loop.last = 0;  // the loop ends behind the forces of step 0
    CHECK(loop.stepper.take(loop.passes, 0, 2, 2) == 0);
    CHECK(loop.stepper.forces_known());
    loop.said.clear();
    loop.last = -1;
    if (another) loop.stepper.begin(0);
    CHECK(loop.stepper.take(loop.passes, 0, 1, 2) == 1);
    CHECK(loop.said == (another ? Said{"before 0", "forces", "spread", "after 0", "fluid"} : Said{"fluid"}));
  }
}
