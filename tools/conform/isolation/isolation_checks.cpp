// Level "robustness": that a model's functions reach for nothing but their arguments, and leave nothing but their
// results.
#include <dlfcn.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <functional>
#include <sstream>
#include <thread>

#include "base/error.hpp"
#include "base/foreign_call.hpp"
#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/checks/trials.hpp"
#include "conform/report_line.hpp"
#include "conform/subject.hpp"
#include "counted_functions.hpp"
#include "frozen_memory.hpp"
#include "plugin/library.hpp"
#include "plugin/process_state.hpp"
#include "system_calls.hpp"
#include "worlds.hpp"

namespace rouleau::conform {

namespace {

/// Calls that take a model through its branches, the first of them without a call before it: sizes, precisions, missing
/// outputs, looks at the present state, and inputs of any kind.
void call_in_many_ways(const Subject& subject, const std::vector<Trial>& trials, Random& random,
                       const std::function<void(const Trial&, const Values&, const Call&)>& see) {
  const auto outputs = subject.output_arrays();
  std::set<std::string> needed;  // a collision always gives populations
  for (const std::string& name : outputs) {
    if (name.starts_with("populations.")) needed.insert(name);
  }
  bool first = true;
  for (const Trial& trial : trials) {
    for (const bool single : subject.precisions()) {
      Call call;
      call.single = single;
      for (const std::size_t count : {std::size_t{1}, ordinary_count, static_cast<std::size_t>(1 + random() % 3000)}) {
        const Values inputs = subject.random_inputs(trial.instance, count, random, first ? 0 : 2);
        first = false;
        see(trial, inputs, call);
        see(trial, inputs, call);  // a result that was kept
        call.time_step = 0;
        see(trial, inputs, call);
        call.time_step = 1;
        call.absent = {"force", "relaxation_rate"};  // of a collision
        call.outputs = needed;
        if (needed.empty()) call.outputs->insert(outputs[random() % outputs.size()]);
        see(trial, inputs, call);
        call.absent = {};
        call.outputs.reset();
      }
      for (int i = 0; i < 4; ++i) see(trial, subject.any_inputs(1 + random() % 97, random), call);
    }
  }
}

std::vector<Trial> some_trials(const Subject& subject, Random& random) {
  if (subject.manifest().kind == plugin::ModelKind::collision) return collision_trials(subject, random);
  return trials(subject, random, subject.typical_setting(), 3);
}

/// Lets the model's function make no system call, and counts what it allocates and how often it asks for the time.
/// Where the processor obeys (some virtual machines' do not), it may not read its own clock either. As there is no way
/// back, the thread ends after the call.
class QuietWatch : public CallWatch {
 public:
  std::atomic<bool> done{false};
  bool trapped = false;
  std::int64_t allocations = 0, clock_reads = 0;

  void before() override {
    touch_thread_local_storage();
#ifdef PR_SET_TSC
    prctl(PR_SET_TSC, PR_TSC_SIGSEGV);
#endif
    trapped = limit_system_calls(Allowed::nothing);
    if (process_counts != nullptr) allocations = process_counts->allocations, clock_reads = process_counts->clock_reads;
  }
  void after() override {
    if (process_counts != nullptr) {
      allocations = process_counts->allocations - allocations;
      clock_reads = process_counts->clock_reads - clock_reads;
    }
    done = true;
    end_thread();
  }
};

Finding quiet(const Subject& subject) {
  Random random = subject.random();
  Finding finding = Finding::passed("no allocation, no system call");
  call_in_many_ways(
      subject, some_trials(subject, random), random, [&](const Trial& trial, const Values& inputs, const Call& way) {
        if (finding.verdict != Verdict::pass) return;
        QuietWatch watch;
        Call call = way;
        call.watch = &watch;
        std::thread([&] { compute(subject, trial.instance, inputs, call); }).detach();
        while (!watch.done) std::this_thread::yield();
        if (watch.clock_reads != 0) {
          finding = Finding::failed("compute reads the clock");
        } else if (watch.allocations != 0) {
          finding = Finding::at_most(static_cast<double>(watch.allocations), 0, "allocations of one call of compute");
        } else if (!watch.trapped || process_counts == nullptr) {
          finding = Finding::warned(watch.trapped ? "no system call; allocations are not counted in this build"
                                                  : "no allocation; this kernel does not let us watch system calls");
        }
      });
  return finding;
}

/// Functions of a model, called as a host calls them but by nothing else than the call.
class BareModel {
 public:
  /// Looks at the files; loads nothing.
  explicit BareModel(const Subject& subject) : subject_(subject), file_(plugin::checked_library(subject.manifest())) {
    for (const plugin::ModelSetting& setting : subject.settings()) {
      for (const auto& parameters : subject.parameters_of_each_choice()) {
        setups_.emplace_back(subject.manifest(), parameters, setting);
      }
    }
    const std::vector<double> none(subject.manifest().parameters.size(), std::nan(""));
    setups_.emplace_back(subject.manifest(), none, subject.typical_setting());  // to be refused, perhaps
  }

