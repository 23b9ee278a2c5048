// rouleau plan SCENE: everything a run would decide, without a step.
#include <iostream>
#include <optional>

#include "base/error.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "command/process/terminal.hpp"
#include "commands.hpp"
#include "plan/plan_report.hpp"
#include "plan/ranks/blocks.hpp"
#include "plan/ranks/rank_costs.hpp"
#include "plan/ranks/rank_times.hpp"
#include "run/step_time.hpp"
#include "scene_options.hpp"
#include "units/units.hpp"

namespace rouleau::command {

namespace {

constexpr const char* plan_help = R"(usage: rouleau plan SCENE [options]

Prints, without a step: every conversion, dimensionless number and limit (value, limit, margin), what will be
computed, what is left out and why, and the estimated time, memory and output size. Plugins that the scene names are
loaded and instances of them are made, so their code runs. With --ranks N also how the lattice would be cut for
mpirun -n N, what each rank would compute, send and hold, how long a step would take, and how many ranks are fastest.
With --measure N the time is that of the scene's own first steps by N threads, taken for a second and not kept.
Where a run would be refused for its nodes or its memory, the plan is printed and ends with that error.

Example:
  rouleau plan scenes/four-cells-shear.json
  rouleau plan scenes/four-cells-shear.json --set /numerics/density_factor=30000 --json
  rouleau plan scenes/four-cells-shear.json --measure 2
  rouleau plan scenes/four-cells-shear.json --ranks 8
  rouleau plan scenes/four-cells-shear.json --ranks 8 --rank 3 --network "2 us,10 GB/s"
)";

/// What is asked about several ranks.
struct RankOptions {
  std::optional<int> ranks, rank, processors;
  std::string network, step;

  void add_to(boost::program_options::options_description& description) {
    namespace options = boost::program_options;
    auto add = description.add_options();
    add("ranks", options::value<int>()->value_name("N")->notifier([this](int count) { ranks = count; }),
        "what a run by N ranks would ask of each of them, and how long a step would take");
    add("rank", options::value<int>()->value_name("K")->notifier([this](int number) { rank = number; }),
        "with --ranks: of rank K alone, 0 to N - 1");
    add("network", options::value(&network)->value_name("LATENCY,BANDWIDTH[,EACH]"),
        "with --ranks: what messages take, as rouleau-bench --only network prints it; without \"2 us,10 GB/s,0.5 us\"");
    add("processors", options::value<int>()->value_name("P")->notifier([this](int count) { processors = count; }),
        "with --ranks: so many processors for all ranks, which take turns; without it each rank has its own");
    add("step", options::value(&step)->value_name("TIME"),
        "with --ranks: what a step by one process takes, as measured, such as \"90 us\"; without it is estimated");
  }
  void check() const {
    if (!ranks && (rank || processors || !network.empty() || !step.empty()))
      throw Error(Cause::bad_input, "--rank, --network, --processors and --step are about several ranks",
                  {"add --ranks N"});
    if (processors && *processors < 1)
      throw Error(Cause::bad_input, "--processors " + std::to_string(*processors) + ": ranks need at least one");
    if (ranks && rank && (*rank < 0 || *rank >= *ranks)) {
      throw Error(Cause::bad_input, "--rank " + std::to_string(*rank) + ": there is no such rank",
                  {"ranks count from 0 to " + std::to_string(*ranks - 1)});
    }
  }
};

/// The answers.
class PlannedRanks {
 public:
  PlannedRanks(const RankOptions& options, const plan::Plan& plan)
      : rank_(options.rank),
        machines_{.network = options.network.empty() ? plan::Network{} : plan::read_network(options.network),
                  .processors = options.processors.value_or(0),
                  .one_step_s = step_of(options.step)},
        blocks_(plan::make_blocks(plan, *options.ranks)),
        costs_(plan::rank_costs(plan, blocks_)),
        times_(plan::rank_times(plan, costs_, machines_)) {}

