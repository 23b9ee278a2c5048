#include "measure.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "core/solver/barrier.hpp"

namespace rouleau::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int rounds = 9;

/// Mean time of a step.
double time_steps(const Candidate& candidate, int threads, long steps) {
  double total = 0;
  std::optional<core::Barrier> barrier;
#pragma omp parallel num_threads(threads)
  {
#pragma omp single
    barrier.emplace(omp_get_num_threads());
    const Worker worker{omp_get_thread_num(), omp_get_num_threads()};
    for (long i = 0; i < steps; ++i) {
      const auto start = Clock::now();
      candidate.step(worker);
      barrier->arrive_and_wait();
      if (worker.first()) total += std::chrono::duration<double>(Clock::now() - start).count();
      if (candidate.between) candidate.between(worker);
      barrier->arrive_and_wait();
    }
  }
  return total / static_cast<double>(steps);
}

}  // namespace

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::vector<Timing> measure(const std::vector<Candidate>& candidates, int threads, double seconds) {
  std::vector<long> steps;
  for (const Candidate& candidate : candidates) {
    time_steps(candidate, threads, 2);  // memory, clock
    const double once = time_steps(candidate, threads, 2);
    steps.push_back(std::max(2L, static_cast<long>(seconds / rounds / std::max(once, 1e-7))));
  }
  std::vector<std::vector<double>> times(candidates.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < candidates.size(); ++i)
      times[i].push_back(time_steps(candidates[i], threads, steps[i]));
  }
  std::vector<Timing> result;
  for (const std::vector<double>& of_one : times)
    result.push_back({*std::min_element(of_one.begin(), of_one.end()), median(of_one)});
  return result;
}

}  // namespace rouleau::bench