  void load() {
    const ForeignCall mark(subject_.manifest().id.c_str(), "that runs when it is loaded");
    library_ = dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  void open() {
    const auto function = reinterpret_cast<rouleau_open_function>(dlsym(library_, ROULEAU_OPEN_SYMBOL));
    const ForeignCall mark(subject_.manifest().id.c_str(), ROULEAU_OPEN_SYMBOL);
    plugin_ = function(ROULEAU_ABI_MINOR);
  }
  void create() {
    model_ = plugin::find_model(*plugin_, subject_.manifest()).model;
    const ForeignCall mark(subject_.manifest().id.c_str(), "create");
    for (const plugin::ModelSetup& setup : setups_) {
      void* self = nullptr;
      char error[256] = "";
      if (model_->create(&setup.get(), &self, error, sizeof error) == 0) instances_.push_back(self);
    }
  }
  void cutoff() {
    const ForeignCall mark(subject_.manifest().id.c_str(), "cutoff");
    for (const void* self : instances_) {
      if (model_->interaction != nullptr) cutoffs_ += model_->interaction->cutoff(self);
    }
  }
  void destroy() {
    const ForeignCall mark(subject_.manifest().id.c_str(), "destroy");
    for (void* self : instances_) model_->destroy(self);
    instances_.clear();
  }

  struct Step {
    const char* name;
    void (BareModel::*function)();
  };
  static constexpr std::array steps = {Step{"loading it", &BareModel::load},
                                       Step{ROULEAU_OPEN_SYMBOL, &BareModel::open}, Step{"create", &BareModel::create},
                                       Step{"cutoff", &BareModel::cutoff}, Step{"destroy", &BareModel::destroy}};

 private:
  const Subject& subject_;
  std::filesystem::path file_;
  std::deque<plugin::ModelSetup> setups_;
  void* library_ = nullptr;
  const rouleau_plugin* plugin_ = nullptr;
  const rouleau_model* model_ = nullptr;
  std::vector<void*> instances_;
  double cutoffs_ = 0;
};

Finding system_calls(const Subject& subject) {
  BareModel model(subject);
  std::setvbuf(stdout, nullptr, _IONBF, 0);  // what is printed is a system call at once
  bool trapped = false, done = false;
  const char* now = "";
  std::thread([&] {
    trapped = limit_system_calls(Allowed::memory);
    for (const auto& [name, function] : BareModel::steps) {
      now = name;
      (model.*function)();
    }
    done = true;
  }).join();
  if (!done) return Finding::failed(std::string(now) + " ends the thread that calls it");
  if (!trapped) return Finding::warned("this kernel does not let us watch system calls");
  return Finding::passed("loading, opening, creating and destroying ask the kernel for memory alone");
}

/// What calls change in the process without a system call, or with one that memory and locks need, too.
class ProcessTraces {
 public:
  ProcessTraces() {
    of_the_c_library();  // seeds
    random_ = of_the_c_library().first;
  }

  /// "the environment"; empty: nothing.
  [[nodiscard]] std::string found() const {
    auto changed = state_.restore();
    const auto now = of_the_c_library();
    if (now.first != random_) changed.emplace_back("the C library's random numbers");
    if (now.second != buffer_) changed.emplace_back("how standard output is buffered");
    return changed.empty() ? "" : listed(changed);
  }

 private:
  /// The next of the random numbers, which begin anew, and the buffer of standard output.
  static std::pair<long, const void*> of_the_c_library() {
    constexpr unsigned seed = 20;
    const long next = random() ^ lrand48();
    srandom(seed);
    srand48(seed);
    return {next, stdout->_IO_buf_base};
  }