  [[nodiscard]] nlohmann::json json() const {
    nlohmann::json object{{"balance", plan::balance(costs_)}, {"network", machines_.network}, {"times", times_}};
    if (machines_.processors > 0) object["processors"] = machines_.processors;
    if (rank_) {
      object["rank"] = costs_[*rank_];
      std::visit(
          [&](const auto& blocks) {
            const auto block = blocks.domain(*rank_).block;
            object["rank"]["first_node"] = block.begin;
            for (std::size_t k = 0; k < block.begin.size(); ++k)
              object["rank"]["size"].push_back(block.end[k] - block.begin[k]);
          },
          blocks_);
    } else {
      object["of_each"] = costs_;
    }
    return object;
  }
  [[nodiscard]] const plan::Blocks& blocks() const { return blocks_; }
  [[nodiscard]] std::string text() const {
    return (rank_ ? plan::to_text(costs_[*rank_], *rank_, blocks_) : plan::to_text(costs_)) +
           plan::to_text(times_, machines_);
  }

 private:
  static double step_of(const std::string& text) {
    if (text.empty()) return 0;
    try {
      const double step = units::Units().to_si(text, "s", "the time of a step");
      if (step > 0) return step;
    } catch (const units::UnitError& error) {
      throw Error(Cause::bad_input, std::string("--step: ") + error.what());
    }
    throw Error(Cause::bad_input, "--step: the time of a step is above zero");
  }

  std::optional<int> rank_;
  plan::Machines machines_;
  plan::Blocks blocks_;
  std::vector<plan::RankCost> costs_;
  plan::RankTimes times_;
};

std::string measured_in_words(const run::StepTime& time) {
  return "Measured here, " + std::to_string(time.steps) + " steps by " + std::to_string(time.threads) +
         (time.threads == 1 ? " thread: " : " threads: ") + time_in_words(time.wall_s) + " for the run, " +
         number(1e3 * time.step_s, 3) + " ms a step and " + number(1e3 * time.output_s, 3) + " ms an output\n";
}

}  // namespace

int plan_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  SceneOptions scene_options;
  bool json = false;
  std::optional<int> threads;
  RankOptions rank_options;
  options::options_description description("options");
  options::positional_options_description positional;
  scene_options.add_to(description, positional);
  description.add_options()("json", options::bool_switch(&json), "print JSON for programs")(
      "measure", options::value<int>()->value_name("N")->notifier([&](int count) { threads = count; }),
      "take steps for a second, by N threads, and plan with the time that they take");
  rank_options.add_to(description);
  if (!parse_command_line("plan", plan_help, arguments, description, positional)) return 0;
  rank_options.check();
  if (threads) check_threads("--measure", *threads);

  const PlannedScene planned(scene_options);
  std::optional<run::StepTime> measured;
  if (threads) {
    const int useful = useful_threads(planned.read.scene, *threads);
    require_startable(planned, nullptr, 1);
    require_threads("--measure", useful);
    measured = run::measure_steps(planned.plan, planned.report.estimate, useful);
  }
  std::optional<PlannedRanks> ranks;
  if (rank_options.ranks) ranks.emplace(rank_options, planned.plan);
  if (json) {
    nlohmann::json object = plan::to_json(planned.plan, planned.report);
    if (ranks) object["ranks"] = ranks->json();
    if (measured) object["estimate"]["measured"] = *measured;
    // Names of folders need not be UTF-8.
    std::cout << object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  } else {
    std::cout << folded(plan::to_text(planned.plan, planned.report) + (ranks ? ranks->text() : "") +
                            (measured ? measured_in_words(*measured) : ""),
                        text_width());
  }
  std::cout << std::flush;
  // What a run here would be refused for is; of several ranks nobody knows here what memory their machines have.
  if (ranks)
    plan::require_computable(planned.read.scene, &ranks->blocks());
  else
    require_startable(planned, nullptr, 1);
  return 0;
}

}  // namespace rouleau::command
