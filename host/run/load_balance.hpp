// When the ranks of a run are to be given other blocks, since some of them wait for others.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/domain/ranks.hpp"

namespace rouleau::run {

/// All ranks measure how long they compute, look at the same steps with the same numbers, and so come to the same
/// answer.
class LoadBalance {
 public:
  static constexpr double tolerance = 1.15;  ///< of the slowest rank's time over the mean
  static constexpr double patience = 10;     ///< what waiting has cost, over what a cut takes
  static constexpr int period = 16;          ///< looks: what a machine does for a moment is no reason

  /// Since begin() the slowest rank has computed for so long, and ranks on the average; cutting the lattice anew takes
  /// `cut`. Seconds.
  void look(double slowest, double mean, double cut) {
    slowest_ = slowest, mean_ = mean;
    ++looks_;
    due_ = slowest > tolerance * mean && slowest - mean > patience * cut;
  }
  [[nodiscard]] bool due() const { return due_; }
  /// Nobody has waited for long, and the next period may begin.
  [[nodiscard]] bool over() const { return looks_ >= period && !(slowest_ > tolerance * mean_); }
  /// 1 where nobody waits.
  [[nodiscard]] double slowest_over_mean() const { return mean_ > 0 ? slowest_ / mean_ : 1; }
  /// All begin to measure.
  void begin() { *this = {}; }

 private:
  double slowest_ = 0, mean_ = 0;
  int looks_ = 0;
  bool due_ = false;
};

/// When the ranks of a run get other blocks: between which two steps of a stage. All ranks call it together.
class Balance {
 public:
  /// All begin to measure. `computed`: what this rank has computed for so far, waiting for others left out; s.
  void begin(double computed) {
    computed_ = computed;
    load_.begin();
  }
  /// A solver for other blocks, or another stage, has been made in so many seconds.
  void made(double seconds) { cut_s_ = seconds, cut_at_ = never; }
  /// Whether some ranks wait so long for others that they are to get new blocks before the next step; `always`: they
  /// are.
  template <int D>
  void look(const core::Ranks<D>& ranks, double computed, long step, bool always) {
    const double own = computed - computed_;
    std::vector<core::ExactSum> sum(1);
    sum.front().add(own);
    core::add_up(ranks, sum);
    const auto [slowest, cut] = core::largest(ranks, std::array{own, cut_s_});
    load_.look(slowest, sum.front().value() / ranks.blocks->ranks(), cut);
    if (load_.over()) begin(computed);
    if (load_.due() || always) cut_at_ = step + 1;
  }
  /// The step before whose forces they get them.
  [[nodiscard]] long next() const { return cut_at_; }
  /// What each rank has computed for since all began to measure.
  template <int D>
  [[nodiscard]] std::vector<double> seconds(const core::Ranks<D>& ranks, double computed) const {
    std::vector<double> seconds;
    for (const std::vector<double>& of_rank : core::all_of(ranks, std::vector<double>{computed - computed_}))
      seconds.push_back(of_rank.front());
    return seconds;
  }
  [[nodiscard]] double slowest_over_mean() const { return load_.slowest_over_mean(); }

 private:
  static constexpr long never = std::numeric_limits<long>::max();
  LoadBalance load_;
  double cut_s_ = 0, computed_ = 0;
  long cut_at_ = never;
};

}  // namespace rouleau::run
