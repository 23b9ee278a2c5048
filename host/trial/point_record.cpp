#include "point_record.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "plugin/catalog.hpp"
#include "plugin/library.hpp"
#include "plugin/lock.hpp"
#include "scene/named_files.hpp"

namespace rouleau::trial {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path record_file(const fs::path& points, const std::string& fingerprint) {
  return points / (directory_name(fingerprint) + ".json");
}

Json failure_of(const TrialResult& result) {
  if (result.end == TrialEnd::completed) return nullptr;
  if (result.end == TrialEnd::diverged && result.summary.is_object() && result.summary.contains("failure")) {
    const Json& failure = result.summary["failure"];
    return {{"reason", failure["reason"]},
            {"step", failure["step"]},
            {"message", failure["message"]},
            {"remedy", failure["remedy"]}};
  }
  const Json steps = result.summary.is_object() ? result.summary.value("steps", Json()) : Json();
  return {{"reason", result.end}, {"step", steps}, {"message", result.message}, {"remedy", nullptr}};
}

TimedRun run_of(const TrialResult& result) {
  TimedRun run{result.wall_s, result.cpu_s, result.wall_s, Json::array()};
  if (!result.summary.is_object()) return run;
  run.wall_s = result.summary.value("wall_s", result.wall_s);
  for (const Json& pass : result.summary.value("passes", Json::array()))
    run.passes.push_back({{"name", pass["name"]}, {"wall_s", pass["wall_s"]}});
  return run;
}

/// Before anything was measured.
constexpr double usual_beside_s = 0.2;
constexpr double shortest_estimate_s = 1e-6;

std::size_t settings_shared(const Point& a, const Point& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.setting.size(); ++i) count += a.setting[i] == b.setting[i] ? 1 : 0;
  return count;
}

void collect_models(const Json& value, std::set<std::string>& models) {
  if (!value.is_structured()) return;
  if (value.is_object() && value.contains("model") && value["model"].is_string()) models.insert(value["model"]);
  for (const auto& part : value) collect_models(part, models);
}

std::vector<fs::path> scene_plugin_dirs(const Json& scene, const fs::path& scene_file) {
  std::vector<fs::path> folders;
  const fs::path beside = fs::absolute(scene_file).parent_path();
  const Json listed = scene.is_object() ? scene.value("plugin_dirs", Json::array()) : Json::array();
  for (const auto& folder : listed) {
    std::error_code ignored;
    const fs::path whole = folder.is_string() ? beside / folder.get<std::string>() : fs::path();
    if (fs::is_directory(whole, ignored)) folders.push_back(whole);
  }
  return folders;
}

}  // namespace

std::string tables_sha256(const fs::path& directory) {
  std::set<fs::path> tables;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.path().extension() == ".csv") tables.insert(entry.path());
  std::string all;
  for (const fs::path& table : tables) all += table.filename().string() + ' ' + sha256(table) + '\n';
  return sha256_of(all);
}

void add_run(PointRecord& record, const TrialResult& result, const fs::path& directory) {
  record.end = result.end;
  record.failure = failure_of(result);
  record.peak_rss_bytes = std::max(record.peak_rss_bytes, result.peak_rss_bytes);
  if (result.summary.is_object()) record.steps = result.summary.value("steps", Json());
  record.runs.push_back(run_of(result));
  if (result.end != TrialEnd::completed) return;
  const std::string hash = tables_sha256(directory);
  if (record.tables_sha256.empty()) record.tables_sha256 = hash;
  if (hash != record.tables_sha256)
    record.difference =
        "run " + std::to_string(record.runs.size()) + " wrote other tables than run 1 of the same scene";
}

TrialResult result_of(const PointRecord& record, const fs::path& directory) {
  TrialResult result;
  result.end = record.end;
  result.summary = read_summary(directory);
  if (record.failure.is_object() && record.failure["message"].is_string()) result.message = record.failure["message"];
  return result;
}

