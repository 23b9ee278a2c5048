// How long a step takes with several ranks: a model of what each computes, and of their messages.
#pragma once

#include <string>
#include <vector>

#include "json/json.hpp"
#include "rank_costs.hpp"

namespace rouleau::plan {

/// What is reckoned with: by default what is usual between the machines of a cluster; docs/results/scaling-2026-11.md.
struct Network {
  double latency_s = 2e-6;  ///< of a message that somebody waits for; where ranks take turns on processors, of a turn
  double bandwidth = 10e9;  ///< bytes/s that a rank sends and, at the same time, takes
  double each_s = 0.5e-6;   ///< of every further message
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Network, latency_s, bandwidth, each_s)
};

/// "2 us,10 GB/s" or "2 us,10 GB/s,0.5 us", as `rouleau-bench --only network` prints it. Throws Error(bad_input).
Network read_network(const std::string& text);

/// What messages add to a step of a rank that waits for no slower one, s.
double message_time(const RankCost& cost, const Network& network);

/// A step by so many ranks.
struct RankTime {
  int ranks = 1;
  double step_s = 0;
  double efficiency = 1;  ///< how many times as fast as one rank, over their number
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RankTime, ranks, step_s, efficiency)
};

struct RankTimes {
  std::vector<RankTime> of;  ///< by number of ranks
  int fastest = 1;           ///< ranks
  int economical = 1;        ///< the most that have an efficiency of a half
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(RankTimes, of, fastest, economical)
};

/// What ranks run on.
struct Machines {
  Network network;
  int processors = 0;     ///< that all ranks share; 0: each has its own
  double one_step_s = 0;  ///< a step by one rank, where it was measured; 0: by plan::step_cost
};

/// A step takes the longest computing and the longest messages of any rank, and computing twice: no rank goes on to the
/// lattice before the membranes around it have sent their forces. Ranks that share processors take as long as those of
/// the fullest processor, whichever they are: a rank that waits lets others run, and has looked for its message before.
/// `scale`: what a step by one rank takes, over plan::step_cost; ghosts cost more where own membranes do.
double step_time(const std::vector<RankCost>& ranks, const Machines& machines, double scale);

/// By the ranks asked for, whose costs are known, and by powers of two (of eight with very many cells) until more do
/// not help, have no room, are a waste, or are more than any machine has (2^17).
RankTimes rank_times(const Plan& plan, const std::vector<RankCost>& asked, const Machines& machines);

/// For people.
std::string to_text(const RankTimes& times, const Machines& machines);

}  // namespace rouleau::plan
