// A conformance check: what it asserts of a plugin, which checks it builds on, and what it found.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "plugin/manifest.hpp"

namespace rouleau::conform {

class Subject;

/// `publish`: for models that others will trust; all other levels, and their warnings count as failures.
enum class Level { interface, physics, robustness, speed, publish };
/// In the order in which they run.
inline constexpr std::array all_levels = {Level::interface, Level::physics, Level::robustness, Level::speed,
                                          Level::publish};
const char* to_string(Level level);

enum class Verdict {
  pass,
  warn,     ///< conforms, but somebody should know this
  fail,     ///< does not do what the interface or its manifest says
  crash,    ///< the check's process ended by a signal, by itself, or by an exception that left the plugin
  timeout,  ///< the check's process did not end in time and was killed with its group
  skip,     ///< not run: a check that it builds on did not pass, or it does not apply
};
const char* to_string(Verdict verdict);

/// What a check found. A check that measures gives the number and the limit that it was held against.
struct Finding {
  Verdict verdict = Verdict::pass;
  std::string what;  ///< what was measured or seen, one line
  std::optional<double> measured, limit;

  /// Passes when the number is at most the limit (and is a number); fails otherwise.
  static Finding at_most(double measured, double limit, std::string what);
  static Finding passed(std::string what) { return {Verdict::pass, std::move(what), {}, {}}; }
  static Finding warned(std::string what) { return {Verdict::warn, std::move(what), {}, {}}; }
  static Finding failed(std::string what) { return {Verdict::fail, std::move(what), {}, {}}; }
  static Finding skipped(std::string what) { return {Verdict::skip, std::move(what), {}, {}}; }
};

/// Whether a finding says more against a plugin than another: its verdict or, of the same, its measure over the limit.
bool worse(const Finding& a, const Finding& b);

struct Check {
  const char* name;
  Level level;
  const char* says;                ///< what is true of a plugin that passes
  std::vector<const char*> after;  ///< checks without which this one tells nothing; they stand before it in the list
  Finding (*run)(const Subject&);
  std::optional<plugin::ModelKind> kind = {};  ///< for models of this kind only
};

// The checks of each file of this folder; `all_checks` puts them in order.
std::vector<Check> interface_checks();
std::vector<Check> input_checks();
std::vector<Check> block_checks();
std::vector<Check> process_checks();
std::vector<Check> isolation_checks();
std::vector<Check> physics_checks();
std::vector<Check> role_checks();
std::vector<Check> collision_checks();
std::vector<Check> membrane_checks();
std::vector<Check> state_checks();
std::vector<Check> number_checks();
std::vector<Check> publish_checks();
std::vector<Check> interaction_checks();
std::vector<Check> speed_checks();

/// What a check finds. A model that claims not to be reproducible is not held to bits.
Finding run(const Check& check, const Subject& subject);

/// Every check, those that others build on first.
const std::vector<Check>& all_checks();
/// The check of that name, or null. Kinds may have different checks of one name.
const Check* find_check(const std::string& name, std::optional<plugin::ModelKind> kind = {});

}  // namespace rouleau::conform
