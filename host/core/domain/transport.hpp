// Messages between the ranks of one simulation.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

namespace rouleau::core {

using Message = std::vector<std::byte>;

/// Another rank has given up, and there will be no message.
struct RankLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One rank's end of the connections to all ranks, itself included. Messages from one rank to another come in the order
/// in which they were sent. An end belongs to one thread at a time.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int ranks() const = 0;
  /// Does not wait for the receiver.
  virtual void send(int to, Message message) = 0;
  /// Waits for the next message of a rank. Throws RankLost where none comes.
  [[nodiscard]] virtual Message receive(int from) = 0;
  /// This rank gives up, so that no other waits for it for ever. May be called from any thread.
  virtual void abandon() noexcept = 0;
};

/// Ranks in one process, their messages copied in memory; each end may be used by a thread of its own. For tests, and
/// to see what blocks cost.
std::vector<std::unique_ptr<Transport>> make_loopback(int ranks);

}  // namespace rouleau::core
