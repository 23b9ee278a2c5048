// Messages over MPI, by a transport library that is opened for it, where a launcher has started several ranks.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "core/domain/transport.hpp"
#include "table.h"

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

/// Another rank has ended its part of the run, and says why.
struct Farewell : core::RankLost {
  Farewell(int code, const std::string& words) : core::RankLost(words), exit_code(code) {}
  int exit_code;
};

/// One rank's end of the connections to all, by MPI. One for a process, used by the thread that has made it.
class Connection final : public core::Transport {
 public:
  /// Opens the library that fits the launcher, or the one that ROULEAU_TRANSPORT of the environment names, and waits
  /// for the other ranks. Throws Error(bad_input) where there is none, or one that does not fit.
  explicit Connection(const Launch& launch);

  [[nodiscard]] int rank() const override { return table_->rank; }
  [[nodiscard]] int ranks() const override { return table_->ranks; }
  void send(int to, core::Message message) override;
  /// Throws Farewell where another rank has said one.
  [[nodiscard]] core::Message receive(int from) override;
  /// Nothing: the process says farewell as it ends.
  void abandon() noexcept override {}

  /// Name and version of the MPI.
  [[nodiscard]] std::string library() const { return table_->library; }
  /// All other ranks are to end with this code; none will hear from this one any more.
  void say_farewell(int exit_code, const std::string& words);
  /// All ranks together: no more messages.
  void finish() { table_->finish(); }
  /// Ends all ranks with this code, and this one first.
  void give_up(int exit_code) { table_->give_up(exit_code); }

 private:
  void begin_to_send(int to, int kind, core::Message message);
  void drop_sent();
  /// Throws the farewell that has come, if one has.
  void hear_farewells();

  const rouleau_transport* table_ = nullptr;
  std::deque<std::pair<void*, core::Message>> sending_;
};

}  // namespace rouleau::transport
