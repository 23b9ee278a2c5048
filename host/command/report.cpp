#include "run/report.hpp"

#include <iostream>

#include "command/commands.hpp"
#include "error.hpp"

namespace rouleau::host {

namespace {

constexpr const char* usage =
    "Usage: rouleau report DIR\n"
    "\n"
    "(Re)makes DIR/report.html from the files a run has left in DIR, and prints its path.\n"
    "The page is self-contained: one file, no network. A run that was killed has a report too.\n"
    "\n"
    "  --help    this text\n"
    "\n"
    "Example: rouleau report runs/demo\n";

}  // namespace

int report_command(const std::vector<std::string>& arguments) {
  std::string directory;
  for (const auto& argument : arguments) {
    if (argument == "--help" || argument == "-h") {
      std::cout << usage;
      return static_cast<int>(ExitCode::done);
    }
    if (argument.starts_with('-'))
      throw Error(ExitCode::bad_input, "rouleau report has no option \"" + argument + "\"\n\n" + usage);
    if (!directory.empty())
      throw Error(ExitCode::bad_input, "rouleau report takes one directory, not also \"" + argument + "\"\n\n" + usage);
    directory = argument;
  }
  if (directory.empty()) throw Error(ExitCode::bad_input, std::string("rouleau report wants a directory\n\n") + usage);
  std::cout << write_report(directory).string() << "\n";
  return static_cast<int>(ExitCode::done);
}

}  // namespace rouleau::host
