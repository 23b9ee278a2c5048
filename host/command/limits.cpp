// rouleau limits LIMITS: where a model breaks, and how.
#include <iostream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "command/process/interruption.hpp"
#include "command/process/terminal.hpp"
#include "commands.hpp"
#include "stability/limits_run.hpp"

namespace rouleau::command {

namespace {

constexpr const char* limits_help = R"(usage: rouleau limits LIMITS [options]

Increases one parameter of a scene until the simulation fails, and finds the edge by bisection, for each combination of
methods. A completed run counts as failed if it lost too much area, gained energy at rest,
has uneven nodes or wrote values that are not numbers. Writes limits.json, limits.csv and limits.html, which give reason
and step of each failure.

Finished trials are kept: after Ctrl-C the same command continues in the same directory.

Example:
  rouleau limits limits/stretching.json
  rouleau limits limits/shear-rate.json --out runs/shear-rate

Exit codes: 0 done, 2 bad input, 4 input/output, 130 interrupted
)";

}  // namespace

int limits_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  std::string file, out, max_time;
  trial::CampaignOptions chosen;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("limits", options::value(&file)->required(), "LIMITS file (JSON)")(
      "out", options::value(&out)->value_name("DIR")->notifier(not_empty("--out")),
      "directory (default: runs/NAME of the file)")(
      "max-time", options::value(&max_time)->value_name("TIME")->notifier(not_empty("--max-time")), TimeLimit::help)(
      "quiet", options::bool_switch(&chosen.quiet), "no lines on what is being tried");
  positional.add("limits", 1);
  if (!parse_command_line("limits", limits_help, arguments, description, positional)) return 0;

  const stability::LimitsFile limits = stability::read_limits(file);
  chosen.directory = out.empty() ? directory_for(file) : std::filesystem::path(out);
  chosen.interrupted = &listen_for_interruption(TimeLimit(max_time));
  stability::LimitsRun run(limits, chosen);
  const bool ended = run.run();
  std::cout << folded(stability::limits_text(stability::limits_json(run.state())), text_width())
            << (chosen.directory / "limits.html").string() << "\n";
  if (!ended) {
    std::cerr << "ended by " << interruption_cause() << "; the same command goes on\n";
    return exit_code::interrupted;
  }
  return exit_code::done;
}

}  // namespace rouleau::command
