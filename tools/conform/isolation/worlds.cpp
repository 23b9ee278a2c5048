#include "worlds.hpp"

#include <sched.h>
#include <sys/personality.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

#include "base/process.hpp"
#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/checks/trials.hpp"
#include "conform/report_line.hpp"
#include "counted_functions.hpp"

namespace rouleau::conform {

namespace {

/// Writes over the part of the stack where a function called next has its variables.
[[gnu::noinline]] void paint_stack(int value) {
  char paint[1 << 16];
  std::memset(paint, value, sizeof paint);
  asm volatile("" : : "r"(paint) : "memory");
}

class Painter : public CallWatch {
 public:
  explicit Painter(int value) : value_(value) {}
  void before() override { paint_stack(value_); }
  void after() override {}

 private:
  int value_;
};

void add(std::string& lines, const std::string& name, double value) {
  lines += name + ' ' + (std::isnan(value) ? "nan" : number(value, 17)) + '\n';
}

std::string outputs(const Subject& subject, int fill) {
  std::string lines;
  Random random = subject.random();
  Painter painter(fill);
  paint_stack(fill);
  for (const Trial& trial : setting_trials(subject, random, 3)) {
    lines += '#' + trial.words + '\n';
    if (subject.manifest().kind == plugin::ModelKind::interaction) {
      paint_stack(fill);
      add(lines, "cutoff", trial.instance.interaction().cutoff(trial.instance.self()));
    }
    for (const bool single : subject.precisions()) {
      constexpr std::size_t count = 7;
      Call call;
      call.single = single;
      call.watch = &painter;
      for (const auto& [name, values] :
           compute(subject, trial.instance, subject.random_inputs(trial.instance, count, random), call)) {
        for (const double value : values) add(lines, name, value);
      }
    }
  }
  return lines;
}

}  // namespace

const char* to_string(World world) { return world == World::here ? "here" : "there"; }

World world_named(const std::string& name) { return name == "here" ? World::here : World::there; }

void enter_world(World world, int count, char** words) {
  const bool other = world == World::there;
  std::vector<std::string> variables = {"PATH=/usr/bin:/bin", "HOME=/"};
  if (other) {
    variables = {"PATH=/usr/local/bin:/usr/bin:/bin",
                 "HOME=/nonexistent",
                 "USER=somebody",
                 "LANG=de_DE.UTF-8",
                 "LC_ALL=de_DE.UTF-8",
                 "TZ=Pacific/Kiritimati",
                 "OMP_NUM_THREADS=7",
                 "TMPDIR=/var/tmp",
                 "PADDING=" + std::string(3000, 'x')};
  }
  // Where the dynamic loader and the units' table are found stays, and so does what a run notes.
  for (const char* kept : {"LD_LIBRARY_PATH", "UDUNITS2_XML_PATH", "ROULEAU_INSTRUCTION_SET"}) {
    if (const char* value = std::getenv(kept)) variables.push_back(std::string(kept) + '=' + value);
  }
  ::umask(other ? 077 : 022);
  if (::chdir(other ? "/usr" : "/") != 0) return;
  cpu_set_t processors;
  sched_getaffinity(0, sizeof processors, &processors);
  int wanted = -1;
  for (int k = 0; k < CPU_SETSIZE; ++k) {
    if (CPU_ISSET(k, &processors) && (wanted < 0 || other)) wanted = k;
  }
  CPU_ZERO(&processors);
  CPU_SET(wanted, &processors);
  sched_setaffinity(0, sizeof processors, &processors);
  personality(other ? ADDR_COMPAT_LAYOUT : ADDR_NO_RANDOMIZE);
  std::vector<char*> all(words, words + count), entries;
  std::string entered = "entered";
  all.push_back(entered.data());
  all.push_back(nullptr);
  for (std::string& variable : variables) entries.push_back(variable.data());
  entries.push_back(nullptr);
  execve("/proc/self/exe", all.data(), entries.data());
}

std::string outputs_in_world(const Subject& subject, World world) {
  const bool other = world == World::there;
  const int fill = other ? 0xff : 0;
  if (process_counts != nullptr) {
    constexpr std::int64_t days = 86400;
    process_counts->fill = fill;
    if (other) process_counts->clock_ahead_s = 400 * days + 12345;
    if (other) process_counts->variable = "1";
  }
  if (!other) return outputs(subject, fill);
  std::string lines;
  std::thread([&] { lines = outputs(subject, fill); }).join();
  return lines;
}

std::string outputs_of_process(const Subject& subject, World world) {
  constexpr double time_limit_s = 60;
  const std::string manifest = std::filesystem::absolute(subject.manifest().file).string();
  const ProcessEnd end = run_process(
      "/proc/self/exe",
      {manifest, "surroundings", std::to_string(subject.seed()), std::to_string(subject.dimension()), to_string(world)},
      time_limit_s);
  if (!end.finding.empty() && !end.timed_out) return end.finding;
  return to_json({Verdict::crash, "the process ends in other surroundings", {}, {}}).dump();
}

}  // namespace rouleau::conform
