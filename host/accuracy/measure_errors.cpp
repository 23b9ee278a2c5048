#include "measure_errors.hpp"

#include <iostream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "files/file_lock.hpp"
#include "files/run_directory.hpp"
#include "files/verify.hpp"
#include "json/document.hpp"
#include "plugin/library.hpp"
#include "run/provenance.hpp"
#include "trial/fingerprint.hpp"
#include "trial/point_record.hpp"
#include "trial/trial.hpp"

namespace rouleau::accuracy {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A companion may take as long as the run did, and this: a slow start is no reason to give up.
constexpr double patience_s = 60;

struct Ended {
  trial::TrialResult result;
  fs::path directory;
  double process_s = 0;
};

std::vector<std::string> surroundings(const MeasureOptions& options) {
  std::vector<std::string> words{"lock " + options.lock.string()};
  for (const fs::path& folder : options.plugin_dirs) words.push_back("plugins " + fs::absolute(folder).string());
  return words;
}

/// Runs a companion, or finds that it has been run.
Ended run_companion(const fs::path& folder, const Companion& companion, const MeasureOptions& options,
                    double time_limit_s) {
  const std::string fingerprint = trial::fingerprint(companion.scene, options.scene_file, surroundings(options));
  Ended ended{{}, folder / trial::directory_name(fingerprint)};
  if (const std::optional<trial::PointRecord> record = trial::read_record(folder, fingerprint)) {
    ended.result = trial::result_of(*record, ended.directory);
    for (const trial::TimedRun& run : record->runs) ended.process_s += run.process_s;
    return ended;
  }
  trial::Trial trial{companion.scene, options.scene_file, ended.directory};
  trial.plugin_dirs = options.plugin_dirs;
  trial.lock = options.lock;
  trial.threads = options.threads;
  trial.time_limit_s = time_limit_s;
  trial.program = options.program;
  trial.interrupted = options.interrupted;
  if (!options.quiet) std::cerr << "error bar: " << companion.differs << std::endl;
  ended.result = trial::run_trial(trial);
  ended.process_s = ended.result.wall_s;
  if (ended.result.end == trial::TrialEnd::interrupted) return ended;
  trial::PointRecord record;
  record.fingerprint = fingerprint;
  record.machine = run::machine_description();
  record.time_limit_s = time_limit_s;
  trial::add_run(record, ended.result, ended.directory);
  trial::write_record(folder, record);
  return ended;
}

/// Why a companion says nothing; empty: it does.
std::string why_useless(const Companion& companion, const Ended& ended) {
  if (ended.result.end == trial::TrialEnd::completed) return {};
  const std::string message = ended.result.end == trial::TrialEnd::timed_out
                                  ? "it took longer than the run itself"
                                  : ended.result.message.substr(0, ended.result.message.find('\n'));
  return "the companion with " + companion.differs + " did not complete (" + trial::to_string(ended.result.end) +
         "): " + message;
}

/// Adds to a summary's choice of numerics what was measured.
void add_measured(Json& choice, const std::vector<ErrorBar>& bars) {
  if (!choice.is_object()) return;
  const std::optional<Worst> found = worst(bars);
  choice["measured_error"] = found ? Json(found->error) : Json();
  choice["measured_of"] = found ? Json(found->name) : Json();
}

}  // namespace

Finished finished_run(const fs::path& directory, const scene::Scene& scene) {
  const Json summary = trial::read_summary(directory);
  if (!summary.is_object() || summary.value("status", "") != "completed") return Finished::no;
  if (summary.value("scene_sha256", "") != plugin::sha256_of(files::scene_text(*scene.document))) return Finished::no;
  const Json stages = summary.value("stages", Json::array());
  if (stages.empty() || stages.back().value("ended_by", "") == "max_steps") return Finished::no;
  return summary.contains("error_bars") ? Finished::with_bars : Finished::without_bars;
}

MeasuredErrors measure_errors(const fs::path& directory, const scene::Scene& scene, const MeasureOptions& options) {
  files::FileLock lock(directory);
  if (!lock.take()) {
    throw Error(Cause::bad_input, Place{directory.string()}, "another process is working in this directory",
                {"wait for it, then go on", {Way::resume}});
  }
  const Json summary = trial::read_summary(directory);
  const double run_s = summary.at("wall_s");
  double outputs_s = 0;
  for (const Json& pass : summary.at("passes")) {
    if (pass.at("name") == "observe and check") outputs_s += pass.at("wall_s").get<double>();
  }
  const fs::path folder = directory / files::companions_folder;
  const Companions companions = choose_companions(scene, run_s, outputs_s);
  MeasuredErrors errors;
  errors.missing = companions.why_none;
  Json told = Json::array();
  std::vector<Measured> measured;
  for (const Companion& companion : companions.runs) {
    const Ended ended = run_companion(folder, companion, options, run_s + patience_s);
    if (ended.result.end == trial::TrialEnd::interrupted) {
      errors.interrupted = true;
      errors.missing = "interrupted";
      return errors;
    }
    errors.wall_s += ended.process_s;
    told.push_back({{"role", name_of(companion.role)},
                    {"differs", companion.differs},
                    {"end", trial::to_string(ended.result.end)},
                    {"wall_s", ended.process_s},
                    {"message", ended.result.message}});
    errors.missing = why_useless(companion, ended);
    if (!errors.missing.empty()) break;
    measured.push_back({companion.role, companion.differs, reported_quantities(ended.directory)});
  }
  std::vector<Quantity> quantities = reported_quantities(directory);
  if (errors.missing.empty()) {
    errors.bars = error_bars(quantities, companions, measured);
  } else {
    for (Quantity& quantity : quantities) errors.bars.push_back({std::move(quantity), {}, 0, {}, errors.missing});
  }
  errors.share = errors.wall_s / run_s;
  Json sections = {{"error_bars", to_json(errors.bars)},
                   {"error_bar_runs",
                    {{"wall_s", errors.wall_s},
                     {"share_of_run", errors.share},
                     {"missing", errors.missing.empty() ? Json() : Json(errors.missing)},
                     {"companions", told}}},
                   {"numerics_choice", summary.value("numerics_choice", Json())}};
  add_measured(sections["numerics_choice"], errors.bars);
  files::amend_summary(directory, sections);
  fs::remove_all(folder);
  return errors;
}

}  // namespace rouleau::accuracy
