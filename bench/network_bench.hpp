// What messages between ranks cost: the figures that `rouleau plan --ranks` reckons with.
#pragma once

namespace rouleau::bench {

/// Under a launcher: between its ranks, over MPI. Else between two threads of this process, which shows what the
/// program's own handling costs. `seconds`: for each line. The first rank prints.
void network_table(double seconds);

}  // namespace rouleau::bench
