// How many threads a command takes.
#pragma once

namespace rouleau::scene {
struct Scene;
}

namespace rouleau::command {

/// Of this machine, one at least.
int processors();
/// Throws Error(bad_input) for a number that no machine has; `option`: what gave it.
void check_threads(const char* option, int threads);
/// No more than have rows of the lattice to share.
int useful_threads(const scene::Scene& scene, int threads);
/// Throws Error(input_output) where the system refuses so many: OpenMP's library would end the program.
void require_threads(const char* option, int threads);

}  // namespace rouleau::command
