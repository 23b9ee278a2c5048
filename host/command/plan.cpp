// rouleau plan SCENE: everything a run would decide, without a step.
#include <iostream>

#include "command_line.hpp"
#include "commands.hpp"
#include "plan/plan_report.hpp"
#include "scene_options.hpp"

namespace rouleau::command {

namespace {

constexpr const char* plan_help = R"(usage: rouleau plan SCENE [options]

Prints, without a step: every conversion, dimensionless number and limit (value, limit, margin), what will be
computed, what is left out and why, and the estimated time, memory and output size. Plugins that the scene names are
loaded and instances of them are made, so their code runs.

Example:
  rouleau plan scenes/four-cells-shear.json
  rouleau plan scenes/four-cells-shear.json --set /numerics/density_factor=30000 --json
)";

}  // namespace

int plan_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  SceneOptions scene_options;
  bool json = false;
  options::options_description description("options");
  options::positional_options_description positional;
  scene_options.add_to(description, positional);
  description.add_options()("json", options::bool_switch(&json), "print JSON for programs");
  if (!parse_command_line("plan", plan_help, arguments, description, positional)) return 0;

  const plan::ReadScene read = scene_options.read();
  const plugin::Catalog catalog = scene_options.catalog(read.scene);
  const plan::Plan plan = plan_and_place(read, catalog);
  const plan::PlanReport report = plan::make_report(plan);
  if (json) {
    // Names of folders need not be UTF-8.
    std::cout << plan::to_json(plan, report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  } else {
    std::cout << plan::to_text(plan, report);
  }
  return 0;
}

}  // namespace rouleau::command
