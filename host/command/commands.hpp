// The commands of the program; each is one file of this folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "command/process/program.hpp"

namespace rouleau::command {

// Each takes the arguments after the command's name, prints its own help for --help, returns the exit code, and throws
// Error for what the user should know.

int run_command(const std::vector<std::string>& arguments);
int plan_command(const std::vector<std::string>& arguments);
int plugins_command(const std::vector<std::string>& arguments);
int conform_command(const std::vector<std::string>& arguments);
int new_command(const std::vector<std::string>& arguments);
int study_command(const std::vector<std::string>& arguments);
int limits_command(const std::vector<std::string>& arguments);
int verify_command(const std::vector<std::string>& arguments);
int report_command(const std::vector<std::string>& arguments);

/// The program that checks plugins. Throws Error(input_output) where it was not built.
std::filesystem::path conform_program();

}  // namespace rouleau::command
