// The program that rouleau conform becomes: whether plugins do what the interface and their manifests say.
#include <iostream>
#include <random>

#include "base/error.hpp"
#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "command/process/program.hpp"
#include "command/process/terminal.hpp"
#include "conform/conformance.hpp"
#include "conform/report_line.hpp"
#include "json/json.hpp"

namespace {

using namespace rouleau;

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string help() {
  std::string text = R"(usage: rouleau conform MANIFEST... [options]

Checks whether plugins keep to the interface and to their own manifests. Each check runs in its own process. When its
time is up, that process and everything it started are killed, so a plugin that crashes, hangs or overwrites memory does
no harm.
Verdicts: pass, warn, fail, crash, timeout, and skip (the check does not apply, or a check that it needs did not pass).
The exit code is 0 if every plugin conforms (warnings are allowed), and 3 if one does not.

Example:
  rouleau conform lib/rouleau/plugins/interaction/morse/morse.json --level physics

Checks, by level. A plugin passes a check if it
)";
  for (const conform::Level level : conform::all_levels) {
    text += std::string("  ") + conform::to_string(level) + '\n';
    for (const conform::Check& check : conform::all_checks()) {
      if (check.level != level) continue;
      std::string name = check.name;
      name.resize(20, ' ');
      text += "    " + name + check.says +
              (check.kind ? std::string(" (") + plugin::to_string(*check.kind) + ')' : "") + '\n';
    }
  }
  return text;
}

std::string repeat(const conform::Conformance& plugin, const conform::CheckResult& result, std::uint64_t seed) {
  return "rouleau conform " + plugin.file.string() + " --only " + result.check->name + " --seed " +
         std::to_string(seed);
}

/// "3.2e-12, limit 1e-09".
std::string numbers(const conform::Finding& finding) {
  if (!finding.measured) return {};
  if (!finding.limit) return ": " + number(*finding.measured, 3);
  int digits = 3;  // enough to tell the two apart
  while (digits < 17 && number(*finding.measured, digits) == number(*finding.limit, digits)) ++digits;
  return ": " + number(*finding.measured, digits) + ", limit " + number(*finding.limit, digits);
}

/// Prints results as they come.
class Printer {
 public:
  explicit Printer(std::uint64_t seed) : seed_(seed) {}

  void operator()(const conform::Conformance& plugin, const conform::CheckResult& result) {
    if (plugin.results.size() == 1) {
      std::cout << (plugin.id.empty() ? "" : plugin.kind + ' ' + plugin.id + ' ' + plugin.version + ", ")
                << plugin.file.string() << '\n';
    }
    const conform::Level level = result.check->level;
    if (plugin.results.size() == 1 || level != level_) std::cout << "  " << conform::to_string(level) << '\n';
    level_ = level;
    std::string verdict = conform::to_string(result.finding.verdict), name = result.check->name;
    verdict.resize(9, ' ');
    name.resize(20, ' ');
    std::cout << "    " << verdict << name << indented(result.finding.what) << numbers(result.finding) << '\n';
    const conform::Verdict v = result.finding.verdict;
    if (v == conform::Verdict::fail || v == conform::Verdict::crash || v == conform::Verdict::timeout) {
      std::cout << "             must be true: it " << result.check->says
                << "\n             repeat: " << repeat(plugin, result, seed_) << '\n';
      if (!result.output.empty()) std::cout << "             it printed: " << in_quotes(result.output) << '\n';
    }
    std::cout.flush();
  }

 private:
  std::uint64_t seed_;
  conform::Level level_ = conform::Level::interface;
};

Json to_json(const conform::Conformance& plugin, std::uint64_t seed) {
  Json checks = Json::array();
  for (const conform::CheckResult& result : plugin.results) {
    Json entry = conform::to_json(result.finding);
    entry["name"] = result.check->name;
    entry["level"] = conform::to_string(result.check->level);
    entry["says"] = result.check->says;
    entry["after"] = result.check->after;
    entry["wall_s"] = result.wall_s;
    entry["repeat"] = repeat(plugin, result, seed);
    if (!result.blocked_by.empty()) entry["blocked_by"] = result.blocked_by;
    if (!result.output.empty()) entry["output"] = result.output;
    checks.push_back(std::move(entry));
  }
  return {{"manifest", plugin.file.string()}, {"id", plugin.id}, {"version", plugin.version}, {"kind", plugin.kind},
          {"conforms", plugin.conforms()},    {"checks", checks}};
}

