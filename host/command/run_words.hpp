// What `rouleau run` says before the first step and behind the last one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "accuracy/measure_errors.hpp"
#include "json/json.hpp"
#include "monitor/failure.hpp"
#include "plan/plan_report.hpp"

namespace rouleau::command {

/// Lines on what is about to be computed: title, size, cells, stages, steps, time, ranks, threads, and where it
/// goes. processors: how many the machine has.
std::string opening(const plan::Plan& plan, const plan::PlanReport& report, int ranks, int threads, int processors,
                    const std::filesystem::path& folder);

/// Lines on what came out, from summary.json: how the run ended and what it cost; the largest aggregate, when it formed
/// and broke; relative viscosity and area drift. What the run does not define is left out, as is a viscosity that has
/// an error bar: accuracy::sentences() says that one.
std::vector<std::string> closing(const nlohmann::json& summary);

/// Lines on the error bars of a run, or on why there are none.
std::vector<std::string> in_words(const accuracy::MeasuredErrors& errors);

/// Writes the report, and says what came out: the status in green or red, `more`, the report's path.
void close_run(const std::filesystem::path& folder, const std::vector<std::string>& more);

/// Says on standard error where and why a run diverged, and what to change.
void say(const monitor::Failure& failure);

}  // namespace rouleau::command
