// The program: finds the command, calls it, and turns what it throws into a message and an exit code.
#include <array>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "command/commands.hpp"
#include "observe/observables.hpp"

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
    Command{"plan", "SCENE", "what a run would compute, leave out and cost, without stepping", plan_command},
    Command{"plugins", "[ID]", "models that were found, why some were refused; locks", plugins_command},
    Command{"conform", "MANIFEST...", "whether plugins do what the interface and their manifests say", conform_command},
    Command{"new", "KIND NAME", "source, manifest and build file of a new model", new_command},
    Command{"study", "STUDY", "error against run time over a matrix of settings", study_command},
    Command{"limits", "LIMITS", "where a model breaks, and how", limits_command},
    Command{"report", "DIR", "a run's page again, two runs side by side, or frames as pictures", report_command},
};

std::string overview() {
  std::string text =
      "Rouleau simulates deformable red blood cells that attract each other while they flow.\n\n"
      "Usage: rouleau COMMAND ...\n\n";
  for (const Command& command : commands) {
    std::string call = std::string(command.name) + ' ' + command.arguments;
    call.resize(std::max<std::size_t>(call.size() + 2, 22), ' ');
    text += "  " + call + command.summary + '\n';
  }
  return text +
         "\n"
         "  --help        this text; after a command: its own help\n"
         "  --version     the program's version\n\n"
         "Example: rouleau run scenes/four-cells-shear.json\n";
}

int dispatch(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    std::cerr << overview();
    return static_cast<int>(ExitCode::bad_input);
  }
  const std::string& word = arguments.front();
  if (word == "--help" || word == "-h") {
    std::cout << overview();
    return static_cast<int>(ExitCode::done);
  }
  if (word == "--version") {
    std::cout << "rouleau " ROULEAU_VERSION "\n";
    return static_cast<int>(ExitCode::done);
  }
  if (word == "columns") {  // for scripts/docs, not for users
    std::cout << observe::columns_json() << '\n';
    return static_cast<int>(ExitCode::done);
  }
  std::vector<std::string> names;
  for (const Command& command : commands) {
    if (word == command.name) return command.run({arguments.begin() + 1, arguments.end()});
    names.emplace_back(command.name);
  }
  const bool is_option = word.starts_with('-');
  if (is_option) names = {"--help", "--version"};
  throw Error(ExitCode::bad_input, std::string("rouleau has no ") + (is_option ? "option " : "command ") +
                                       in_quotes(word) + did_you_mean(word, names) +
                                       "\n  rouleau --help shows what there is");
}

int report(const std::string& message, ExitCode code) {
  std::cerr << message << '\n';
  return static_cast<int>(code);
}

}  // namespace

int main(int count, char** words) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error like a full disk, with a message
  try {
    const int code = dispatch({words + (count > 0 ? 1 : 0), words + count});
    std::cout.flush();
    // A full disk or a closed pipe must not look like success to the script that reads the output.
    if (!std::cout) return report("rouleau: the output could not be written", ExitCode::input_output);
    return code;
  } catch (const Error& error) {
    return report(error.what(), error.code());
  } catch (const std::bad_alloc&) {
    return report("rouleau: there is not enough memory; \"rouleau plan\" says how much a scene needs",
                  ExitCode::input_output);
  } catch (const std::filesystem::filesystem_error& error) {
    return report(std::string("rouleau: ") + error.what(), ExitCode::input_output);
  } catch (const std::exception& error) {
    return report(std::string("rouleau: internal error, please report it: ") + error.what(), ExitCode::input_output);
  }
}
