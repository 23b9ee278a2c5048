// What can go wrong, said once: exit codes, the place of a fault in a file, and the host's only exception type.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace rouleau {

/// Exit codes of the program (fixed: users script against them).
enum class ExitCode {
  done = 0,
  simulation_failed = 1,  ///< the simulation diverged, or a check failed
  bad_input = 2,          ///< bad usage, or a scene that cannot be right
  plugin_refused = 3,     ///< a manifest or library was refused
  input_output = 4,       ///< a file could not be read or written
  interrupted = 130,      ///< stopped by SIGINT or SIGTERM
};

/// Where in the user's input a fault lies. Empty fields are not printed.
struct Place {
  std::string file;     ///< path as the user wrote it
  std::string pointer;  ///< JSON pointer, e.g. "/cells/0/at"
  int line = 0;         ///< 1-based; 0: unknown
  int column = 0;       ///< 1-based; 0: unknown
};

/// "file:line:column /pointer"; parts that are unknown are left out.
std::string to_string(const Place& place);

/// A message whose control characters, but for the ends of lines, are escaped: it may quote what a file holds.
std::string safe_lines(const std::string& message);

/// A fault that ends the command. what() is the whole message as the user sees it, safe_lines():
///     file:line:column /pointer
///       problem, one sentence per line, with the value found and the remedy
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& problem) : std::runtime_error(safe_lines(problem)), code_(code) {}
  Error(ExitCode code, Place place, const std::string& problem)
      : std::runtime_error(to_string(place) + "\n  " + safe_lines(problem)), code_(code), place_(std::move(place)) {}

  [[nodiscard]] ExitCode code() const noexcept { return code_; }
  [[nodiscard]] const Place& place() const noexcept { return place_; }

 private:
  ExitCode code_;
  Place place_;
};

}  // namespace rouleau
