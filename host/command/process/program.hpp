// What belongs to the process: exit codes, and errors in the words of the command line.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "trial/trial.hpp"

namespace rouleau::command {

namespace exit_code = trial::exit_code;

/// With which code the program ends for an error.
int exit_code_of(Cause cause);

/// The remedy, with the options for its ways that the command has: "choose another directory (--out)".
std::string in_options(const Remedy& remedy);
/// Names of the options that the command of this process has, without dashes.
void know_options(std::vector<std::string> names);

/// Throws Error(bad_input) for a ROULEAU_INSTRUCTION_SET that there is not, or that this processor does not have.
void check_instruction_set();

/// Calls a program's body and returns its exit code. What the body throws becomes a message on standard error, and so
/// does an output that could not be written. `too_large`: what to do where memory does not suffice. Where the
/// environment has ROULEAU_ERRORS=json, an Error becomes one line of JSON: {"exit_code", "faults": [{"file", "pointer",
/// "line", "column", "problem", "remedy"}]}, with "" and 0 for what is unknown,
/// and "rank" where a rank other than the first has failed.
int run_program(const std::function<int()>& body, const std::string& too_large);

}  // namespace rouleau::command
