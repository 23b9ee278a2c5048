#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

#include "transport.hpp"

namespace rouleau::core {

namespace {

/// What one rank has sent to one other, and has not been taken yet.
class Mailbox {
 public:
  void put(Message message) {
    {
      const std::lock_guard lock(mutex_);
      messages_.push_back(std::move(message));
    }
    arrived_.notify_one();
  }
  Message take() {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [this] { return !messages_.empty() || closed_; });
    if (messages_.empty()) throw RankLost("another rank of the simulation has given up");
    Message message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    arrived_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Message> messages_;
  bool closed_ = false;  ///< no more will come
};

class Loopback final : public Transport {
 public:
  Loopback(int rank, int ranks, std::shared_ptr<std::vector<Mailbox>> boxes)
      : rank_(rank), ranks_(ranks), boxes_(std::move(boxes)) {}

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int ranks() const override { return ranks_; }
  void send(int to, Message message) override { box(rank_, to).put(std::move(message)); }
  [[nodiscard]] Message receive(int from) override { return box(from, rank_).take(); }
  void abandon() noexcept override {
    for (Mailbox& box : *boxes_) box.close();
  }

 private:
  Mailbox& box(int from, int to) { return (*boxes_)[static_cast<std::size_t>(from) * ranks_ + to]; }

  int rank_, ranks_;
  std::shared_ptr<std::vector<Mailbox>> boxes_;
};

}  // namespace

std::vector<std::unique_ptr<Transport>> make_loopback(int ranks) {
  const auto boxes = std::make_shared<std::vector<Mailbox>>(static_cast<std::size_t>(ranks) * ranks);
  std::vector<std::unique_ptr<Transport>> ends;
  ends.reserve(static_cast<std::size_t>(ranks));
  for (int rank = 0; rank < ranks; ++rank) ends.push_back(std::make_unique<Loopback>(rank, ranks, boxes));
  return ends;
}

}  // namespace rouleau::core
