// How `rouleau run` ends each of its runs: the one that was asked for, and a refined one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "accuracy/measure_errors.hpp"
#include "monitor/failure.hpp"

namespace rouleau::command {

/// Lines on the error bars of a run, or on why there are none.
std::vector<std::string> in_words(const accuracy::MeasuredErrors& errors);

/// Writes the report, and says what came out: the status in green or red, `more`, the report's path.
void close_run(const std::filesystem::path& folder, const std::vector<std::string>& more);

/// Says on standard error where and why a run diverged, and what to change.
void say(const monitor::Failure& failure);

}  // namespace rouleau::command
