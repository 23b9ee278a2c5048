// For the handlers of fatal signals: their words, and a stack, for a thread's own may be what has been exhausted.
#pragma once

#include <csignal>
#include <cstddef>
#include <memory>

namespace rouleau {

/// What somebody has done who was sent this signal: "has divided by zero, ...".
inline const char* deed_of(int signal) {
  if (signal == SIGSEGV || signal == SIGBUS) return "has used memory that it does not have (or too much of the stack)";
  if (signal == SIGFPE) return "has divided by zero, or switched on floating-point exceptions";
  if (signal == SIGILL) return "has come to an instruction that this processor does not have (or to a trap of its own)";
  return signal == SIGABRT ? "has stopped the program (abort, or an assertion that failed)" : "has crashed";
}

/// Handlers of the calling thread run on this while it lives. Does nothing where the thread has such a stack already.
class SignalStack {
 public:
  SignalStack() {
    stack_t present{};
    if (sigaltstack(nullptr, &present) != 0 || (present.ss_flags & SS_DISABLE) == 0) return;
    memory_ = std::make_unique<std::byte[]>(size);
    const stack_t mine{.ss_sp = memory_.get(), .ss_flags = 0, .ss_size = size};
    if (sigaltstack(&mine, nullptr) != 0) memory_.reset();
  }
  ~SignalStack() {
    if (!memory_) return;
    const stack_t none{.ss_sp = nullptr, .ss_flags = SS_DISABLE, .ss_size = 0};
    sigaltstack(&none, nullptr);
  }
  SignalStack(const SignalStack&) = delete;
  SignalStack& operator=(const SignalStack&) = delete;

 private:
  static constexpr std::size_t size = std::size_t{1} << 16;
  std::unique_ptr<std::byte[]> memory_;
};

}  // namespace rouleau
