// Level "robustness": what a model does to the process it runs in; level "speed": what it takes of its time.
#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/isolation/counted_functions.hpp"
#include "conform/subject.hpp"
#include "plugin/library.hpp"
#include "plugin/process_state.hpp"

namespace rouleau::conform {

namespace {

class ModeWatch : public CallWatch {
 public:
  bool changed = false;
  void before() override { mode_ = plugin::floating_point_mode(); }
  void after() override { changed = changed || plugin::floating_point_mode() != mode_; }

 private:
  plugin::FloatingPointMode mode_{};
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

Finding leaks(const Subject& subject) {
  if (process_counts == nullptr) return Finding::skipped("allocations are not counted in a build with sanitizers");
  const rouleau_model& model = plugin::open_model(subject.manifest());
  const plugin::ModelSetup setup(subject.manifest(), subject.typical_parameters(), subject.typical_setting());
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

Finding fuzz(const Subject& subject) {
  Random random = subject.random();
  constexpr int rounds = 400;
  const auto settings = subject.settings();
  std::size_t elements = 0;
  for (int i = 0; i < rounds; ++i) {
    std::optional<plugin::ModelInstance> instance;
    const plugin::ModelSetting& setting = settings[random() % settings.size()];
    try {
      instance.emplace(subject.manifest(), subject.random_parameters(random), setting);
    } catch (const plugin::ModelRefused&) {  // parameters that do not go together
      instance.emplace(subject.manifest(), subject.typical_parameters(), setting);
    }
    const std::size_t count = 1 + random() % 97;
    const Values inputs = subject.any_inputs(count, random);
    Call call;
    call.single = subject.manifest().kind == plugin::ModelKind::collision && random() % 2 == 0;
    call.place = static_cast<Outputs>(random() % 3);
    call.offset = random() % 8;
    call.block = 1 + random() % 97;
    call.time_step = random() % 4 == 0 ? 0 : 1;
    compute(subject, *instance, inputs, call);
    elements += count;
  }
  return Finding::passed(std::to_string(elements) + " elements with any values, and nothing broke");
}

/// Least time that a call took; what else the machine does only ever adds to it.
class TimeWatch : public CallWatch {
 public:
  double least_ns = std::numeric_limits<double>::infinity();
  void before() override { begin_ = Clock::now(); }
  void after() override {
    least_ns = std::min(least_ns, std::chrono::duration<double, std::nano>(Clock::now() - begin_).count());
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_;
};

Finding budget(const Subject& subject) {
  constexpr std::size_t count = 1024;  // what a call costs beside its elements is small against this
  Random random = subject.random();
  const plugin::ModelInstance instance = subject.make();
  const Values inputs = subject.random_inputs(instance, count, random);
  TimeWatch watch;
  Call call;
  call.watch = &watch;
  for (int i = 0; i < 200; ++i) compute(subject, instance, inputs, call);
  const double nanoseconds = watch.least_ns / count;
  const std::string what = "nanoseconds of one element, on one thread";
  if (!subject.manifest().claims.contains("budget"))
    return {Verdict::pass, what + ", no budget claimed", nanoseconds, {}};
  return Finding::at_most(nanoseconds, subject.manifest().claims["budget"], what);
}

}  // namespace

std::vector<Check> process_checks() {
  const Level level = Level::robustness;
  return {
      {"floating-point-mode", level, "does not change the floating-point mode", {"compute"}, floating_point},
      {"leaks", level, "frees what it allocates", {"create"}, leaks},
      {"fuzz", level, "survives any input", {"contained"}, fuzz},
  };
}

std::vector<Check> speed_checks() { return {{"budget", Level::speed, "is as fast as it claims", {"compute"}, budget}}; }

}  // namespace rouleau::conform
