#include "faults.hpp"

#include <omp.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>

#include "base/foreign_call.hpp"
#include "base/signal_stack.hpp"
#include "plugin/library.hpp"

namespace rouleau::python {

namespace {

constexpr std::array fatal_signals = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
std::array<struct sigaction, fatal_signals.size()> handlers_before;

/// Only calls that are allowed in a handler. Of threads that come to their end together one speaks, and ends the
/// process while the others wait.
void accuse(const ForeignCall& call, const char* deed) {
  static std::atomic<bool> spoken = false;
  if (spoken.exchange(true)) ::sleep(10);
  for (const char* part :
       {"rouleau: the plugin \"", call.model(), "\" ", deed, " in its function ", call.function(),
        ", which ends this process\n  rouleau conform MANIFEST looks for the fault; report it to the "
        "plugin's author\n"}) {
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) return;
  }
}

void on_fatal_signal(int signal, siginfo_t* info, void*) {
  if (const ForeignCall* call = ForeignCall::current()) accuse(*call, deed_of(signal));
  for (std::size_t k = 0; k < fatal_signals.size(); ++k) {
    if (fatal_signals[k] == signal) sigaction(signal, &handlers_before[k], nullptr);
  }
  // A fault happens again when this returns, and then meets what was there before. A signal that was sent does not.
  if (info->si_code <= 0) ::raise(signal);
}

/// A plugin that calls exit would end Python as if all were well.
void on_end() {
  const ForeignCall* call = ForeignCall::current();
  if (call == nullptr) return;
  accuse(*call, "has ended the program");
  constexpr int plugin_refused = 3;
  ::_exit(plugin_refused);
}

}  // namespace

void prepare_process() {
  plugin::keep_libraries_apart();
  struct sigaction action {};
  action.sa_sigaction = on_fatal_signal;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  for (std::size_t k = 0; k < fatal_signals.size(); ++k) sigaction(fatal_signals[k], &action, &handlers_before[k]);
  std::atexit(on_end);
  // OpenMP keeps the forking thread's helpers, which the child does not have and would wait for for ever.
  pthread_atfork([] { omp_pause_resource_all(omp_pause_soft); }, nullptr, nullptr);
}

}  // namespace rouleau::python
