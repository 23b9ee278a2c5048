// The program: finds the command, and calls it.
#include <array>
#include <csignal>
#include <iostream>
#include <rouleau/dispatch.hpp>
#include <string>
#include <vector>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "command/commands.hpp"
#include "command/process/crew.hpp"
#include "command/process/faults.hpp"
#include "command/process/program.hpp"
#include "command/process/terminal.hpp"
#include "observe/observables.hpp"
#include "run/provenance.hpp"
#include "transport/connection.hpp"

namespace {

using namespace rouleau;
using namespace rouleau::command;

struct Command {
  const char* name;
  const char* arguments;
  const char* summary;
  int (*run)(const std::vector<std::string>& arguments);
};

constexpr std::array commands{
    Command{"run", "SCENE", "simulate a scene", run_command},
    Command{"plan", "SCENE", "what a run would compute, leave out and take", plan_command},
    Command{"plugins", "[ID]", "models that were found, why some were refused; locks", plugins_command},
    Command{"conform", "MANIFEST...", "whether plugins do what interface and manifest say", conform_command},
    Command{"new", "KIND NAME", "a new model's source, or a scene, to begin from", new_command},
    Command{"study", "STUDY", "error against run time over a matrix of settings", study_command},
    Command{"limits", "LIMITS", "where a simulation becomes unstable, and how", limits_command},
    Command{"verify", "DIR", "whether a finished run's files are what it wrote", verify_command},
    Command{"report", "DIR", "a run's page again, two runs side by side, or pictures", report_command},
};

std::string overview() {
  std::string text =
      "Rouleau simulates deformable red blood cells that attract each other while they flow, in 2D and 3D.\n\n"
      "Usage: rouleau COMMAND ...\n\n";
  for (const Command& command : commands) {
    std::string call = std::string(command.name) + ' ' + command.arguments;
    call.resize(std::max<std::size_t>(call.size() + 2, 22), ' ');
    text += "  " + call + command.summary + '\n';
  }
  return text +
         "\n"
         "  --help, -h    this text; after a command: its own help\n"
         "  --version     the program's version, compiler and instruction set\n\n"
         "Start here: rouleau run scenes/four-cells-shear.json, then open the report that it names.\n"
         "Pages: docs/first-run.md and docs/tutorial.md; when installed, in share/doc/Rouleau.\n";
}

int dispatch(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    std::cerr << reflowed(overview(), text_width(100));
    return exit_code::bad_input;
  }
  const std::string& word = arguments.front();
  if (word == "--help" || word == "-h") {
    std::cout << reflowed(overview(), text_width(100));
    return exit_code::done;
  }
  if (word == "--version") {
    std::cout << "rouleau " ROULEAU_VERSION "\nbuilt from " << run::program_version()
              << " by compiler " __VERSION__ "; vector loops run with " << name_of(instruction_set()) << '\n';
    return exit_code::done;
  }
  if (word == "columns") {  // for scripts/docs, not for users
    std::cout << observe::columns_json() << '\n';
    return exit_code::done;
  }
  std::vector<std::string> names;
  for (const Command& command : commands) {
    if (word == command.name) return command.run({arguments.begin() + 1, arguments.end()});
    names.emplace_back(command.name);
  }
  const bool is_option = word.starts_with('-');
  if (is_option) names = {"--help", "--version"};
  throw Error(Cause::bad_input,
              std::string("rouleau has no ") + (is_option ? "option " : "command ") + in_quotes(word) +
                  did_you_mean(word, names),
              {"rouleau --help shows what there is"});
}

/// Of several processes that a launcher has started those that run a scene do it together. What they would take from
/// each other is refused on each, and anything else each does by itself.
void join_ranks(const transport::Launch& launch, const std::vector<std::string>& arguments) {
  const std::string command = arguments.empty() ? "" : arguments.front();
  if (command == "run") Crew::join(launch);
  if (command != "study" && command != "limits" && command != "new") return;
  throw Error(Cause::bad_input,
              "rouleau " + command + " is work for one process and cannot be cut into ranks; this is rank " +
                  std::to_string(launch.rank) + " of " + launch.launcher,
              {"start it without " + launch.command +
               ", or with ROULEAU_LAUNCHER=none in the environment where this process is to be alone"});
}

}  // namespace

int main(int count, char** words) {
  name_culprits();
  take_terminal();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a full disk, with a message
  const int code = run_program(
      [&] {
        const std::vector<std::string> arguments(words + (count > 0 ? 1 : 0), words + count);
        if (const auto launch = transport::launched()) join_ranks(*launch, arguments);
        check_instruction_set();
        return dispatch(arguments);
      },
      "; \"rouleau plan\" says how much a scene needs");
  if (Crew* const crew = Crew::present()) crew->leave();
  expect_end();
  return code;
}
