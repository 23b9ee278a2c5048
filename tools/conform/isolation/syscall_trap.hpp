// Limits the system calls of a thread: the first one that is not allowed ends the process with a finding.
#pragma once

namespace rouleau::conform {

/// What a thread may still ask of the kernel.
enum class Allowed {
  all_but_exit,  ///< anything, but it does not end the process; also what the thread and its children start
  memory,   ///< memory, locks, random numbers, the time; the dynamic loader may map files; output to descriptors 1, 2
  nothing,  ///< end_thread() apart
};

/// From here the calling thread may make these system calls only. Another one becomes a finding that names it, and the
/// model's function that is being called, and the process ends; writing a finding and end_process() stay allowed. There
/// is no way back, only further. False where the kernel does not let us.
bool limit_system_calls(Allowed allowed);

/// Ends the process, or the calling thread without a word to anybody, where a model's code may not.
[[noreturn]] void end_process(int code);
[[noreturn]] void end_thread();
/// As std::exit(0): what was registered for the end of the program runs first.
[[noreturn]] void end_in_order();

}  // namespace rouleau::conform
