// rouleau plan SCENE: everything a run would decide, without a step.
#include <iostream>
#include <optional>

#include "command/process/command_line.hpp"
#include "commands.hpp"
#include "plan/blocks.hpp"
#include "plan/plan_report.hpp"
#include "plan/rank_costs.hpp"
#include "scene_options.hpp"

namespace rouleau::command {

namespace {

constexpr const char* plan_help = R"(usage: rouleau plan SCENE [options]

Prints, without a step: every conversion, dimensionless number and limit (value, limit, margin), what will be
computed, what is left out and why, and the estimated time, memory and output size. Plugins that the scene names are
loaded and instances of them are made, so their code runs. With --ranks N also how the lattice would be cut for
mpirun -n N, and what each rank would compute, send and hold.

Example:
  rouleau plan scenes/four-cells-shear.json
  rouleau plan scenes/four-cells-shear.json --set /numerics/density_factor=30000 --json
  rouleau plan scenes/four-cells-shear.json --ranks 8
)";

}  // namespace

int plan_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  SceneOptions scene_options;
  bool json = false;
  std::optional<int> ranks;
  options::options_description description("options");
  options::positional_options_description positional;
  scene_options.add_to(description, positional);
  description.add_options()("json", options::bool_switch(&json), "print JSON for programs")(
      "ranks", options::value<int>()->value_name("N")->notifier([&](int count) { ranks = count; }),
      "what a run by N ranks would ask of each of them");
  if (!parse_command_line("plan", plan_help, arguments, description, positional)) return 0;

  const PlannedScene planned(scene_options);
  std::vector<plan::RankCost> costs;
  if (ranks) costs = plan::rank_costs(planned.plan, plan::make_blocks(planned.plan, *ranks));
  if (json) {
    nlohmann::json object = plan::to_json(planned.plan, planned.report);
    if (!costs.empty()) object["ranks"] = {{"balance", plan::balance(costs)}, {"of_each", costs}};
    // Names of folders need not be UTF-8.
    std::cout << object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  } else {
    std::cout << plan::to_text(planned.plan, planned.report) << (costs.empty() ? "" : plan::to_text(costs));
  }
  return 0;
}

}  // namespace rouleau::command
