// Level "robustness": what a model does to the process it runs in.
#include <array>
#include <atomic>
#include <bit>
#include <cfenv>
#include <cmath>
#include <optional>
#include <thread>

#include "conform/allocation_count.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/subject.hpp"
#include "conform/syscall_trap.hpp"
#include "plugin/library.hpp"

namespace rouleau::conform {

namespace {

/// What decides how this thread computes: rounding, treatment of denormals, exceptions that trap.
struct FloatingPointMode {
  int rounding;
  std::uint64_t control;  ///< the processor's control registers, without the flags of past exceptions
  friend bool operator==(const FloatingPointMode&, const FloatingPointMode&) = default;
};

FloatingPointMode floating_point_mode() {
  std::uint64_t control = 0;
#if defined(__x86_64__)
  std::fenv_t environment;
  std::fegetenv(&environment);
  constexpr unsigned past_exceptions = 0x3f;
  control = (std::uint64_t{environment.__control_word} << 32) | (environment.__mxcsr & ~past_exceptions);
#elif defined(__aarch64__)
  asm("mrs %0, fpcr" : "=r"(control));
#endif
  return {std::fegetround(), control};
}

class ModeWatch : public CallWatch {
 public:
  bool changed = false;
  void before() override { mode_ = floating_point_mode(); }
  void after() override { changed = changed || floating_point_mode() != mode_; }

 private:
  FloatingPointMode mode_{};
};

Finding floating_point(const Subject& subject) {
  ModeWatch watch;
  const auto changed_by = [&](const auto& action) {
    watch.before();
    action();
    watch.after();
    return watch.changed;
  };
  rouleau_open_function open = nullptr;
  if (changed_by([&] { open = plugin::load_library(subject.manifest()); })) {
    return Finding::failed("loading it changes the floating-point mode (linked with -ffast-math?)");
  }
  if (changed_by([&] { open(ROULEAU_ABI_MINOR); })) return Finding::failed("rouleau_open_v1 changes the mode");
  if (changed_by([&] { const plugin::ModelInstance instance = subject.make(); }))
    return Finding::failed("create or destroy changes the mode");
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : subject.make_each_choice()) {
    Call call;
    call.watch = &watch;
    const Values inputs = subject.random_inputs(instance, ordinary_count, random);
    for (const bool single : subject.precisions()) {
      call.single = single;
      compute(subject, instance, inputs, call);
    }
  }
  if (watch.changed) return Finding::failed("compute changes the floating-point mode");
  return Finding::passed("rounding, denormals and traps are as before");
}

/// Lets the model's function make no system call, and counts what it allocates and locks. As there is no way back, the
/// thread stops after the call.
class QuietWatch : public CallWatch {
 public:
  std::atomic<bool> done{false};
  bool trapped = false;
  std::int64_t allocations = 0, locks = 0;

  void before() override {
    trapped = forbid_system_calls();
    allocations = process_counts != nullptr ? process_counts->allocations.load() : 0;
    locks = process_counts != nullptr ? process_counts->locks.load() : 0;
  }
  void after() override {
    if (process_counts != nullptr) {
      allocations = process_counts->allocations - allocations;
      locks = process_counts->locks - locks;
    }
    done = true;
    while (true) {  // the process ends when the finding is sent
    }
  }
};

Finding quiet(const Subject& subject) {
  Random random = subject.random();
  const plugin::ModelInstance instance = subject.make();
  const Values inputs = subject.random_inputs(instance, ordinary_count, random);
  QuietWatch watch;
  Call call;
  call.watch = &watch;
  std::thread([&] { compute(subject, instance, inputs, call); }).detach();
  while (!watch.done) std::this_thread::yield();
  if (watch.allocations != 0) {
    return Finding::at_most(static_cast<double>(watch.allocations), 0, "allocations of one call of compute");
  }
  if (watch.locks != 0) return Finding::at_most(static_cast<double>(watch.locks), 0, "locks taken by one call");
  if (!watch.trapped || process_counts == nullptr) {
    return Finding::warned(watch.trapped ? "no system call; allocations are not counted in this build"
                                         : "no allocation, no lock; this kernel does not let us watch system calls");
  }
  return Finding::passed("no allocation, no lock, no system call");
}

Finding leaks(const Subject& subject) {
  if (process_counts == nullptr) return Finding::skipped("allocations are not counted in a build with sanitizers");
  const rouleau_model& model = plugin::open_model(subject.manifest());
  const plugin::ModelSetup setup(subject.manifest(), subject.typical_parameters(), Subject::typical_setting());
  const auto held = [] { return process_counts->allocations - process_counts->releases; };
  constexpr int cycles = 1000;
  std::int64_t before = 0;
  for (int i = -1; i < cycles; ++i) {
    if (i == 0) before = held();  // the first one may set up what stays
    void* self = nullptr;
    char error[256] = "";
    model.create(&setup.get(), &self, error, sizeof error);
    model.destroy(self);
  }
  const std::int64_t left = held() - before;  // before the words below are allocated
  return Finding::at_most(static_cast<double>(left), 0,
                          "pieces of memory left by " + std::to_string(cycles) + " instances");
}

/// A double of any kind: ordinary, tiny, huge, a special value, or any bits at all.
double any_double(Random& random) {
  constexpr std::array special = {0.0, -0.0, 1.0, -1.0, 1e-310, 5e-324, 1e-300, 1e300, 1.7976931348623157e308};
  switch (random() % 5) {
    case 0:
      return uniform(random, -2, 2);
    case 1:
      return std::pow(10.0, uniform(random, -12, 12)) * (random() % 4 == 0 ? -1 : 1);
    case 2:
      return special[random() % special.size()];
    case 3:
      return random() % 2 == 0 ? std::nan("") : (random() % 2 == 0 ? 1 : -1) * HUGE_VAL;
    default:
      return std::bit_cast<double>(random());
  }
}

Finding fuzz(const Subject& subject) {
  Random random = subject.random();
  constexpr int rounds = 400;
  std::size_t elements = 0;
  for (int i = 0; i < rounds; ++i) {
    std::optional<plugin::ModelInstance> instance;
    try {
      instance.emplace(subject.manifest(), subject.random_parameters(random), Subject::typical_setting());
    } catch (const plugin::ModelRefused&) {  // parameters that do not go together
      instance.emplace(subject.manifest(), subject.typical_parameters(), Subject::typical_setting());
    }
    Values inputs;
    const std::size_t count = 1 + random() % 97;
    for (const std::string& name : subject.input_arrays()) {
      auto& array = inputs[name];
      for (std::size_t k = 0; k < count; ++k) array.push_back(any_double(random));
    }
    Call call;
    call.single = subject.manifest().kind == plugin::ModelKind::collision && random() % 2 == 0;
    call.in_place = random() % 2 == 0;
    call.offset = random() % 8;
    call.block = 1 + random() % 97;
    call.time_step = random() % 4 == 0 ? 0 : 1;
    compute(subject, *instance, inputs, call);
    elements += count;
  }
  return Finding::passed(std::to_string(elements) + " elements with any values, and nothing broke");
}

}  // namespace

std::vector<Check> process_checks() {
  const Level level = Level::robustness;
  return {
      {"floating-point-mode", level, "leaves the floating-point mode alone", {"compute"}, floating_point},
      {"quiet", level, "computes without allocation, lock, input or output", {"compute"}, quiet},
      {"leaks", level, "frees what it allocates", {"create"}, leaks},
      {"fuzz", level, "bears any inputs", {"contained"}, fuzz},
  };
}

}  // namespace rouleau::conform
