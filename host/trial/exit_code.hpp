// How the program ends: what a trial reads from the process that it started, and the commands return.
#pragma once

namespace rouleau::trial {

/// Exit codes of `rouleau` (fixed: users script against them).
namespace exit_code {

inline constexpr int done = 0;
inline constexpr int simulation_failed = 1;  ///< it diverged, or a check failed
inline constexpr int bad_input = 2;          ///< bad usage, or a scene that cannot be right
inline constexpr int plugin_refused = 3;     ///< a manifest or library was refused, or does not conform
inline constexpr int input_output = 4;       ///< a file could not be read or written
inline constexpr int interrupted = 130;      ///< stopped by SIGINT or SIGTERM

}  // namespace exit_code

}  // namespace rouleau::trial
