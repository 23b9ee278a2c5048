// rouleau verify DIR: whether a finished run is what it was when it ended.
#include <iostream>

#include "command/process/command_line.hpp"
#include "commands.hpp"
#include "files/verify.hpp"

namespace rouleau::command {

namespace {

constexpr const char* verify_help = R"(usage: rouleau verify DIR

Compares every file that a finished run has written with the checksums in its summary.json, and that with its own.
report.html is made from the others and is not among them: rouleau report DIR writes it anew.

Checksums are XXH3 with 64 bits (xxhsum -H3 prints the same): they find accidents, not somebody who changes them as
well.

Example:
  rouleau verify runs/four-cells-shear

Exit codes: 0 all is as it was written, 1 something differs, 2 no finished run with checksums, 4 input/output
)";

}  // namespace

int verify_command(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  std::string directory;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("directory", options::value(&directory)->required(), "");
  positional.add("directory", 1);
  if (!parse_command_line("verify", verify_help, arguments, description, positional)) return 0;

  const files::Verification found = files::verify(directory);
  for (const std::string& difference : found.differences) std::cout << difference << '\n';
  if (!found.differences.empty()) return exit_code::simulation_failed;
  std::cout << found.files << " files are as the run wrote them\n";
  return exit_code::done;
}

}  // namespace rouleau::command
