// When the ranks of a run are to be given other blocks, since some of them wait for others.
#pragma once

namespace rouleau::run {

/// All ranks measure how long they compute from one look to the next, look at the same steps with the same numbers, and so
/// come to the same answer.
class LoadBalance {
 public:
  static constexpr double tolerance = 1.15;  ///< of the slowest rank's time over the mean
  static constexpr double patience = 10;     ///< what waiting has cost since the last cut, over what a cut takes

  /// Since the last look the slowest rank has computed for so long, and ranks on the average; cutting the lattice anew takes
  /// `cut`. Seconds.
  void look(double slowest, double mean, double cut) {
    slowest_ = slowest, mean_ = mean;
    lost_ += slowest - mean;
    due_ = slowest > tolerance * mean && lost_ > patience * cut;
  }
  [[nodiscard]] bool due() const { return due_; }
  /// At the last look: 1 where nobody waits.
  [[nodiscard]] double slowest_over_mean() const { return mean_ > 0 ? slowest_ / mean_ : 1; }
  /// The lattice has been cut anew.
  void begin_again() { due_ = false, lost_ = 0; }

 private:
  double slowest_ = 0, mean_ = 0, lost_ = 0;
  bool due_ = false;
};

}  // namespace rouleau::run
