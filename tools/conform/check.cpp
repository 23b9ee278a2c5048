#include "check.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

#include "subject.hpp"

namespace rouleau::conform {

const char* to_string(Level level) {
  switch (level) {
    case Level::interface:
      return "interface";
    case Level::physics:
      return "physics";
    case Level::robustness:
      return "robustness";
    case Level::speed:
      return "speed";
    case Level::publish:
      return "publish";
  }
  return "unknown";
}

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::warn:
      return "warn";
    case Verdict::fail:
      return "fail";
    case Verdict::crash:
      return "crash";
    case Verdict::timeout:
      return "timeout";
    case Verdict::skip:
      return "skip";
  }
  return "unknown";
}

Finding run(const Check& check, const Subject& subject) {
  // Of bits: who does not promise them is not held to them.
  const std::set<std::string> of_bits = {"blocks",          "bounds",       "aliasing",        "contained",
                                         "threads",         "struct-size",  "declared-inputs", "outputs-optional",
                                         "energy-optional", "rigid-motion", "state-restored",  "fluid-independent",
                                         "surroundings"};
  if (!subject.manifest().claims.value("reproducible", true)) {
    if (check.name == std::string("hidden-state")) {
      return Finding::warned("claims not to be reproducible: runs with it cannot be repeated, resumed or compared");
    }
    if (of_bits.contains(check.name)) return Finding::skipped("claims not to be reproducible");
  }
  return check.run(subject);
}

bool worse(const Finding& a, const Finding& b) {
  const auto rank = [](Verdict verdict) {
    constexpr std::array rising = {Verdict::skip,    Verdict::pass,  Verdict::warn,
                                   Verdict::timeout, Verdict::crash, Verdict::fail};
    return std::find(rising.begin(), rising.end(), verdict) - rising.begin();
  };
  if (a.verdict != b.verdict) return rank(a.verdict) > rank(b.verdict);
  const auto share = [](const Finding& f) { return f.measured && f.limit ? *f.measured / *f.limit : 0; };
  return share(a) > share(b);
}

Finding Finding::at_most(double measured, double limit, std::string what) {
  return {measured <= limit ? Verdict::pass : Verdict::fail, std::move(what), measured, limit};
}

namespace {

/// The order of the files, but for checks that must wait for those that they build on.
std::vector<Check> foundations_first(std::vector<Check> checks) {
  std::vector<Check> ordered;
  const auto is_placed = [&](const char* name) {
    return std::any_of(ordered.begin(), ordered.end(), [&](const Check& c) { return std::string(c.name) == name; });
  };
  while (!checks.empty()) {
    const auto ready = std::find_if(checks.begin(), checks.end(), [&](const Check& check) {
      return std::all_of(check.after.begin(), check.after.end(), is_placed);
    });
    if (ready == checks.end()) throw std::logic_error(std::string(checks.front().name) + " builds on itself");
    ordered.push_back(*ready);
    checks.erase(ready);
  }
  return ordered;
}

}  // namespace

const std::vector<Check>& all_checks() {
  static const std::vector<Check> checks = [] {
    std::vector<Check> all;
    for (auto& part : {interface_checks(), collision_checks(), membrane_checks(), interaction_checks(), state_checks(),
                       physics_checks(), role_checks(), block_checks(), input_checks(), number_checks(),
                       process_checks(), isolation_checks(), speed_checks(), publish_checks()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return foundations_first(std::move(all));
  }();
  return checks;
}

const Check* find_check(const std::string& name, std::optional<plugin::ModelKind> kind) {
  const auto& checks = all_checks();
  const auto found = std::find_if(checks.begin(), checks.end(), [&](const Check& check) {
    return check.name == name && (!kind || !check.kind || check.kind == kind);
  });
  return found == checks.end() ? nullptr : &*found;
}

}  // namespace rouleau::conform
