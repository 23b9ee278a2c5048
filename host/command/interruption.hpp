// Ctrl-C, SIGTERM and a closed terminal ask a command to end in good order.
#pragma once

#include <atomic>

namespace rouleau::command {

/// From now on the first of these signals sets the flag; a second one of the same kind ends the program at once.
const std::atomic<bool>& listen_for_interruption();

}  // namespace rouleau::command
