#include "interruption.hpp"

#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>

#include "base/error.hpp"
#include "command_line.hpp"

namespace rouleau::command {

namespace {

struct CauseOfEnd {
  int signal;
  const char* name;
  bool once;  ///< a second one meets what was there before
};
constexpr std::array causes{CauseOfEnd{SIGINT, "Ctrl-C (SIGINT)", true},
                            CauseOfEnd{SIGTERM, "SIGTERM", true},
                            CauseOfEnd{SIGHUP, "a closed terminal (SIGHUP)", true},
                            CauseOfEnd{SIGUSR1, "SIGUSR1", false},
                            CauseOfEnd{SIGXCPU, "SIGXCPU", false},
                            CauseOfEnd{SIGALRM, "--max-time", false}};

std::atomic<bool> interruption_asked = false;
std::atomic<int> first_signal = 0;

void ask_for_interruption(int signal) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal);
  interruption_asked = true;
}

}  // namespace

TimeLimit::TimeLimit(const std::string& text) : seconds_(text.empty() ? 0 : seconds_in("--max-time", text)) {}

double TimeLimit::left() const { return seconds_ - watch_.seconds(); }

const std::atomic<bool>& listen_for_interruption(const TimeLimit& limit) {
  for (const CauseOfEnd& cause : causes) {
    struct sigaction action {
    }, present{};
    action.sa_handler = ask_for_interruption;
    action.sa_flags = cause.once ? static_cast<int>(SA_RESETHAND) : SA_RESTART;
    sigaction(cause.signal, nullptr, &present);
    const bool ignored = present.sa_handler == SIG_IGN;  // nohup wants no end with the terminal
    if (!ignored || cause.signal == SIGALRM) sigaction(cause.signal, &action, nullptr);
  }
  if (limit.is_set()) {
    constexpr double least = 1e-6, most = 1e9;  // a timer of 0 is none; 31 years
    const double seconds = std::clamp(limit.left(), least, most);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(seconds);
    timer.it_value.tv_usec = std::lround((seconds - std::floor(seconds)) * 999999);
    if (setitimer(ITIMER_REAL, &timer, nullptr) != 0)
      throw Error(Cause::input_output, std::string("--max-time: the system has no timer: ") + std::strerror(errno));
  }
  return interruption_asked;
}

std::string interruption_cause() {
  for (const CauseOfEnd& cause : causes)
    if (cause.signal == first_signal) return cause.name;
  return "a signal to another rank";
}

}  // namespace rouleau::command