  plugin::ProcessState state_;
  long random_ = 0;
  const void* buffer_ = stdout->_IO_buf_base;
};

/// Runs what was registered for the end of the program, in a process of its own. Ends this one when that found
/// something.
void end_of_program(const Subject& subject) {
  const pid_t child = fork();
  if (child == 0) {
    const ForeignCall mark(subject.manifest().id.c_str(), "that runs when the program ends");
    limit_system_calls(Allowed::memory);
    end_in_order();
  }
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && status != 0) end_process(1);  // it has sent its finding
}

Finding traces(const Subject& subject) {
  BareModel model(subject);
  const ProcessTraces traces;
  for (const auto& [name, function] : BareModel::steps) {
    (model.*function)();
    if (const std::string words = traces.found(); !words.empty()) return Finding::failed(name + (" changes " + words));
  }
  Random random = subject.random();
  std::string words;
  call_in_many_ways(subject, some_trials(subject, random), random,
                    [&](const Trial& trial, const Values& inputs, const Call& call) {
                      compute(subject, trial.instance, inputs, call);
                      if (words.empty()) words = traces.found();
                    });
  if (!words.empty()) return Finding::failed("compute changes " + words);
  end_of_program(subject);
  return Finding::passed("leaves nothing behind: no random number drawn, no other setting of the process");
}

Finding memory(const Subject& subject) {
  FrozenMemory memory;
  Random random = subject.random();
  const std::vector<Trial> trials = some_trials(subject, random);
  memory.watch();
  struct Watch : CallWatch {
    FrozenMemory& memory;
    std::string changed;
    explicit Watch(FrozenMemory& frozen) : memory(frozen) {}
    void before() override { memory.freeze(); }
    void after() override {
      if (const std::string words = memory.thaw(); changed.empty()) changed = words;
    }
  } watch(memory);
  for (const Trial& trial : trials) {
    if (subject.manifest().kind != plugin::ModelKind::interaction) continue;
    watch.before();
    trial.instance.interaction().cutoff(trial.instance.self());
    watch.after();
  }
  if (!watch.changed.empty()) return Finding::failed("cutoff changes " + watch.changed);
  call_in_many_ways(subject, trials, random, [&](const Trial& trial, const Values& inputs, Call call) {
    call.watch = &watch;
    compute(subject, trial.instance, inputs, call);
  });
  if (!watch.changed.empty()) return Finding::failed("compute changes " + watch.changed);
  if (process_counts == nullptr)
    return Finding::warned("variables stay as they are; instances are not watched in this build");
  return Finding::passed("variables and instances stay as they are");
}

/// The first line in which two texts of worlds differ; empty: none.
std::string difference(const std::string& a, const std::string& b) {
  std::istringstream lines_a(a), lines_b(b);
  std::string line_a, line_b, parameters;
  while (std::getline(lines_a, line_a) && std::getline(lines_b, line_b)) {
    if (line_a != line_b) return line_a + " and " + line_b + parameters;
    if (line_a.starts_with('#')) parameters = line_a.substr(1);
  }
  return {};
}

Finding surroundings(const Subject& subject) {
  const std::string here = outputs_of_process(subject, World::here);
  // Where a library lies is drawn at random: one draw may agree with the fixed place in the bits that a plugin uses.
  constexpr int draws = 3;
  for (int k = 0; k < draws; ++k) {
    const std::string there = outputs_of_process(subject, World::there);
    for (const std::string& text : {here, there}) {
      if (const auto finding = nlohmann::json::parse(text, nullptr, false); finding.is_object())
        return finding_from(finding);
    }
    if (here != there) return Finding::failed(difference(here, there) + "; other are " + what_differs);
  }
  return Finding::passed("the same bits in processes with other surroundings");
}

}  // namespace

std::vector<Check> isolation_checks() {
  const Level level = Level::robustness;
  return {
      {"quiet", level, "computes without allocation, input or output", {"fuzz", "outputs-optional"}, quiet},
      {"system-calls",
       level,
       "asks the kernel for memory alone while it is loaded and created",
       {"compute", "parameters"},
       system_calls},
      {"traces", level, "leaves no other setting behind in the process", {"quiet", "system-calls"}, traces},
      {"memory",
       level,
       "does not change its own memory while it computes",
       {"traces", "hidden-state", "threads"},
       memory},
      {"surroundings", level, "gives the same result in another environment", {"memory"}, surroundings},
  };
}

}  // namespace rouleau::conform
