// The fluid alone in three dimensions: through a plugin, and compiled in.
#pragma once

#include <string>

namespace rouleau::bench {

/// Prints a table over sizes and precisions, one thread. Throws if a kernel's result is not right.
void space_table(double seconds);
/// Million nodes a second of the compiled loop in 64^3 nodes, single precision, without a force: how fast the machine
/// is just now.
double space_speed(double seconds);
/// Steps of one kernel in a cube of n^3 nodes, to count its instructions: "plugin" or "plain", the compiled one, which
/// asks for the next row, too.
void run_space_kernel(const std::string& kernel, bool f32, bool force, int n, long steps);

/// Runs the compiled-in kernels on a small lattice against the plugin's. Throws if one is wrong; prints what it found.
void check_space();

}  // namespace rouleau::bench
