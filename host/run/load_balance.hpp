// When the ranks of a run are to be given other blocks, since some of them wait for others.
#pragma once

namespace rouleau::run {

/// All ranks measure how long they compute, look at the same steps with the same numbers, and so come to the same answer.
class LoadBalance {
 public:
  static constexpr double tolerance = 1.15;  ///< of the slowest rank's time over the mean
  static constexpr double patience = 10;     ///< what waiting has cost, over what a cut takes
  static constexpr int period = 16;          ///< looks: what a machine does for a moment is no reason

  /// Since begin() the slowest rank has computed for so long, and ranks on the average; cutting the lattice anew takes `cut`.
  /// Seconds.
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

}  // namespace rouleau::run
