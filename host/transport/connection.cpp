#include "connection.hpp"

#include <dlfcn.h>
#include <sched.h>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <string_view>
#include <thread>

#include "base/error.hpp"
#include "base/installation.hpp"
#include "base/text.hpp"

namespace rouleau::transport {

namespace {

namespace fs = std::filesystem;

/// Kinds of messages.
enum Kind : int { data, farewell };
/// What is longer goes in pieces of this size; one that is shorter is the last.
constexpr std::size_t piece = std::size_t{1} << 30;
/// A look at anything but the message that is waited for costs a turn, too, where ranks share processors: Open MPI lets
/// others run at each. So farewells, and what has been sent, are looked for once in so many looks;
constexpr long other_looks = 16;
/// and this many messages, none of them as large as this, may have been sent before the first of them is looked for.
constexpr std::size_t kept_back = 8, large = std::size_t{1} << 16;

/// A rank that waits looks, then lets others run, and sleeps in the end: it may share a core with the one it waits for,
/// and wait for minutes.
class Patience {
 public:
  void wait() {
    ++looks_;
    if (looks_ < 50) return;
    if (looks_ < 100'000)
      ::sched_yield();
    else
      std::this_thread::sleep_for(std::chrono::microseconds(200));
  }

 private:
  long looks_ = 0;
};

std::string who(const Launch& launch) {
  return "this is rank " + std::to_string(launch.rank) +
         (launch.ranks > 0 ? " of " + std::to_string(launch.ranks) : "") + ", started by " + launch.launcher + ", ";
}

[[noreturn]] void refuse(const Launch& launch, const std::string& problem, const std::string& remedy) {
  throw Error(Cause::bad_input, who(launch) + problem, {remedy});
}

fs::path library_for(const Launch& launch) {
  if (const char* named = ::secure_getenv("ROULEAU_TRANSPORT"); named != nullptr && *named != '\0') return named;
  if (launch.mpi.empty())
    refuse(launch, "which has given it no way to find the others",
           "choose one with srun's option mpi: pmix with Open MPI, pmi2 with MPICH; or set ROULEAU_LAUNCHER=none for a "
           "process that is to be alone");
  fs::path library = installation().programs / ("transport-" + launch.mpi + ".so");
  std::error_code error;
  if (!fs::exists(library, error))
    refuse(launch, "and there is no " + library.string() + " to reach the others with",
           "install the package rouleau-" + launch.mpi +
               " on every machine, or set ROULEAU_LAUNCHER=none for a process that is to be alone");
  return library;
}

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

Connection::Connection(const Launch& launch) {
  const fs::path file = library_for(launch);
  const std::string otherwise =
      "install the transport that fits, or set ROULEAU_LAUNCHER=none for a process that is to be alone";
  // Open MPI's components look for its symbols among the global ones.
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) refuse(launch, "and its transport does not open: " + std::string(::dlerror()), otherwise);
  const auto open = reinterpret_cast<rouleau_transport_open>(::dlsym(library, "rouleau_transport_open_v1"));
  if (open == nullptr) refuse(launch, "and " + file.string() + " is no transport of this version", otherwise);
  table_ = open();
  if (table_ == nullptr) refuse(launch, "and " + file.string() + " cannot start its MPI", otherwise);
  const bool fits = table_->version == ROULEAU_TRANSPORT_VERSION && table_->struct_size >= sizeof(rouleau_transport);
  if (!fits) refuse(launch, "and " + file.string() + " is a transport of another version", otherwise);
  if (launch.ranks > 0 && table_->ranks != launch.ranks)
    refuse(launch,
           "and " + file.string() + " (" + table_->library + ") finds " + std::to_string(table_->ranks) +
               (table_->ranks == 1 ? " rank: it is of another MPI than the launcher" : " ranks"),
           otherwise);
}

void Connection::begin_to_send(int to, int kind, core::Message message) {
  void* const sending = table_->send(to, kind, message.data(), message.size());
  if (sending == nullptr) throw std::bad_alloc();
  sending_.emplace_back(sending, std::move(message));  // its bytes stay where they are
}

void Connection::drop_sent() {
  while (!sending_.empty() && table_->sent(sending_.front().first) != 0) sending_.pop_front();
}

void Connection::send(int to, core::Message message) {
  if (sending_.size() >= kept_back || message.size() >= large) drop_sent();
  for (std::size_t at = 0; message.size() >= piece;) {
    if (message.size() - at < piece) {
      message.erase(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    }
    const auto begin = message.begin() + static_cast<std::ptrdiff_t>(at);
    begin_to_send(to, data, {begin, begin + static_cast<std::ptrdiff_t>(piece)});
    at += piece;
  }
  begin_to_send(to, data, std::move(message));
}

void Connection::hear_farewells() {
  int32_t rank = 0;
  uint64_t size = 0;
  if (table_->arrived(-1, farewell, &rank, &size) == 0) return;
  std::string words(size, ' ');
  table_->take(words.data());
  int code = 0;
  std::memcpy(&code, words.data(), sizeof code);
  throw Farewell(code, words.substr(sizeof code));
}

core::Message Connection::receive(int from) {
  core::Message message;
  Patience patience;
  for (long looks = 1;; ++looks) {
    int32_t sender = 0;
    uint64_t size = 0;
    if (table_->arrived(from, data, &sender, &size) != 0) {
      const std::size_t before = message.size();
      message.resize(before + size);
      table_->take(message.data() + before);
      if (size < piece) return message;
    } else {
      if (looks % other_looks == 0) {
        drop_sent();
        hear_farewells();
      }
      patience.wait();
    }
  }
}

void Connection::say_farewell(int exit_code, const std::string& words) {
  core::Message message(sizeof exit_code + words.size());
  std::memcpy(message.data(), &exit_code, sizeof exit_code);
  std::memcpy(message.data() + sizeof exit_code, words.data(), words.size());
  for (int to = 0; to < ranks(); ++to)
    if (to != rank()) begin_to_send(to, farewell, message);
}

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
