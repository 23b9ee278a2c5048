#include "network_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/domain/ranks.hpp"
#include "transport/connection.hpp"

namespace rouleau::bench {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Something to do that takes the same time whenever it is done.
void compute(long numbers) {
  static thread_local volatile double kept = 1;  // known to nobody: it is computed each time
  double x = kept;
  for (long i = 0; i < numbers; ++i) x = x * 0.999999 + 1e-6;
  kept = x;
}

/// How much of it takes `time` s of a processor: the fastest of many tries, in which nobody else was there.
long numbers_in(double time) {
  constexpr long tried = 2000;
  double least = 1;
  for (int i = 0; i < 200; ++i) {
    const auto start = Clock::now();
    compute(tried);
    least = std::min(least, since(start));
  }
  return std::lround(time / least * tried);
}

/// Quantiles of times, s.
struct Times {
  std::vector<double> sorted;
  explicit Times(std::vector<double> times) : sorted(std::move(times)) { std::sort(sorted.begin(), sorted.end()); }
  [[nodiscard]] double mean() const {
    return std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
  }
  [[nodiscard]] double at(double share) const {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
};

/// The figures of a network, as the first rank finds them while all ranks speak, in pairs of neighbours: they share
/// what their machine has, its processors, too, where there are more of them.
class Network {
 public:
  /// Every figure takes so many seconds.
  Network(core::Transport& transport, const core::Ranks<1>& ranks, double seconds)
      : transport_(transport), ranks_(ranks), seconds_(seconds) {}

  /// Half a round trip of a message between the ranks of a pair.
  Times half_round(std::size_t bytes) {
    return repeated(
        [&](bool first) {
          if (first) {
            transport_.send(other_, core::Message(bytes));
            return transport_.receive(other_).size();
          }
          transport_.send(other_, transport_.receive(other_));
          return bytes;
        },
        2);
  }
  /// Each of many small messages that one rank of a pair sends without waiting.
  Times in_a_row() {
    constexpr int count = 100;
    return repeated(
        [&](bool first) {
          if (first) {
            for (int i = 0; i < count; ++i) transport_.send(other_, core::Message(64));
            return transport_.receive(other_).size();
          }
          for (int i = 0; i < count; ++i) static_cast<void>(transport_.receive(other_));
          transport_.send(other_, core::Message(1));
          return std::size_t{1};
        },
        count);
  }
  /// A wait of a step: all ranks compute for `work` s, and then wait for the two before and the two behind. What it
  /// takes beside the computing, of each of the ranks that share a processor.
  Times wait(double work, unsigned processors) {
    constexpr int waits = 100;
    const int count = transport_.ranks(), mine = transport_.rank();
    std::vector<int> others;
    for (int rank = std::max(0, mine - 2); rank < std::min(count, mine + 3); ++rank) {
      if (rank != mine) others.push_back(rank);
    }
    const long numbers = numbers_in(work);
    Times times = repeated(
        [&](bool) {
          for (int i = 0; i < waits; ++i) {
            compute(numbers);
            for (const int other : others) transport_.send(other, core::Message(8));
            for (const int other : others) static_cast<void>(transport_.receive(other));
          }
          return others.size();
        },
        waits, true);
    const double share = std::ceil(static_cast<double>(count) / processors);
    for (double& time : times.sorted) time = time / share - work;
    return times;
  }
  /// Eight numbers from every rank to every other, as a step's agreement and the sums of checks go.
  Times agreement() {
    return repeated([&](bool) { return core::all_of(ranks_, std::vector<double>(8)).size(); }, 1, true);
  }

 private:
  /// Times of function(whether it is the first of its pair), over `parts`. Of all pairs, or of all ranks.
  template <class Function>
  Times repeated(Function function, double parts, bool of_all = false) {
    const bool first = transport_.rank() % 2 == 0, takes_part = of_all || other_ < transport_.ranks();
    std::vector<double> times;
    const auto begin = Clock::now();
    for (int i = 0; i < 5; ++i) {  // connections are made by the first messages
      if (takes_part) static_cast<void>(function(first));
    }
    // The first rank chooses how often, by what one takes.
    const double once = std::max(since(begin) / 5, 1e-7);
    const int count =
        core::all_of(ranks_, std::vector<int>{std::clamp(static_cast<int>(seconds_ / once), 20, 20000)})[0][0];
    for (int i = 0; i < count && takes_part; ++i) {
      const auto start = Clock::now();
      static_cast<void>(function(first));
      times.push_back(since(start) / parts);
    }
    static_cast<void>(core::all_of(ranks_, std::vector<int>{0}));  // nobody goes on before all are done
    return Times(takes_part ? std::move(times) : std::vector<double>{0});
  }