void write_record(const fs::path& points, const PointRecord& record) {
  files::write_file(record_file(points, record.fingerprint),
                    Json(record).dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

std::optional<PointRecord> read_record(const fs::path& points, const std::string& fingerprint) {
  const fs::path file = record_file(points, fingerprint);
  if (!fs::exists(file)) return std::nullopt;
  const Json whole = Json::parse(files::read_text(file), nullptr, false);
  try {
    const auto record = whole.get<PointRecord>();
    if (record.end == TrialEnd::interrupted) return std::nullopt;
    const bool run_is_there = fs::exists(points / directory_name(fingerprint) / "summary.json");
    const bool must_be_there = record.end == TrialEnd::completed || record.end == TrialEnd::diverged;
    if (record.fingerprint != fingerprint || (must_be_there && !run_is_there)) return std::nullopt;
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;  // damaged: the point is run again
  }
}

void RunCost::learn(const Point& point, double estimated_s, double stepping_s, double process_s) {
  const double factor = stepping_s / std::max(estimated_s, shortest_estimate_s);
  known_.push_back({point, estimated_s, factor, std::max(0.0, process_s - stepping_s)});
}

double RunCost::expected_s(const Point& point, double estimated_s) const {
  if (known_.empty()) return usual_beside_s + estimated_s;
  // The run most alike is the one with most settings in common; of several the longest, where little else counts.
  const auto likeness = [&](const Known& known) {
    return std::pair(settings_shared(known.point, point), known.estimated_s);
  };
  const Known& alike = *std::max_element(known_.begin(), known_.end(),
                                         [&](const Known& a, const Known& b) { return likeness(a) < likeness(b); });
  return alike.beside_s + alike.factor * estimated_s;
}

std::string program_sha256() {
  static const std::string hash = sha256("/proc/self/exe");
  return hash;
}

std::vector<UsedPlugin> plugins_named(const Json& scene, const fs::path& scene_file) {
  std::set<std::string> models{"trt"};  // what a fluid has that names no collision model
  collect_models(scene, models);
  const plugin::Catalog catalog(plugin::plugin_search_path({}, scene_plugin_dirs(scene, scene_file)));
  std::vector<UsedPlugin> used;
  for (const std::string& id : models) {
    const auto& offered = catalog.manifests();
    const auto found =
        std::find_if(offered.begin(), offered.end(), [&](const plugin::Manifest& m) { return m.id == id; });
    UsedPlugin plugin{id, {}, {}};
    try {
      if (found != offered.end()) plugin = {id, plugin::library_sha256(*found), found->sha256};
    } catch (const Error& error) {
      if (error.cause() != Cause::plugin_refused) throw;
    }
    used.push_back(plugin);
  }
  return used;
}

std::string fingerprint(const Json& scene, const fs::path& scene_file, const std::vector<std::string>& further) {
  Json all = {{"scene", scene}, {"program", program_sha256()}, {"plugins", Json::array()}, {"further", further}};
  if (all["scene"].is_object()) all["scene"].erase("plugin_dirs");
  if (all["scene"].is_object()) all["scene"].erase("notes");
  for (const UsedPlugin& plugin : plugins_named(scene, scene_file))
    all["plugins"].push_back({plugin.id, plugin.library_sha256, plugin.manifest_sha256});
  for (const std::string& entry : scene::entries_with_files(scene)) {
    scene::each_text(scene.at(Json::json_pointer(entry + "/file")), [&](const Json& name) {
      const fs::path file = fs::absolute(scene_file).parent_path() / name.get<std::string>();
      std::error_code ignored;
      if (fs::is_regular_file(file, ignored) && fs::file_size(file, ignored) <= largest_named)
        all["files"].push_back(sha256(file));
    });
  }
  const fs::path lock = plugin::lock_beside(scene_file);
  if (fs::exists(lock)) all["lock"] = sha256(lock);
  return sha256_of(all.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string directory_name(const std::string& fingerprint) { return fingerprint.substr(0, 16); }

}  // namespace rouleau::trial
