// Whether a launcher of MPI (mpirun, mpiexec, srun) has started this process as one of several ranks.
#pragma once

#include <optional>
#include <string>

namespace rouleau::transport {

/// What the environment says of the launcher.
struct Launch {
  std::string command;   ///< "mpirun", "mpiexec" or "srun"
  std::string launcher;  ///< "mpirun of Open MPI", ...: for messages
  std::string mpi;       ///< whose library speaks with it: "openmpi", "mpich"; empty: none
  int rank = 0;
  int ranks = 0;  ///< 0: unknown
};

/// None for a process that was started alone, be it by a launcher, and where the environment has ROULEAU_LAUNCHER=none.
/// Throws Error(bad_input) for another word there.
std::optional<Launch> launched();

}  // namespace rouleau::transport
