// Times several candidates side by side: they take turns, so that what else the machine does hits all of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/worker.hpp"

namespace rouleau::bench {

/// One step of something, timed; what `between` does is not.
struct Candidate {
  std::string name;
  std::function<void(rouleau::Worker)> step;     ///< all threads
  std::function<void(rouleau::Worker)> between;  ///< all threads, after a barrier; may be empty
};

struct Timing {
  double best_s, median_s;  ///< of a step, over the rounds
};

double median(std::vector<double> values);

/// Runs every candidate for about `seconds`, split into rounds that alternate. One timing for each candidate.
std::vector<Timing> measure(const std::vector<Candidate>& candidates, int threads, double seconds);

}  // namespace rouleau::bench
