#include "conformance.hpp"

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "base/installation.hpp"
#include "base/process.hpp"
#include "base/text.hpp"
#include "json/document.hpp"
#include "plugin/manifest_reader.hpp"
#include "report_line.hpp"

namespace rouleau::conform {

namespace {

namespace fs = std::filesystem;

/// The program that runs one check.
fs::path check_program() { return installation().programs / "conform-check"; }

/// Ends what outlives a check, wherever it has hidden, and adds it to the finding.
void end_leftovers(Finding& finding) {
  std::vector<std::string> names;
  for (const std::string& name : end_children()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  if (names.empty()) return;
  const std::string words = "leaves a process behind (" + listed(names) + ")";
  if (finding.verdict == Verdict::crash || finding.verdict == Verdict::timeout)
    finding.what += ", and " + words;
  else
    finding = Finding::failed(words);
}

CheckResult run(const Check& check, const fs::path& manifest, const ConformanceOptions& options, int dimension) {
  const ProcessEnd end = run_process(
      check_program(), {manifest.string(), check.name, std::to_string(options.seed), std::to_string(dimension)},
      options.time_limit_s);
  CheckResult result{&check, {}, {}, end.output, end.wall_s};
  // The last line: a plugin that ends its process while the finding is made has the last word.
  const auto last = end.finding.find_last_not_of('\n');
  const auto line = last == std::string::npos ? "" : end.finding.substr(end.finding.find_last_of('\n', last) + 1);
  if (end.timed_out) {
    result.finding = {Verdict::timeout, "did not end", end.wall_s, options.time_limit_s};
  } else if (const auto finding = nlohmann::json::parse(line, nullptr, false); finding.is_object()) {
    result.finding = finding_from(finding);
  } else {
    result.finding = {Verdict::crash,
                      end.signal != 0 ? "ended by signal " + std::to_string(end.signal)
                                      : "ended the process with exit code " + std::to_string(end.exit_code),
                      {},
                      {}};
  }
  end_leftovers(result.finding);
  return result;
}

/// What a check finds in each dimension that the manifest names: the worst of it.
CheckResult run(const Check& check, const Conformance& plugin, const ConformanceOptions& options) {
  // Files and the table are the same in each dimension.
  const std::set<std::string> of_files = {"manifest", "library", "exports", "load", "open", "agreement"};
  std::optional<CheckResult> worst;
  double wall_s = 0;
  for (const int dimension : plugin.dimensions) {
    CheckResult result = run(check, plugin.file, options, dimension);
    wall_s += result.wall_s;
    if (of_files.contains(check.name)) return result;
    if (dimension == 3 && plugin.dimensions.size() > 1)
      result.finding.what += plugin.kind == "collision" ? " (D3Q19)" : " (in three dimensions)";
    if (!worst || worse(result.finding, worst->finding)) worst = std::move(result);
  }
  worst->wall_s = wall_s;
  return *worst;
}

/// At level publish warnings are failures, but for what an honest model may be: under stress at rest, or rough.
bool may_warn(const Check& check) {
  const std::set<std::string> names = {"rest-state", "gradient", "derivative", "derivatives", "quiet"};
  return names.contains(check.name);
}

bool stands(Verdict verdict) { return verdict == Verdict::pass || verdict == Verdict::warn; }

/// Runs the checks of one plugin in order.
class Session {
 public:
  /// `rivals`: all manifests with this one's id.
  Session(const ConformanceOptions& options, const Conformance& conformance, const std::vector<fs::path>& rivals)
      : options_(options), plugin_(conformance), rivals_(rivals) {}

  CheckResult next(const Check& check) {
    const std::string blocker = blocked_by(check);
    CheckResult result{&check, Finding::skipped("blocked by " + blocker), blocker, {}, 0};
    if (blocker.empty()) result = run(check, plugin_, options_);
    if (options_.levels.contains(Level::publish) && result.finding.verdict == Verdict::warn && !may_warn(check)) {
      result.finding.verdict = Verdict::fail;
    }
    // What one manifest does not know, so that its check's process cannot tell.
    if (std::string(check.name) == "manifest" && stands(result.finding.verdict) && rivals_.size() > 1) {
      std::vector<std::string> files;
      for (const fs::path& file : rivals_) files.push_back(file.string());
      result.finding = Finding::failed("the id " + in_quotes(plugin_.id) + " is used by " + listed(files));
    }
    // What does not apply to this plugin blocks nothing; what was blocked itself does.
    const bool holds = stands(result.finding.verdict) || (result.finding.verdict == Verdict::skip && blocker.empty());
    holds_[check.name] = holds;
    return result;
  }

 private:
  [[nodiscard]] std::string blocked_by(const Check& check) const {
    if (!options_.only.empty()) return {};
    for (const char* name : check.after) {
      // Without a manifest the model's kind is not known, nor what of that kind a check builds on.
      if (const auto manifest = holds_.find("manifest"); manifest != holds_.end() && !manifest->second)
        return "manifest";
      const auto found = holds_.find(name);
      if (found != holds_.end() && !found->second) return name;
    }
    return {};
  }

  const ConformanceOptions& options_;
  const Conformance& plugin_;
  const std::vector<fs::path>& rivals_;
  std::map<std::string, bool> holds_;
};

/// The checks that the options ask for, of a kind (or of any, if the kind is not known).
std::vector<const Check*> chosen(const ConformanceOptions& options, const std::string& kind) {
  std::set<std::string> wanted;
  const auto& all = all_checks();
  for (auto check = all.rbegin(); check != all.rend(); ++check) {
    const bool of_level = options.levels.empty()
                              ? check->level != Level::publish
                              : options.levels.contains(check->level) || options.levels.contains(Level::publish);
    if (options.only.empty() ? of_level || wanted.contains(check->name) : options.only.contains(check->name)) {
      wanted.insert(check->name);
      if (options.only.empty()) wanted.insert(check->after.begin(), check->after.end());
    }
  }
  std::vector<const Check*> checks;
  for (const Check& check : all) {
    if (wanted.contains(check.name) && (!check.kind || plugin::to_string(*check.kind) == kind))
      checks.push_back(&check);
  }
  return checks;
}

}  // namespace

int Conformance::count(Verdict verdict) const {
  return static_cast<int>(std::count_if(results.begin(), results.end(),
                                        [&](const CheckResult& r) { return r.finding.verdict == verdict; }));
}

bool Conformance::conforms() const {
  return count(Verdict::fail) + count(Verdict::crash) + count(Verdict::timeout) == 0;
}

std::vector<Conformance> check_conformance(const std::vector<fs::path>& manifests, const ConformanceOptions& options,
                                           const std::function<void(const Conformance&, const CheckResult&)>& watch) {
  adopt_orphans();
  std::vector<Conformance> all;
  std::map<std::string, std::vector<fs::path>> claimants;
  const units::Units units;
  for (const fs::path& file : manifests) {
    Conformance& conformance = all.emplace_back();
    conformance.file = file;
    try {
      const plugin::Manifest manifest = plugin::read_manifest(file, units);
      conformance.id = manifest.id;
      conformance.version = manifest.version;
      conformance.kind = plugin::to_string(manifest.kind);
      conformance.dimensions = manifest.dimensions;
      claimants[manifest.id].push_back(file);
    } catch (const Error&) {  // the check of the manifest says what is wrong
    }
  }
  for (Conformance& conformance : all) {
    Session session(options, conformance, claimants[conformance.id]);
    for (const Check* check : chosen(options, conformance.kind)) {
      conformance.results.push_back(session.next(*check));
      watch(conformance, conformance.results.back());
    }
  }
  return all;
}

}  // namespace rouleau::conform
