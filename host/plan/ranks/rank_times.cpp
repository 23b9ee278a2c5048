#include "rank_times.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>

#include "base/error.hpp"
#include "base/text.hpp"
#include "blocks.hpp"
#include "scene/lattice.hpp"
#include "units/units.hpp"

namespace rouleau::plan {

namespace {

constexpr double wasteful = 0.1;             ///< efficiency; nobody would start as many
constexpr double slower = 1.3;               ///< than the fastest: more ranks will not help
constexpr int largest_machine = 1 << 17;     ///< ranks; more are planned for when they are asked for
constexpr std::size_t many_cells = 100'000;  ///< cells; powers of eight have to do, each takes seconds

/// A part of a step, of which every rank has its own, and whose end all wait for.
class Part {
 public:
  void add(double time) {
    longest_ = std::max(longest_, time);
    sum_ += time;
    squares_ += time * time;
    ++ranks_;
  }
  /// On processors that have each as many ranks as the others, or one less, but which of them nobody knows: what is to
  /// be expected of the one that takes longest. 0: each rank has its own.
  [[nodiscard]] double time(int processors) const {
    if (processors == 0 || processors >= ranks_) return longest_;
    const double mean = sum_ / ranks_, variance = std::max(0.0, squares_ / ranks_ - mean * mean),
                 drawn = std::ceil(static_cast<double>(ranks_) / processors),  // without putting one back
        deviation = std::sqrt(drawn * variance * (ranks_ - drawn) / std::max(1, ranks_ - 1));
    // The largest of n normal variables is about sqrt(ln n) deviations above their mean; of two that add up to the
    // same, 0.8.
    return std::max(longest_, drawn * mean + std::sqrt(std::log(processors)) * deviation);
  }

 private:
  double longest_ = 0, sum_ = 0, squares_ = 0;
  int ranks_ = 0;
};

}  // namespace

Network read_network(const std::string& text) {
  const auto refuse = [&](const std::string& problem) -> double {
    throw Error(
        Cause::bad_input, "the network " + in_quotes(text) + ": " + problem,
        {"give latency and bandwidth, such as \"2 us,10 GB/s\", and, if known, the time of each further message"});
  };
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, comma - begin));
    if (comma == text.size()) break;
    begin = comma + 1;
  }
  if (parts.size() < 2 || parts.size() > 3) refuse("it has " + std::to_string(parts.size()) + " values");
  const units::Units units;
  const auto in_si = [&](const std::string& value, const char* unit, const char* name) {
    try {
      const double result = units.to_si(value, unit, name);
      return result > 0 ? result : refuse(std::string(name) + " is not above zero");
    } catch (const units::UnitError& error) {
      return refuse(error.what());
    }
  };
  Network network;
  network.latency_s = in_si(parts[0], "s", "latency");
  // UDUNITS has no byte: its prefix and "B/s" are one for it without unit.
  constexpr std::string_view per_second = "B/s";
  std::string rate = parts[1];
  const std::size_t at = rate.rfind(per_second);
  if (at == std::string::npos || at + per_second.size() != rate.size()) refuse("the bandwidth ends with B/s");
  network.bandwidth = in_si(rate.replace(at, per_second.size(), "Hz"), "Hz", "bandwidth");
  network.each_s = parts.size() == 3 ? in_si(parts[2], "s", "time of each message") : network.latency_s / 4;
  return network;
}

double message_time(const RankCost& cost, const Network& network) {
  const double further = std::max(0.0, static_cast<double>(cost.messages - cost.waits));
  return static_cast<double>(cost.messages > 0 ? cost.waits : 0) * network.latency_s + further * network.each_s +
         (cost.sent_bytes() + cost.received_bytes) / 2 / network.bandwidth;
}

double step_time(const std::vector<RankCost>& ranks, const Machines& machines, double scale) {
  Part membranes, lattice, messages;
  for (const RankCost& rank : ranks) {
    membranes.add(rank.membranes_s * scale);
    lattice.add((rank.step_s - rank.membranes_s + rank.ghosts_s) * scale + rank.sharing_s - rank.ghosts_s);
    messages.add(message_time(rank, machines.network));
  }
  // No message is taken to be behind computing.
  return membranes.time(machines.processors) + lattice.time(machines.processors) + messages.time(machines.processors);
}

RankTimes rank_times(const Plan& plan, const std::vector<RankCost>& asked, const Machines& machines) {
  const int most = most_blocks(plan), wanted = static_cast<int>(asked.size());
  std::map<int, double> steps;
  const double by_estimate = step_time(rank_costs(plan, make_blocks(plan, 1)), machines, 1);
  const double scale = machines.one_step_s > 0 ? machines.one_step_s / by_estimate : 1;
  double least = steps[1] = by_estimate * scale;
  steps[wanted] = step_time(asked, machines, scale);
  const int factor = plan.scene->cells.size() > many_cells ? 8 : 2;
  for (int ranks = factor; ranks <= std::min(most, largest_machine); ranks *= factor) {
    if (ranks < scene::fewest_ranks(plan.scene->domain)) continue;
    if (ranks != wanted) steps[ranks] = step_time(rank_costs(plan, make_blocks(plan, ranks)), machines, scale);
    if (steps[ranks] > slower * least || steps[1] < wasteful * ranks * steps[ranks]) break;
    least = std::min(least, steps[ranks]);
  }
  RankTimes times;
  for (const auto& [ranks, step] : steps) {
    times.of.push_back({ranks, step, steps[1] / step / ranks});
    if (step < steps[times.fastest]) times.fastest = ranks;
    if (times.of.back().efficiency >= 0.5) times.economical = ranks;
  }
  return times;
}

std::string to_text(const RankTimes& times, const Machines& machines) {
  const Network& network = machines.network;
  const std::string processors = machines.processors == 0 ? "a core for each rank"
                                 : machines.processors == 1
                                     ? "one processor for all ranks"
                                     : std::to_string(machines.processors) + " processors for all ranks";
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "\nTime of a step, with %s, messages of %s us and %s GB/s\n"
                "  %-12s %14s %12s\n",
                processors.c_str(), number(network.latency_s * 1e6, 3).c_str(),
                number(network.bandwidth / 1e9, 3).c_str(), "ranks", "a step, us", "efficiency");
  std::string out = text.data();
  for (const RankTime& time : times.of) {
    std::string remark = time.ranks == times.fastest ? "   the fastest" : "";
    if (time.ranks == times.economical) remark += "   the most that are half used";
    std::snprintf(text.data(), text.size(), "  %-12d %14.2f %12.3f%s\n", time.ranks, time.step_s * 1e6, time.efficiency,
                  remark.c_str());
    out += text.data();
  }
  return out;
}

}  // namespace rouleau::plan
