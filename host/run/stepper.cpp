#include "stepper.hpp"

#include <omp.h>

#include <exception>
#include <optional>
#include <set>
#include <string>

#include "base/signal_stack.hpp"

namespace rouleau::run {

/// One of the threads that take a step together.
class Stepper::Crew {
 public:
  Crew(const core::StepPasses& passes, Worker worker, core::Barrier& barrier, long step, PassCosts* costs)
      : passes_(passes),
        worker_(worker),
        barrier_(barrier),
        costs_(costs),
        clock_(costs != nullptr ? passes.passes.size() : 0),
        counted_(step) {}

  [[nodiscard]] const core::StepPasses& passes() const { return passes_; }
  [[nodiscard]] bool first() const { return worker_.first(); }
  void run(std::size_t first, std::size_t last) {
    passes_.run(first, last, worker_, barrier_, costs_ != nullptr ? &clock_ : nullptr);
  }
  /// The first thread acts, the others wait.
  template <class Action>
  void alone(Action action) {
    barrier_.arrive_and_wait();
    if (worker_.first()) action();
    barrier_.arrive_and_wait();
    clock_.resume();
  }
  /// What passes have taken in the steps before this one goes to the costs, if somebody wants them.
  void count(long step) {
    if (costs_ == nullptr) return;
    std::size_t at = 0;
    std::set<std::string> counted;  // a pass may have several phases
    for (const core::Pass& pass : passes_.passes)
      costs_->add(pass.name, clock_.take(at++), counted.insert(pass.name).second ? step - counted_ : 0);
    counted_ = step;
  }

 private:
  const core::StepPasses& passes_;
  Worker worker_;
  core::Barrier& barrier_;
  PassCosts* costs_;
  core::PassClock clock_;
  long counted_;  ///< steps before this one have been
};

long Stepper::take(const core::StepPasses& passes, long step, long last, int threads, PassCosts* costs) {
  std::exception_ptr trouble;
  std::optional<core::Barrier> barrier;
  long next = step;
  asked_for_.store(never, std::memory_order_relaxed);
#pragma omp parallel num_threads(threads)
  {
    // The system may grant fewer threads than were asked for.
#pragma omp single
    barrier.emplace(omp_get_num_threads());
    thread_local const SignalStack stack;
    try {
      Crew crew(passes, {omp_get_thread_num(), omp_get_num_threads()}, *barrier, step, costs);
      const long reached = work(crew, step, last);
      if (crew.first()) next = reached;
    } catch (const core::Barrier::Abandoned&) {
      // The worker that has given up says why.
    } catch (...) {
      if (barrier->abandon()) trouble = std::current_exception();
    }
  }
  if (trouble) std::rethrow_exception(trouble);
  return next;
}

void Stepper::compute_forces(const core::StepPasses& passes, long step) {
  if (known_) return;
  core::Barrier nobody(1);
  Crew crew(passes, Worker{}, nobody, step, nullptr);
  if (!begin_step(crew, step, step >= next_)) return;
  crew.run(passes.rows, passes.observable);
  known_ = true;
}

/// Up to the passes over rows.
bool Stepper::begin_step(Crew& crew, long step, bool attended) {
  if (attended) {
    crew.alone([&] {
      crew.count(step);
      asked_for_.store(never, std::memory_order_relaxed);
      goes_on_ = hooks_.before_forces(step);
    });
    if (!goes_on_) return false;
  }
  crew.run(0, crew.passes().rows);
  if (hooks_.adds_forces()) crew.alone([&] { hooks_.add_forces(); });
  return true;
}

/// All workers run the same passes; what needs one of them alone happens before or after the forces of a step, and only
/// when something is due.
long Stepper::work(Crew& crew, long step, long last) {
  const core::StepPasses& passes = crew.passes();
  const std::size_t all = passes.passes.size();
  bool known = known_;
  for (; step < last; ++step) {
    const bool attended = step >= next_ || step >= asked_for_.load(std::memory_order_relaxed);
    if (!known && !begin_step(crew, step, attended)) break;
    if (attended || hooks_.wants_a_look()) {
      if (!known) crew.run(passes.rows, passes.observable);
      known = true;
      crew.alone([&] { goes_on_ = hooks_.after_forces(step, attended); });
      if (!goes_on_) break;
    }
    crew.run(known ? passes.observable : passes.rows, all);
    known = false;
    if (crew.first() && step + 2 < asked_for_.load() && hooks_.wants_attention(step))
      asked_for_.store(step + 2, std::memory_order_relaxed);  // when every worker has passed a barrier since
  }
  crew.alone([&] {
    known_ = known;
    crew.count(step);
  });
  return step;
}

}  // namespace rouleau::run
