// What a model leaves behind in the process, beyond what ProcessState sees and puts back.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "plugin/process_state.hpp"

namespace rouleau::conform {

/// Threads, descriptors, children, timers and printed text since it was made, and all that a ProcessState knows. It
/// takes standard output and standard error; one at a time.
class ProcessTraces {
 public:
  ProcessTraces();
  ~ProcessTraces();
  ProcessTraces(const ProcessTraces&) = delete;
  ProcessTraces& operator=(const ProcessTraces&) = delete;

  /// "starts a thread", "leaves the file /tmp/x open", "prints \"hello\"", "changes the working directory"; empty:
  /// nothing.
  [[nodiscard]] std::vector<std::string> found() const;

 private:
  plugin::ProcessState state_;
  int printed_;    // a file in memory
  int output_[2];  // copies of standard output and standard error
  int threads_;
  std::string name_;  // of the process
  std::array<std::uintptr_t, 5> c_library_;
  std::map<int, std::string> descriptors_;
};

}  // namespace rouleau::conform
