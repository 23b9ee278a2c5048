#include "step_time.hpp"

#include "base/stopwatch.hpp"
#include "engine.hpp"
#include "scene/dimension_words.hpp"
#include "stepper.hpp"

namespace rouleau::run {

namespace {

/// Nothing is looked at, and nothing ends.
class NoHooks final : public StepHooks {
 public:
  bool before_forces(long) override { return true; }
  bool after_forces(long, bool) override { return true; }
  [[nodiscard]] bool wants_a_look() const override { return false; }
};

template <int D>
StepTime measure(const plan::Plan& plan, const plan::Estimate& estimate, int threads) {
  constexpr double enough_s = 1;
  constexpr long most_steps = 20000;  // of a scene so small that more say nothing
  observe::Observer observer(*plan.scene);
  Engine<D> engine(plan);
  engine.begin(engine.place_cells(observer));
  NoHooks hooks;
  Stepper stepper(hooks);
  stepper.begin(0);
  const core::StepPasses& passes = engine.solver().passes();
  StepTime time{.threads = threads, .steps = stepper.take(passes, 0, 1, threads)};  // the first one makes lists
  const Stopwatch all;
  for (long batch = 2; time.steps < 3 || (all.seconds() < enough_s && time.steps < most_steps);) {
    const Stopwatch watch;
    time.steps = stepper.take(passes, time.steps, time.steps + batch, threads);
    if (watch.seconds() < enough_s / 10) batch *= 2;
  }
  time.step_s = all.seconds() / static_cast<double>(time.steps - 1);
  stepper.compute_forces(passes, time.steps);
  const scene::StageSetting& stage = plan.stages.front();
  for (int k = 0; k < 2; ++k) {  // the first one finds what walls are made of
    const Stopwatch watch;
    static_cast<void>(observer.observe(engine.solver(), stage, false));
    time.output_s = watch.seconds();
  }
  time.wall_s = estimate.steps * time.step_s + estimate.output.outputs * time.output_s;
  return time;
}

}  // namespace

StepTime measure_steps(const plan::Plan& plan, const plan::Estimate& estimate, int threads) {
  return scene::in_dimension(plan.scene->domain.dimension(), [&]<int D>(std::integral_constant<int, D>) {
    return measure<D>(plan, estimate, threads);
  });
}

}  // namespace rouleau::run
