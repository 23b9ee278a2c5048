#include "faults.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <initializer_list>
#include <new>

#include "base/foreign_call.hpp"
#include "base/signal_stack.hpp"
#include "trial/trial.hpp"

namespace rouleau::command {

namespace {

constexpr std::array fatal_signals = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
std::array<struct sigaction, fatal_signals.size()> handlers_before;
std::atomic<bool> at_its_end{false};
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool others_watch = true;  // and say more
#else
constexpr bool others_watch = false;
#endif

[[noreturn]] void end_process(int code) {
  while (true) ::syscall(SYS_exit_group, code);
}

std::atomic<pid_t> last_words_of{0};  // the thread that has said why the process ends

/// Of threads that come to their end together one speaks; it ends the process while the others wait.
void let_first_speak() {
  const pid_t own = static_cast<pid_t>(::syscall(SYS_gettid));
  pid_t first = 0;
  if (last_words_of.compare_exchange_strong(first, own) || first == own) return;
  timespec enough{.tv_sec = 10, .tv_nsec = 0};
  ::nanosleep(&enough, nullptr);
}

const char* speaker = nullptr;  // before a rank's last words; null: of all that there are, or of the first rank

/// Only calls that are allowed in a handler.
void say(std::initializer_list<const char*> parts) {
  let_first_speak();
  if (speaker != nullptr) {
    // Where all ranks come to the same end the launcher ends this one meanwhile, and there is one message.
    timespec while_first_speaks{.tv_sec = 2, .tv_nsec = 0};
    if (::nanosleep(&while_first_speaks, nullptr) != 0) return;
    for (const char* part : {speaker, ": "})
      if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) return;
  }
  for (const char* part : parts)
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
}

constexpr const char* kept = "\n  what is on disk is whole, and a run can go on from its last checkpoint (--resume)\n";

[[noreturn]] void accuse(const ForeignCall& call, const char* deed) {
  say({"rouleau: the plugin \"", call.model(), "\" ", deed, " in its function ", call.function(), kept,
       "  rouleau conform MANIFEST looks for the fault; report it to the plugin's author\n"});
  end_process(trial::exit_code::plugin_refused);
}

/// Libraries crash, stop or leave the program where they were refused memory, and errno is all that says so.
[[noreturn]] void regret_lack_of_memory() {
  say({"rouleau: there is not enough memory", kept});
  end_process(trial::exit_code::input_output);
}

/// A library whose memory was refused long ago may crash as well as a fault of the program. Where the system keeps
/// the memory of crashed programs (ulimit -c), it is left to do so.
void regret_crash() {
  say({"rouleau: internal error: it has crashed, or a library has that was refused memory", kept,
       "  please report it\n"});
  rlimit kept_memory{};
  if (getrlimit(RLIMIT_CORE, &kept_memory) == 0 && kept_memory.rlim_cur > 0) return;
  end_process(trial::exit_code::input_output);
}

void on_fatal_signal(int signal, siginfo_t* info, void*) {
  const bool without_memory = errno == ENOMEM;
  const bool sent = info->si_code <= 0;  // by a process, and not by what the processor was doing
  const bool from_without = sent && info->si_pid != ::getpid();
  if (const ForeignCall* call = ForeignCall::current(); call != nullptr && !from_without)
    accuse(*call, deed_of(signal));
  if (without_memory && !from_without) regret_lack_of_memory();
  if (!others_watch && !from_without) regret_crash();
  for (std::size_t k = 0; k < fatal_signals.size(); ++k)
    if (fatal_signals[k] == signal) sigaction(signal, &handlers_before[k], nullptr);
  // A fault happens again when this returns, and then meets what was there before. A signal that was sent does not.
  if (sent) ::raise(signal);
}

void on_end() {
  if (const ForeignCall* call = ForeignCall::current()) accuse(*call, "has ended the program");
  if (at_its_end) return;
  if (errno == ENOMEM) regret_lack_of_memory();
  say({"rouleau: a library has ended the program", kept});
  end_process(trial::exit_code::input_output);
}

std::terminate_handler terminate_before;

void on_terminate() {
  if (const ForeignCall* call = ForeignCall::current()) accuse(*call, "has thrown an exception that nobody can catch");
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    regret_lack_of_memory();
  } catch (...) {  // as before
  }
  terminate_before();
}

}  // namespace

void name_culprits() {
  terminate_before = std::set_terminate(on_terminate);
  static const SignalStack stack;
  struct sigaction action {};
  action.sa_sigaction = on_fatal_signal;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  for (std::size_t k = 0; k < fatal_signals.size(); ++k) sigaction(fatal_signals[k], &action, &handlers_before[k]);
  std::atexit(on_end);
  std::at_quick_exit(on_end);
}

void expect_end() { at_its_end = true; }

void speak_as(const std::string& name) { speaker = (new std::string(name))->c_str(); }

}  // namespace rouleau::command

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which have their own
namespace {

/// What a plugin calls that wants to leave without a word: the program's functions come before the C library's.
[[noreturn]] void leave(int code) {
  if (const rouleau::ForeignCall* call = rouleau::ForeignCall::current())
    rouleau::command::accuse(*call, "has ended the program");
  rouleau::command::end_process(code);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] void _exit(int code) { leave(code); }
extern "C" [[gnu::visibility("default")]] void _Exit(int code) noexcept { leave(code); }
#endif