  core::Transport& transport_;
  const core::Ranks<1>& ranks_;
  double seconds_;
  int other_ = transport_.rank() ^ 1;  // of the pair; the last of an odd number has none
};

void measure_network(core::Transport& transport, const std::string& library, double seconds) {
  const int count = transport.ranks();
  // The lattice means nothing here: it says how many ranks there are.
  const auto blocks = core::Decomposition<1>::even({{count}, {false}}, {count});
  const core::Ranks<1> ranks{&blocks, &transport};
  Network network(transport, ranks, seconds);
  const bool prints = transport.rank() == 0;
  const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
  if (prints) {
    std::printf("\nMessages between the pairs of %d ranks, all at once, %s, %u processors\n", count, library.c_str(),
                processors);
    std::printf("  %-34s %10s %10s %10s %12s\n", "microseconds", "best", "median", "1 of 100", "MB/s");
  }
  const auto line = [&](const std::string& what, const Times& times, double bytes) {
    if (!prints) return;
    std::printf("  %-34s %10.2f %10.2f %10.2f", what.c_str(), times.at(0) * 1e6, times.at(0.5) * 1e6,
                times.at(0.99) * 1e6);
    std::printf(bytes > 0 ? " %12.0f\n" : "\n", bytes / times.at(0.5) / 1e6);
    std::fflush(stdout);
  };
  constexpr std::size_t typical = std::size_t{1} << 14;
  constexpr double work = 5e-6;  // s; about what lies between two waits of a small scene
  double latency = 0, least = 0, bandwidth = 0, slowest = 0;
  for (const std::size_t bytes :
       {std::size_t{8}, std::size_t{1} << 10, typical, std::size_t{1} << 17, std::size_t{1} << 20}) {
    const Times times = network.half_round(bytes);
    if (bytes == 8) latency = times.at(0.5), least = times.at(0);
    slowest = std::max(slowest, times.at(0.99));
    // What a run sends is about as long: longer messages travel faster.
    if (bytes == typical) bandwidth = static_cast<double>(bytes) / std::max(times.at(0.5) - latency, 1e-9);
    line("there, of " + std::to_string(bytes) + " bytes", times, bytes > 8 ? static_cast<double>(bytes) : 0);
  }
  const Times in_a_row = network.in_a_row();
  line("each of 100 in a row", in_a_row, 0);
  const Times wait = network.wait(work, processors);
  line("a wait for four, computing 5 us", wait, 0);
  line("eight numbers from all to all", network.agreement(), 0);
  if (!prints) return;
  std::printf("  rouleau plan SCENE --ranks N --network \"%.2f us,%.0f MB/s,%.2f us\"\n",
              std::max(wait.mean(), least) * 1e6, bandwidth / 1e6, in_a_row.at(0.5) * 1e6);
  if (static_cast<unsigned>(count) > processors) {
    std::printf(
        "  More ranks than processors: a rank that waits lets others run, and times are those of the scheduler.\n");
  } else if (slowest > 1e-3) {
    std::printf(
        "  Some messages take milliseconds: other processes use these processors, and a rank that lets them run waits\n"
        "  for its turn. Measure again when they do not, or with mpirun's option --bind-to none.\n");
  }
}

}  // namespace

void network_table(double seconds) {
  if (const auto launch = transport::launched()) {
    transport::Connection connection(*launch);
    measure_network(connection, connection.library(), seconds);
    connection.finish();
    return;
  }
  const auto ends = core::make_loopback(2);
  std::thread other([&] { measure_network(*ends[1], "", seconds); });
  measure_network(*ends[0], "threads of this process", seconds);
  other.join();
}

}  // namespace rouleau::bench
