#include "transport/connection.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <string>

#include "base/error.hpp"

namespace rouleau {
namespace {

/// What launched() finds with these variables alone.
std::optional<transport::Launch> launched_with(const std::map<std::string, std::string>& environment) {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE",
                           "SLURM_STEP_NUM_TASKS", "SLURM_PROCID"})
    ::unsetenv(name);
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  return transport::launched();
}

}  // namespace

TEST_CASE("a process that no launcher has started is alone, as is the only one of a launcher") {
  CHECK(!launched_with({}));
  CHECK(!launched_with({{"OMPI_COMM_WORLD_RANK", "0"}, {"OMPI_COMM_WORLD_SIZE", "1"}}));
  CHECK(!launched_with({{"PMI_RANK", "0"}, {"PMI_SIZE", "1"}}));
}

TEST_CASE("the script of a batch job is no step, though it knows the job's tasks") {
  CHECK(!launched_with({{"SLURM_NTASKS", "8"}, {"SLURM_PROCID", "0"}}));
}

TEST_CASE("each launcher is known by what it leaves in the environment") {
  const auto open_mpi =
      launched_with({{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "8"}, {"PMIX_RANK", "2"}});
  REQUIRE(open_mpi);
  CHECK((open_mpi->mpi == "openmpi" && open_mpi->rank == 2 && open_mpi->ranks == 8 && open_mpi->command == "mpirun"));

  const auto hydra = launched_with({{"PMI_RANK", "1"}, {"PMI_SIZE", "4"}});
  REQUIRE(hydra);
  CHECK((hydra->mpi == "mpich" && hydra->rank == 1 && hydra->ranks == 4 && hydra->command == "mpiexec"));

  const std::map<std::string, std::string> step{{"SLURM_STEP_NUM_TASKS", "64"}, {"SLURM_PROCID", "5"}};
  auto with_pmix = step, with_pmi2 = step;
  with_pmix["PMIX_RANK"] = "5";
  with_pmi2.insert({{"PMI_RANK", "5"}, {"PMI_SIZE", "64"}});
  for (const auto& [environment, mpi] : {std::pair{step, ""}, {with_pmix, "openmpi"}, {with_pmi2, "mpich"}}) {
    const auto srun = launched_with(environment);
    REQUIRE(srun);
    CHECK((srun->mpi == mpi && srun->rank == 5 && srun->ranks == 64 && srun->command == "srun"));
  }
}

TEST_CASE("a process that is told so is alone, whatever has started it") {
  const std::map<std::string, std::string> rank{{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "4"}};
  ::setenv("ROULEAU_LAUNCHER", "none", 1);
  CHECK(!launched_with(rank));
  ::setenv("ROULEAU_LAUNCHER", "nobody", 1);
  CHECK_THROWS_AS(launched_with(rank), Error);
  ::setenv("ROULEAU_LAUNCHER", "", 1);
  CHECK(launched_with(rank));
  ::unsetenv("ROULEAU_LAUNCHER");
}

TEST_CASE("what is no number is not there") {
  CHECK(!launched_with({{"OMPI_COMM_WORLD_RANK", "two"}, {"OMPI_COMM_WORLD_SIZE", "8"}}));
  CHECK(!launched_with({{"PMI_RANK", "-1"}, {"PMI_SIZE", "4"}}));
}

}  // namespace rouleau