conform::Level level_named(const std::string& name) {
  std::vector<std::string> names;
  for (const conform::Level level : conform::all_levels) {
    if (name == conform::to_string(level)) return level;
    names.emplace_back(conform::to_string(level));
  }
  throw Error(Cause::bad_input, "rouleau conform --level: there is no level " + in_quotes(name) +
                                    did_you_mean(name, names) + "\n  levels: " + listed(names));
}

std::string check_named(const std::string& name) {
  if (conform::find_check(name) != nullptr) return name;
  std::vector<std::string> names;
  for (const conform::Check& check : conform::all_checks()) names.emplace_back(check.name);
  throw Error(Cause::bad_input, "rouleau conform --only: there is no check " + in_quotes(name) +
                                    did_you_mean(name, names) + "\n  checks: " + listed(names));
}

void require_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_regular_file(file, error)) return;
  throw Error(Cause::bad_input,
              "rouleau conform: " + file.string() +
                  (fs::is_directory(file, error) ? " is a folder; give the manifests in it" : " does not exist") +
                  "\n  rouleau plugins lists the manifests that are installed");
}

int check_plugins(const std::vector<std::string>& arguments) {
  namespace options = boost::program_options;
  std::vector<std::string> manifests, only, levels;
  conform::ConformanceOptions chosen;
  chosen.seed = std::random_device{}();
  bool as_json = false;
  options::options_description description("options");
  options::positional_options_description positional;
  description.add_options()("manifest", options::value(&manifests)->required(), "manifest");
  description.add_options()("only", options::value(&only)->composing()->value_name("CHECK"),
                            "run this check even if the checks it needs did not pass (repeatable)");
  description.add_options()(
      "level", options::value(&levels)->composing()->value_name("LEVEL"),
      "run the checks of this level and those that they need: interface, physics, robustness or speed (repeatable);\n"
      "publish: all levels, and warnings count as failures");
  description.add_options()("seed", options::value(&chosen.seed)->value_name("N"),
                            "seed of the random inputs (default: a new one each time)");
  description.add_options()("timeout", options::value(&chosen.time_limit_s)->value_name("SECONDS"),
                            "time limit of one check (20)");
  description.add_options()("json", options::bool_switch(&as_json), "print JSON for programs");
  positional.add("manifest", -1);
  if (!command::parse_command_line("conform", help(), arguments, description, positional)) return 0;

  for (const std::string& name : only) chosen.only.insert(check_named(name));
  for (const std::string& name : levels) chosen.levels.insert(level_named(name));
  if (!(chosen.time_limit_s > 0)) {
    throw Error(Cause::bad_input, "rouleau conform --timeout: must be more than 0 seconds");
  }
  std::vector<fs::path> files;
  for (const std::string& file : manifests) require_file(files.emplace_back(file));

  Printer print(chosen.seed);
  const auto all = conform::check_conformance(
      files, chosen, [&](const conform::Conformance& plugin, const conform::CheckResult& result) {
        if (!as_json) print(plugin, result);
      });
  bool conforms = true;
  Json list = Json::array();
  for (const conform::Conformance& plugin : all) {
    conforms = conforms && plugin.conforms();
    list.push_back(to_json(plugin, chosen.seed));
    if (as_json) continue;
    std::cout << (plugin.id.empty() ? plugin.file.string() : plugin.id)
              << (plugin.conforms() ? " conforms: " : " does not conform: ") << plugin.count(conform::Verdict::pass)
              << " passed, " << plugin.count(conform::Verdict::warn) << " warned, "
              << plugin.count(conform::Verdict::fail) + plugin.count(conform::Verdict::crash) +
                     plugin.count(conform::Verdict::timeout)
              << " failed, " << plugin.count(conform::Verdict::skip) << " skipped\n  any line again: rouleau conform "
              << plugin.file.string() << " --only CHECK --seed " << chosen.seed << '\n';
  }
  if (as_json) {
    std::cout << Json{{"rouleau", 1}, {"seed", chosen.seed}, {"conforms", conforms}, {"plugins", list}}.dump(
                     2, ' ', false, Json::error_handler_t::replace)
              << '\n';
  }
  return conforms ? command::exit_code::done : command::exit_code::plugin_refused;
}

}  // namespace

int main(int count, char** words) {
  command::take_terminal();
  return command::run_program([&] { return check_plugins({words + 1, words + count}); }, " to check plugins");
}
