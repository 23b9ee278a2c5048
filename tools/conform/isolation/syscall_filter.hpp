// A filter of the kernel's for system calls, and what it lets through.
#pragma once

#include <linux/filter.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rouleau::conform {

/// Allows some system calls of a thread and does something else with all others, or the other way round. What was said
/// first counts. Calls have this machine's numbers; those of other processors' programs are trapped.
class SyscallFilter {
 public:
  SyscallFilter();

  void allow(long number);
  /// ... where the lower half of an argument, shifted to the right, is this value.
  void allow_if(long number, unsigned argument, std::uint32_t value, std::uint32_t shift = 0);
  /// Traps a call that is not allowed so far.
  void trap(long number);
  /// Allows whatever code between two addresses calls, the last one with it: that is where the kernel returns to.
  void allow_code(std::uint64_t first, std::uint64_t last);

  /// From here all calls of the calling thread are filtered: `otherwise` (SECCOMP_RET_ALLOW, ...) is for those of which
  /// nothing was said. There is no way back. False where the kernel does not let us.
  bool install(std::uint32_t otherwise);

 private:
  void load(std::size_t offset);
  void jump(std::uint16_t kind, std::uint32_t value, std::uint8_t if_true, std::uint8_t if_false);
  void end(std::uint32_t action);

  std::vector<sock_filter> program_;
};

}  // namespace rouleau::conform
