// Level "speed": time of an element against what the manifest claims.
#include <algorithm>
#include <chrono>
#include <limits>

#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/subject.hpp"

namespace rouleau::conform {

namespace {

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

std::vector<Check> speed_checks() { return {{"budget", Level::speed, "is as fast as it claims", {"compute"}, budget}}; }

}  // namespace rouleau::conform
