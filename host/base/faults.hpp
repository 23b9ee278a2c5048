// Faults of one input that are found together, and said together.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "error.hpp"

namespace rouleau {

/// Two or more faults. As an Error it is the first of them; what() has all, up to most_shown.
class SeveralFaults : public Error {
 public:
  static constexpr std::size_t most_shown = 20;

  /// In the order in which they are to be said. `at_least`: there may be more.
  SeveralFaults(std::vector<Error> faults, bool at_least);

  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }
  [[nodiscard]] const std::vector<Error>& faults() const noexcept { return faults_; }
  /// The same with each fault put another way.
  [[nodiscard]] SeveralFaults with(const std::function<Error(const Error&)>& other) const;

 private:
  std::vector<Error> faults_;
  bool at_least_;
  std::string message_;
};

/// Throws a fault, or each of several, put another way: for who knows their places or remedies better.
[[noreturn]] void throw_as(const Error& fault, const std::function<Error(const Error&)>& other);

/// Collects faults, so that reading can go on behind one. Whoever collects does not say what follows from a fault that
/// is there already.
class Faults {
 public:
  [[nodiscard]] bool empty() const { return faults_.empty(); }
  [[nodiscard]] std::size_t size() const { return faults_.size(); }
  [[nodiscard]] const Error& operator[](std::size_t i) const { return faults_[i]; }

  /// Keeps a fault; the parts, where there are several in it. Throws all that there are when they are more than anybody
  /// reads.
  void add(const Error& fault);

  /// Calls `read` and keeps the Error that it throws.
  template <class Read>
  void attempt(const Read& read) {
    try {
      read();
    } catch (const Error& fault) {
      add(fault);
    }
  }

  /// Throws what was found, in the order of the text, values that --set has made last: one Error, or SeveralFaults.
  /// Does nothing where there is none.
  void raise() const { raise_all(false); }

 private:
  void raise_all(bool at_least) const;

  std::vector<Error> faults_;
};

}  // namespace rouleau
