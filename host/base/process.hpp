// Runs a program in a process group of its own with a time limit, and leaves nothing of it behind.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace rouleau {

/// The descriptor that a child writes its finding to; standard output belongs to whatever it prints.
inline constexpr int finding_descriptor = 3;

/// When a process is ended, and how much of it is kept.
struct ProcessLimits {
  double time_s;
  double grace_s = 0;                       ///< between SIGTERM and SIGKILL; 0: SIGKILL at once
  const std::atomic<bool>* stop = nullptr;  ///< set by a signal handler: ended as at the time limit
  std::size_t largest_output = 4096;        ///< bytes of ProcessEnd::output
};

struct ProcessEnd {
  bool timed_out = false;
  bool stopped = false;  ///< by ProcessLimits::stop
  int exit_code = 0;     ///< when it ended by itself
  int signal = 0;        ///< that ended it, or 0
  std::string finding;   ///< what it wrote to finding_descriptor
  std::string output;    ///< the beginning of what it wrote to standard output and standard error
  double wall_s = 0;
  double cpu_s = 0;         ///< of all its threads, in user and system mode
  long peak_rss_bytes = 0;  ///< largest resident memory; at least what the caller had when it started the process
};

/// Starts `program` with the arguments and an empty standard input. At the time limit, and in any case when it ends,
/// its whole process group is killed; it is killed, too, when the calling thread dies. Throws Error(input_output) when
/// it cannot be started.
ProcessEnd run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const ProcessLimits& limits);
inline ProcessEnd run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                              double time_limit_s) {
  return run_process(program, arguments, ProcessLimits{time_limit_s});
}

/// Bytes that this process can still get without being ended for it: what the system has left, its swap included, and
/// the limits of address space (ulimit -v) and of the control group. Infinite where nothing is known.
double available_memory();

/// From now on processes whose parents have ended become children of this one, even if they have a session of their
/// own.
void adopt_orphans();

/// Kills all children of this process, with all that they have started, and waits for them. Returns their names, as
/// `ps` has them. For a time when no process is being run.
std::vector<std::string> end_children();

}  // namespace rouleau
