// What can go wrong, said once: the place of a fault in a file, and the host's only exception type.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace rouleau {

/// What an error is about. command/process/program.hpp says with which exit code the program ends.
enum class Cause {
  bad_input,       ///< bad usage, or a scene that cannot be right
  plugin_refused,  ///< a manifest or library was refused
  input_output,    ///< a file could not be read or written
};

/// Where in the user's input a fault lies. Empty fields are not printed.
struct Place {
  std::string file = {};     ///< path as the user wrote it
  std::string pointer = {};  ///< JSON pointer, e.g. "/cells/0/at"
  int line = 0;              ///< 1-based; 0: unknown
  int column = 0;            ///< 1-based; 0: unknown
};

/// "file:line:column /pointer"; parts that are unknown are left out.
std::string to_string(const Place& place);

/// What a remedy asks for of whoever calls: the command line has an option for each, a library a parameter.
enum class Way {
  elsewhere,  ///< another directory
  anew,       ///< replace what is there
  resume,     ///< go on with what is there
  accept,     ///< go on in spite of the differences
};

/// What the user can do about an error: words that suit every caller, and the ways they speak of, in their order.
struct Remedy {
  std::string words = {};
  std::vector<Way> ways = {};
};

/// A fault that ends what was asked for. what() is the whole message, control characters escaped but for the ends of
/// lines, for it may quote what a file holds:
///     file:line:column /pointer
///       problem, one sentence per line, with the value found
///       remedy
class Error : public std::runtime_error {
 public:
  Error(Cause cause, const Place& place, const std::string& problem, const Remedy& remedy = {});
  /// Without a place the problem begins the message.
  Error(Cause cause, const std::string& problem, const Remedy& remedy = {}) : Error(cause, {}, problem, remedy) {}

  [[nodiscard]] Cause cause() const noexcept { return cause_; }
  [[nodiscard]] const Place& place() const noexcept { return place_; }
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
  [[nodiscard]] const Remedy& remedy() const noexcept { return remedy_; }
  /// what() without the place: problem and remedy.
  [[nodiscard]] std::string words() const;

 private:
  Cause cause_;
  Place place_;
  std::string problem_;
  Remedy remedy_;
};

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
