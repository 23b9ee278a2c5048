// What `rouleau run` says before the first step and behind the last one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "json/json.hpp"
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

}  // namespace rouleau::command
