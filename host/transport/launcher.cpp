#include "launcher.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "base/error.hpp"
#include "base/text.hpp"

namespace rouleau::transport {

namespace {

/// Of a variable of the environment; none where it is not there or no number.
std::optional<int> number_in(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr) return std::nullopt;
  const std::string_view text = value;
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

std::optional<Launch> found() {
  const auto open_mpi_rank = number_in("OMPI_COMM_WORLD_RANK"), open_mpi_ranks = number_in("OMPI_COMM_WORLD_SIZE");
  if (open_mpi_rank && open_mpi_ranks)
    return Launch{"mpirun", "mpirun of Open MPI", "openmpi", *open_mpi_rank, *open_mpi_ranks};
  // Of a step of srun; the script of sbatch is none.
  const auto slurm_ranks = number_in("SLURM_STEP_NUM_TASKS"), slurm_rank = number_in("SLURM_PROCID");
  if (const auto rank = number_in("PMIX_RANK"))
    return slurm_ranks ? Launch{"srun", "srun", "openmpi", *rank, *slurm_ranks}
                       : Launch{"mpirun", "a launcher with PMIx", "openmpi", *rank, 0};
  if (const auto rank = number_in("PMI_RANK"), ranks = number_in("PMI_SIZE"); rank && ranks)
    return slurm_ranks ? Launch{"srun", "srun", "mpich", *rank, *ranks}
                       : Launch{"mpiexec", "mpiexec of MPICH", "mpich", *rank, *ranks};
  if (slurm_ranks && slurm_rank) return Launch{"srun", "srun", "", *slurm_rank, *slurm_ranks};
  return std::nullopt;
}

}  // namespace

std::optional<Launch> launched() {
  if (const char* wish = std::getenv("ROULEAU_LAUNCHER"); wish != nullptr && *wish != '\0') {
    if (wish == std::string_view("none")) return std::nullopt;
    throw Error(Cause::bad_input, "the environment variable ROULEAU_LAUNCHER is " + in_quotes(wish),
                {"the one word that it can be is none: this process is alone, whatever has started it"});
  }
  std::optional<Launch> launch = found();
  if (launch && launch->ranks == 1) launch.reset();
  return launch;
}

}  // namespace rouleau::transport
