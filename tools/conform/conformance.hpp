// Runs the conformance checks of plugins, each in its own process. Nothing here loads a plugin.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "check.hpp"

namespace rouleau::conform {

struct ConformanceOptions {
  std::set<std::string> only;  ///< names of checks; empty: all. These run whatever they build on.
  std::set<Level> levels;      ///< empty: all but publish. What the checks of a level build on runs, too.
  std::uint64_t seed = 0;
  double time_limit_s = 20;  ///< of one check
};

struct CheckResult {
  const Check* check;
  Finding finding;
  std::string blocked_by;  ///< the check whose failure made this one be skipped
  std::string output;      ///< what the plugin printed
  double wall_s = 0;
};

struct Conformance {
  std::filesystem::path file;
  std::string id, version, kind;  ///< empty when the manifest cannot be read
  std::vector<int> dimensions = {2};
  std::vector<CheckResult> results;

  /// How many checks ended with a verdict.
  [[nodiscard]] int count(Verdict verdict) const;
  /// No check failed, crashed or timed out.
  [[nodiscard]] bool conforms() const;
};

/// Checks the plugins of these manifests one after another. `watch` gets each result as it comes, with the conformance
/// so far. Throws Error(input_output) when the program of the checks cannot be started.
std::vector<Conformance> check_conformance(const std::vector<std::filesystem::path>& manifests,
                                           const ConformanceOptions& options,
                                           const std::function<void(const Conformance&, const CheckResult&)>& watch);

}  // namespace rouleau::conform
