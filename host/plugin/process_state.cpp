#include "process_state.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>

namespace rouleau::plugin {

namespace {

/// Read where reading does not change it: umask() itself would, for a moment, for all threads.
std::optional<unsigned> file_mode_mask() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "Umask:") continue;
    unsigned mask = 0;
    if (status >> std::oct >> mask) return mask;
  }
  return std::nullopt;
}

std::vector<struct sigaction> signal_handlers() {
  std::vector<struct sigaction> handlers(64);
  for (std::size_t k = 0; k < handlers.size(); ++k) sigaction(static_cast<int>(k) + 1, nullptr, &handlers[k]);
  return handlers;
}

bool same(const struct sigaction& a, const struct sigaction& b) {
  return a.sa_flags == b.sa_flags && a.sa_sigaction == b.sa_sigaction;
}

std::vector<std::string> environment() {
  std::vector<std::string> entries;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) entries.emplace_back(*entry);
  return entries;
}

std::array<std::optional<rlimit>, RLIM_NLIMITS> resource_limits() {
  std::array<std::optional<rlimit>, RLIM_NLIMITS> limits;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    rlimit limit{};
    if (getrlimit(static_cast<__rlimit_resource>(k), &limit) == 0) limits[k] = limit;
  }
  return limits;
}

bool working_directory_is_another_than(int folder) {
  struct stat now {
  }, then{};
  return ::stat(".", &now) == 0 && ::fstat(folder, &then) == 0 &&
         (now.st_dev != then.st_dev || now.st_ino != then.st_ino);
}

}  // namespace

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

ProcessState::ProcessState()
    : folder_(::open(".", O_PATH | O_DIRECTORY | O_CLOEXEC)),
      mask_(file_mode_mask()),
      handlers_(signal_handlers()),
      locale_(std::setlocale(LC_ALL, nullptr)),
      locale_of_thread_(uselocale(nullptr)),
      environment_(environment()),
      limits_(resource_limits()),
      priority_(getpriority(PRIO_PROCESS, 0)),
      on_terminate_(std::get_terminate()),
      on_no_memory_(std::get_new_handler()),
      mode_(floating_point_mode()) {
  pthread_sigmask(SIG_SETMASK, nullptr, &blocked_);
  std::fegetenv(&floating_point_);
}

ProcessState::~ProcessState() {
  if (folder_ >= 0) ::close(folder_);
}

std::vector<std::string> ProcessState::restore() const {
  std::vector<std::string> changed;
  if (folder_ >= 0 && working_directory_is_another_than(folder_))
    changed.emplace_back(::fchdir(folder_) == 0 ? "the working directory" : "the working directory, for good");
  if (const auto mask = file_mode_mask(); mask && mask_ && *mask != *mask_) {
    changed.emplace_back("the file mode mask");
    ::umask(*mask_);
  }
  const std::vector<struct sigaction> handlers = signal_handlers();
  for (std::size_t k = 0; k < handlers.size(); ++k) {
    if (same(handlers[k], handlers_[k])) continue;
    changed.push_back("the handler of signal " + std::to_string(k + 1));
    sigaction(static_cast<int>(k) + 1, &handlers_[k], nullptr);
  }
  sigset_t blocked;
  pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
  if (std::memcmp(&blocked, &blocked_, _NSIG / 8) != 0) {
    changed.emplace_back("the mask of signals");
    pthread_sigmask(SIG_SETMASK, &blocked_, nullptr);
  }
  if (std::setlocale(LC_ALL, nullptr) != locale_ || uselocale(nullptr) != locale_of_thread_ ||
      std::locale() != locale_of_streams_) {
    changed.emplace_back("the locale");
    std::locale::global(locale_of_streams_);
    std::setlocale(LC_ALL, locale_.c_str());
    uselocale(locale_of_thread_);
  }
  if (environment() != environment_) changed.emplace_back("the environment");
  const auto limits = resource_limits();
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (!limits[k] || !limits_[k]) continue;
    if (limits[k]->rlim_cur == limits_[k]->rlim_cur && limits[k]->rlim_max == limits_[k]->rlim_max) continue;
    changed.push_back("the limit of resource " + std::to_string(k));
    setrlimit(static_cast<__rlimit_resource>(k), &*limits_[k]);
  }
  if (getpriority(PRIO_PROCESS, 0) != priority_) {
    changed.emplace_back("the priority");
    setpriority(PRIO_PROCESS, 0, priority_);
  }
  if (std::get_terminate() != on_terminate_ || std::get_new_handler() != on_no_memory_) {
    changed.emplace_back("what happens when an exception is not caught or memory ends");
    std::set_terminate(on_terminate_);
    std::set_new_handler(on_no_memory_);
  }
  if (floating_point_mode() != mode_) {
    changed.emplace_back("the floating-point mode (linked with -ffast-math?)");
    std::fesetenv(&floating_point_);
  }
  return changed;
}

}  // namespace rouleau::plugin
