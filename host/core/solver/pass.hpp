// One pass of a time step, how the workers run several, and the clock that tells what each pass costs.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "barrier.hpp"
#include "base/worker.hpp"

namespace rouleau::core {

/// What happens between the workers when one of them has ended a pass.
enum class Meeting {
  none,      ///< it goes on
  all,       ///< it waits until all have ended the pass
  announce,  ///< it goes on, but tells the others: a later pass has `await`
  await      ///< it waits until all have announced the end of that earlier pass
};

/// Every worker runs its share.
struct Pass {
  std::string name;  ///< passes under one name are phases of one
  std::function<void(Worker)> run;
  /// Instead of `run`, of a pass over rows: any rows of the block. Such passes one after another, with no meeting
  /// between them, are run band by band, so that a band is still in the cache when the next pass wants it.
  std::function<void(Range rows)> run_rows = {};
  /// Of a pass over rows: one worker, when all have passed those at the ends of the block and before the others
  /// (RowBands).
  std::function<void()> after_ends = {};
  Meeting meeting = Meeting::all;
};

/// How rows are cut into bands.
struct RowBands {
  int rows = 0;         ///< of the block
  int height = 1;       ///< rows of a band
  bool upwards = true;  ///< the order in which a worker takes its bands
  int below = 0;        ///< rows at the lower end, which other blocks wait for
  int above = 0;        ///< at the upper end
  /// What the rows below each row cost, and all of them; empty: one costs as much as another.
  std::span<const long> cost_below = {};

  /// Calls function(rows) for the bands of a worker.
  template <class Function>
  void for_each(Worker worker, Function function) const {
    for_bands({0, rows}, worker, function);
  }
  /// Of the rows at the ends alone, and of all but these.
  template <class Function>
  void for_ends(Worker worker, Function function) const {
    for_bands({0, below}, worker, function);
    for_bands({rows - above, rows}, worker, function);
  }
  template <class Function>
  void for_middle(Worker worker, Function function) const {
    for_bands({below, rows - above}, worker, function);
  }

 private:
  template <class Function>
  void for_bands(Range all, Worker worker, Function function) const {
    const Range share = share_of(all, worker);
    const int count = (share.end - share.begin + height - 1) / height;
    for (int i = 0; i < count; ++i) {
      const int begin = share.begin + (upwards ? i : count - 1 - i) * height;
      function(Range{begin, std::min(begin + height, share.end)});
    }
  }
  [[nodiscard]] Range share_of(Range all, Worker worker) const {
    const Range share = worker.share(all.end - all.begin);
    if (cost_below.empty()) return {all.begin + share.begin, all.begin + share.end};
    const auto cost = cost_below.begin();
    const auto bound = [&](int i) {
      const long wanted = cost[all.begin] + (cost[all.end] - cost[all.begin]) * i / worker.count;
      return i == worker.count ? all.end
                               : static_cast<int>(std::lower_bound(cost + all.begin, cost + all.end, wanted) - cost);
    };
    return {bound(worker.index), bound(worker.index + 1)};
  }
};

/// Wall-clock time of the passes of a step as one worker sees it, waiting for others included.
class PassClock {
 public:
  explicit PassClock(std::size_t passes) : wall_s_(passes, 0.0) {}
  /// Time goes to no pass until now.
  void resume() { last_ = Clock::now(); }
  /// Time since the last call goes to this pass.
  void lap(std::size_t pass) {
    const Clock::time_point now = Clock::now();
    wall_s_[pass] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  /// What has gone to a pass since this was last asked.
  [[nodiscard]] double take(std::size_t pass) { return std::exchange(wall_s_[pass], 0.0); }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<double> wall_s_;
  Clock::time_point last_ = Clock::now();
};

/// A step as several workers take it. Before pass [observable], after a barrier, the state may be observed; who does
/// not want to runs the passes from [rows] on without a stop.
struct StepPasses {
  std::vector<Pass> passes;
  std::size_t rows = 0, observable = 0;
  std::function<RowBands()> bands;  ///< how this step cuts rows
  std::vector<std::string> names;   ///< each once, as one process has them; other ranks change the order of the passes

  /// What each worker does with the passes [first, last), in their order. The clock, if any, is the first worker's.
  void run(std::size_t first, std::size_t last, Worker worker, Barrier& barrier, PassClock* clock = nullptr) const {
    const RowBands row_bands = bands();
    unsigned announced = 0;
    const auto lap = [&](std::size_t pass) {
      if (clock != nullptr && worker.first()) clock->lap(pass);
    };
    const auto over_rows = [&](std::size_t pass) { return static_cast<bool>(passes[pass].run_rows); };
    for (std::size_t i = first; i < last;) {
      std::size_t end = i + 1;
      if (over_rows(i)) {
        while (end < last && over_rows(end) && passes[end - 1].meeting == Meeting::none) ++end;
        const auto take = [&](Range some) {
          for (std::size_t k = i; k < end; ++k) {
            passes[k].run_rows(some);
            lap(k);
          }
        };
        if (const auto& after_ends = passes[end - 1].after_ends; after_ends && row_bands.below + row_bands.above > 0) {
          row_bands.for_ends(worker, take);
          const unsigned ends = barrier.arrive();
          if (worker.first()) barrier.wait(ends), after_ends();
          row_bands.for_middle(worker, take);
          barrier.wait(ends);
        } else {
          row_bands.for_each(worker, take);
        }
      } else {
        passes[i].run(worker);
      }
      switch (passes[end - 1].meeting) {
        case Meeting::all:
          barrier.arrive_and_wait();
          break;
        case Meeting::announce:
          announced = barrier.arrive();
          break;
        case Meeting::await:
          barrier.wait(announced);
          break;
        case Meeting::none:
          break;
      }
      lap(end - 1);
      i = end;
    }
  }
};

}  // namespace rouleau::core
