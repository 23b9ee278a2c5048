// Runs a program in a process group of its own with a time limit, and leaves nothing of it behind.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rouleau::host {

struct ProcessEnd {
  bool timed_out = false;
  int exit_code = 0;    ///< when it ended by itself
  int signal = 0;       ///< that ended it, or 0
  std::string finding;  ///< what it wrote to descriptor 3
  std::string output;   ///< the beginning of what it wrote to standard output and standard error
  double wall_s = 0;
};

/// Starts `program` with the arguments and an empty standard input. At the time limit, and in any case when it ends,
/// its whole process group is killed. Throws Error(input_output) when it cannot be started.
ProcessEnd run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       double time_limit_s);

}  // namespace rouleau::host
