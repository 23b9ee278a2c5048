// What belongs to the whole process, and no plugin may change.
#pragma once

#include <sys/resource.h>

#include <array>
#include <cfenv>
#include <clocale>
#include <csignal>
#include <cstdint>
#include <exception>
#include <locale>
#include <optional>
#include <string>
#include <vector>

namespace rouleau::plugin {

/// What decides how a thread computes: rounding, treatment of denormals, exceptions that trap.
struct FloatingPointMode {
  int rounding;
  std::uint64_t control;  ///< the processor's control registers, without the flags of past exceptions
  friend bool operator==(const FloatingPointMode&, const FloatingPointMode&) = default;
};

FloatingPointMode floating_point_mode();

/// Working directory, file mode mask, signal handlers and the thread's signal mask, locale, environment, limits of
/// resources, priority, handlers of C++ and the floating-point mode as they are when it is made. What the system
/// refuses to tell, then or later, is taken for unchanged.
class ProcessState {
 public:
  ProcessState();
  ~ProcessState();
  ProcessState(const ProcessState&) = delete;
  ProcessState& operator=(const ProcessState&) = delete;

  /// Puts back what is different now, but for the environment, and says what that is; empty: nothing.
  std::vector<std::string> restore() const;

 private:
  int folder_;  // the working directory; -1: it cannot be opened
  std::optional<unsigned> mask_;
  std::vector<struct sigaction> handlers_;  // of signal k + 1
  sigset_t blocked_{};
  std::string locale_;
  locale_t locale_of_thread_;
  std::locale locale_of_streams_;
  std::vector<std::string> environment_;
  std::array<std::optional<rlimit>, RLIM_NLIMITS> limits_;
  int priority_;
  std::terminate_handler on_terminate_;
  std::new_handler on_no_memory_;
  FloatingPointMode mode_;
  std::fenv_t floating_point_;
};

}  // namespace rouleau::plugin
