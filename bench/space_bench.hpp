// The fluid alone in three dimensions: through a plugin, and compiled in.
#pragma once

namespace rouleau::bench {

/// Prints a table over sizes and precisions, one thread. Throws if a kernel's result is not right.
void space_table(double seconds);

/// Runs the compiled-in kernels on a small lattice against the plugin's. Throws if one is wrong; prints what it found.
void check_space();

}  // namespace rouleau::bench
