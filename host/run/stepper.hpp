// The loop over the steps of a stage, by any number of threads: of the program and of Python.
#pragma once

#include <atomic>
#include <limits>

#include "core/solver/pass.hpp"
#include "run_state.hpp"

namespace rouleau::run {

/// What a run does between the passes of its steps. One thread calls each hook while the others wait, unless it says
/// otherwise; what one throws ends the loop.
class StepHooks {
 public:
  virtual ~StepHooks() = default;
  /// Before the forces of a step that somebody attends to. False: the step is not taken, and the loop ends. Cells may
  /// come and go here, with a solver that the next loop is given.
  virtual bool before_forces(long step) = 0;
  /// Whether add_forces() is called in every step; all threads ask, and must get the same.
  [[nodiscard]] virtual bool adds_forces() const { return false; }
  /// The models' forces are on the nodes, and nothing has been spread yet.
  virtual void add_forces() {}
  /// Forces computed: the state may be observed. Called where somebody attends to the step, or wants a look. False: the
  /// loop ends here.
  virtual bool after_forces(long step, bool attended) = 0;
  /// Whether the last step must not be followed by another unseen; all threads ask, and must get the same.
  [[nodiscard]] virtual bool wants_a_look() const = 0;
  /// Behind a step, which the others may have left: whether somebody wants to attend to another one soon.
  [[nodiscard]] virtual bool wants_attention(long) { return false; }
};

/// Takes the steps of whichever solver it is given.
class Stepper {
 public:
  static constexpr long never = std::numeric_limits<long>::max();

  explicit Stepper(StepHooks& hooks) : hooks_(hooks) {}

  /// Another solver, or another state of it, is given next, from this step on: somebody attends to it, and no forces
  /// are known.
  void begin(long step) {
    next_ = step;
    known_ = false;
  }
  /// The next step that somebody attends to whatever happens; none before it.
  void attend_next(long step) { next_ = step; }
  /// Takes steps from `step` on, with so many threads, until `last` is reached or a hook ends it; returns the step that
  /// comes next. `costs`: what the passes take goes there, up to each attended step; null: nowhere.
  long take(const core::StepPasses& passes, long step, long last, int threads, PassCosts* costs = nullptr);
  /// The first half of a step, by this thread alone, if that has not been done: take() goes on from there.
  void compute_forces(const core::StepPasses& passes, long step);
  /// Whether the forces of the next step are computed.
  [[nodiscard]] bool forces_known() const { return known_; }

 private:
  class Crew;
  long work(Crew& crew, long step, long last);
  bool begin_step(Crew& crew, long step, bool attended);

  StepHooks& hooks_;
  long next_ = 0;                       ///< attended to
  std::atomic<long> asked_for_{never};  ///< step that somebody has asked to attend to
  bool goes_on_ = true;                 ///< what a hook has answered
  bool known_ = false;
};

}  // namespace rouleau::run
