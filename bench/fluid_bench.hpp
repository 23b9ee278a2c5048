// The fluid alone: through a plugin, compiled in, and no arithmetic at all.
#pragma once

namespace rouleau::bench {

/// Prints a table over sizes, precisions and threads. Throws if a kernel's result is not right.
void fluid_table(double seconds);

/// Runs every kernel on a small lattice against an exact solution, and the compiled-in ones against the plugin's.
/// Throws if one is wrong; prints what it found.
void check_fluid();

/// Runs `steps` steps of one kernel, for counting its instructions: "plugin", "plain" or "move"; with `force`, the
/// first two read a force at every node and write its velocity over it.
void run_kernel(const char* kernel, bool f32, bool force, int nx, int ny, long steps);

}  // namespace rouleau::bench
