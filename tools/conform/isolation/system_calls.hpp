// A filter of the kernel's for system calls: the first one that a model may not make ends the process with a finding.
#pragma once

#include <linux/filter.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rouleau::conform {

/// Traps all system calls of a thread (SIGSYS) but those that are allowed. Calls have this machine's numbers; those of
/// other processors' programs are trapped.
class SyscallFilter {
 public:
  SyscallFilter();

  void allow(long number);
  /// ... where the lower half of an argument has this value.
  void allow_if(long number, unsigned argument, std::uint32_t value);
  /// Allows whatever code between two addresses calls, the last one with it: that is where the kernel returns to.
  void allow_code(std::uint64_t first, std::uint64_t last);

  /// From here all calls of the calling thread are filtered. There is no way back, only further. False where the kernel
  /// does not let us.
  bool install();

 private:
  void load(std::size_t offset);
  void jump(std::uint16_t kind, std::uint32_t value, std::uint8_t if_true, std::uint8_t if_false);
  void end(std::uint32_t action);

  std::vector<sock_filter> program_;
};

/// What a thread may still ask of the kernel: its own end, and
enum class Allowed {
  memory,   ///< memory, locks, random numbers, the time; the dynamic loader may map files
  nothing,  ///< nothing else
};

/// From here another system call of the calling thread becomes a finding that names it, and the model's function that
/// is being called, and the process ends. Writing a finding and end_process() stay allowed. False as install().
bool limit_system_calls(Allowed allowed);

/// Ends the process where a model's code may not. At once, or, `in_order`, as std::exit(0) does.
[[noreturn]] void end_process(int code);
[[noreturn]] void end_in_order();
/// Ends the calling thread without a word to anybody.
[[noreturn]] void end_thread();

}  // namespace rouleau::conform
