// Whose code runs: while a model's function is called, its thread knows the name, so that no fault stays without one.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

namespace rouleau {

/// While it lives, its thread runs code that is not this program's. Handlers of signals and of the program's end ask
/// current() whose fault it is; two writes to memory are all that a call costs.
class ForeignCall {
 public:
  /// Both texts must outlive it.
  ForeignCall(const char* model, const char* function) noexcept
      : model_(model), function_(function), before_(innermost) {
    innermost = this;
  }
  ~ForeignCall() { innermost = before_; }
  ForeignCall(const ForeignCall&) = delete;
  ForeignCall& operator=(const ForeignCall&) = delete;

  /// Of the calling thread; null: none.
  static const ForeignCall* current() noexcept { return innermost; }

  [[nodiscard]] const char* model() const noexcept { return model_; }
  /// "compute", "create", ...
  [[nodiscard]] const char* function() const noexcept { return function_; }

 private:
  const char *model_, *function_;
  const ForeignCall* before_;
  static inline constinit thread_local const ForeignCall* innermost = nullptr;
};

/// An exception has left a model's function, which it must not.
struct ForeignException : std::runtime_error {
  /// Of the exception that is being handled.
  ForeignException(const std::string& model, const std::string& function)
      : std::runtime_error("the plugin \"" + model + "\" has thrown " + thrown() + " in its function " + function) {}

 private:
  static std::string thrown() {
    try {
      throw;
    } catch (const std::exception& exception) {
      return std::string("an exception: ") + exception.what();
    } catch (...) {
      return "an exception that is no std::exception";
    }
  }
};

/// Of the exception that is being handled. Apart from call_foreign(), which is called for each row of a lattice.
[[noreturn, gnu::cold, gnu::noinline]] inline void throw_foreign(const std::string& model, const char* function) {
  throw ForeignException(model, function);
}

/// Calls call() as a function of a model's. Throws ForeignException for whatever it throws.
template <class Call>
auto call_foreign(const std::string& model, const char* function, Call&& call) {
  const ForeignCall mark(model.c_str(), function);
  try {
    return call();
  } catch (...) {
    throw_foreign(model, function);
  }
}

}  // namespace rouleau
