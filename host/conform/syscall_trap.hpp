// Lets a thread make no system calls from now on: the first one ends the process with a finding.
#pragma once

namespace rouleau::conform {

/// From here the calling thread may only compute. A system call becomes a failed finding that names it, and the process
/// ends; writing a finding and exiting stay allowed. There is no way back. False where the kernel does not let us.
bool forbid_system_calls();

}  // namespace rouleau::conform
