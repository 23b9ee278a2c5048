// rouleau report DIR: the page about a run, made again from the run's files.
#include "output/report.hpp"

#include <iostream>

#include "command/command_line.hpp"
#include "command/commands.hpp"
#include "error.hpp"

namespace rouleau::host {

namespace {

constexpr const char* help = R"(usage: rouleau report DIR

(Re)makes DIR/report.html from the files a run has left in DIR, and prints its path. The page is one file that needs
no network. A run that was killed has a report too.

Example:
  rouleau report runs/demo
)";

}  // namespace

int report_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  std::string directory;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("directory", options::value(&directory)->required(), "run's directory DIR");
  positional.add("directory", 1);
  if (!parse_command_line("report", help, arguments, description, positional)) return 0;

  std::cout << write_report(directory).string() << "\n";
  return static_cast<int>(ExitCode::done);
}

}  // namespace rouleau::host
