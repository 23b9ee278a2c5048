#include "campaign.hpp"

#include <cmath>
#include <iostream>
#include <regex>
#include <string_view>

#include "base/error.hpp"
#include "base/text.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "files/tables.hpp"
#include "json/schema.hpp"
#include "json/shown.hpp"
#include "plan/read_scene.hpp"
#include "point_record.hpp"
#include "run/provenance.hpp"
#include "run/summary.hpp"
#include "scene/named_files.hpp"
#include "scene/read_scene.hpp"
#include "units/units.hpp"

namespace rouleau::trial {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A directory of the command holds its file, or its points, before anything else.
void require_own(const fs::path& directory, const CampaignKind& kind) {
  if (!fs::exists(directory)) return;
  if (!fs::is_directory(directory))
    throw Error(Cause::bad_input, Place{directory.string()}, "is no directory", {"choose another", {Way::elsewhere}});
  if (fs::is_empty(directory) || fs::exists(directory / (std::string(kind.name) + ".json")) ||
      fs::exists(directory / "points"))
    return;
  throw Error(Cause::bad_input, Place{directory.string()},
              std::string("holds files that no ") + kind.command + " wrote",
              {"choose another directory", {Way::elsewhere}});
}

fs::path running(const fs::path& directory) { return directory.string() + ".running"; }

Json axes_json(const std::vector<Axis>& axes) {
  Json all = Json::array();
  for (const Axis& axis : axes) {
    Json labels = Json::array(), positions = Json::array();
    for (const Setting& setting : axis.settings) {
      labels.push_back(setting.label);
      positions.push_back(json::number_or_null(setting.position));
    }
    all.push_back({{"name", axis.name}, {"labels", labels}, {"positions", positions}});
  }
  return all;
}

/// A scene with the keys of shipped cells that it names. Faults are added.
json::Document with_shipped_cells(const Json& scene, const std::string& name, Faults& faults) {
  json::Document document = json::Document::parse(scene.dump(2), name);
  scene::take_shipped_cells(document, faults);
  return document;
}

/// The scene with the changes of "set".
Json read_changed_scene(const CampaignKind& kind, const CampaignFile& campaign) {
  const json::Document& document = *campaign.document;
  Json scene = document.root()["scene"];
  const bool elsewhere = scene.is_string();
  if (elsewhere) {
    if (!fs::exists(campaign.scene_file))
      throw Error(
          Cause::bad_input, document.place("/scene"),
          "there is no scene " + campaign.scene_file.string() + "; the path begins with the " + kind.whose + " folder");
    (void)plan::read_unpacked_scene(campaign.scene_file);
    scene = json::Document::read(campaign.scene_file).root();
  }
  Faults said_below;
  scene = with_shipped_cells(scene, campaign.scene_file.string(), said_below).root();
  if (document.root().contains("set")) put_changes(scene, document, "/set");
  try {
    check_scene(scene, campaign.scene_file.string());
  } catch (const Error& error) {
    // The changed scene has no lines of its own: those of the file, or of its "set".
    throw_as(error, [&](const Error& fault) -> Error {
      const std::string& pointer = fault.place().pointer;
      if (!elsewhere) return {fault.cause(), document.place("/scene" + pointer), fault.problem(), fault.remedy()};
      return {Cause::bad_input, document.place("/set"),
              "the scene with these changes is wrong, " + pointer + ": " + fault.problem(), fault.remedy()};
    });
  }
  return scene;
}

double read_time_limit(const CampaignKind& kind, const json::Document& document) {
  if (!document.root().contains("time_limit")) return kind.time_limit_s;
  const Json& given = document.root()["time_limit"];
  double seconds = NAN;
  try {
    seconds =
        given.is_number() ? given.get<double>() : units::Units().to_si(given.get<std::string>(), "s", "time_limit");
  } catch (const units::UnitError& error) {
    throw Error(Cause::bad_input, document.place("/time_limit"), error.what());
  }
  if (!(seconds >= 0.001 && seconds <= 1e8))
    throw Error(
        Cause::bad_input, document.place("/time_limit"),
        number(seconds) + " s is out of range; write 1 ms to 1e8 s, for example " + in_quotes(kind.time_limit_example));
  return seconds;
}

/// A text that a spreadsheet would compute stands behind an apostrophe; a quantity such as "-5 um" is none.
std::string cell_text(const std::string& text) {
  static const std::regex quantity(R"([+-]?[0-9.]+(e[+-]?[0-9]+)?( [A-Za-z0-9/ ]*)?)", std::regex::icase);
  const bool computed = !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
  return files::csv_text(computed && !std::regex_match(text, quantity) ? '\'' + text : text);
}

}  // namespace

Campaign::Campaign(const CampaignKind& kind, const CampaignFile& file, CampaignOptions options)
    : kind_(kind), file_(file), options_(std::move(options)) {
  require_own(options_.directory, kind_);
  fs::create_directories(options_.directory / "points");
  lock_.emplace(options_.directory);
  if (!lock_->take())
    throw Error(Cause::bad_input, Place{options_.directory.string()},
                std::string("another ") + kind_.program + " is writing into this directory",
                {"wait for it, or choose another directory", {Way::elsewhere}});
}

fs::path Campaign::directory_of(const std::string& fingerprint) const {
  return options_.directory / "points" / directory_name(fingerprint);
}

Trial Campaign::trial_of(const Json& scene, const std::string& fingerprint) const {
  Trial trial{scene, file_.scene_file, directory_of(fingerprint)};
  trial.written_scene = trial.directory.string() + ".scene.json";
  trial.time_limit_s = file_.time_limit_s;
  trial.program = options_.program;
  trial.interrupted = options_.interrupted;
  return trial;
}

std::optional<PointRecord> Campaign::find(const std::string& fingerprint) const {
  std::optional<PointRecord> record = read_record(options_.directory / "points", fingerprint);
  if (record && record->end == TrialEnd::timed_out && record->time_limit_s < file_.time_limit_s) record.reset();
  return record;
}

TrialResult Campaign::run(Trial trial) const {
  trial.directory = running(trial.directory);
  fs::remove_all(trial.directory);
  TrialResult result = run_trial(trial);
  if (result.end == TrialEnd::interrupted) fs::remove_all(trial.directory);
  require_same_libraries(result.summary);
  return result;
}

void Campaign::require_same_libraries(const Json& summary) const {
  if (!summary.is_object()) return;
  for (const Json& plugin : summary.value("plugins", Json::array())) {
    const std::string id = plugin.at("id"), sha256 = plugin.at("sha256");
    if (libraries_.emplace(id, sha256).first->second == sha256) continue;
    throw Error(Cause::plugin_refused, Place{plugin.at("library").get<std::string>()},
                "the library of " + in_quotes(id) + " was built anew meanwhile",
                {"call the same command again: what the old one computed is computed anew"});
  }
}

void Campaign::keep(std::optional<PointRecord>& record, const std::string& fingerprint,
                    const TrialResult& result) const {
  const fs::path kept = directory_of(fingerprint), ran = running(kept);
  PointRecord whole = record.value_or(PointRecord{});
  whole.fingerprint = fingerprint;
  whole.machine = run::machine_description();
  whole.time_limit_s = file_.time_limit_s;
  add_run(whole, result, ran);
  const bool first = whole.runs.size() == 1 || result.end != TrialEnd::completed;
  if (first) fs::remove_all(kept);
  if (first && fs::exists(ran)) fs::rename(ran, kept);
  fs::remove_all(ran);
  write_record(options_.directory / "points", whole);
  record = std::move(whole);
}

void Campaign::discard(const std::string& fingerprint) const { fs::remove_all(running(directory_of(fingerprint))); }

void Campaign::say(const std::string& line) const {
  if (!options_.quiet) std::cerr << line << std::endl;
}

bool Campaign::wait_for(files::FileLock& lock, const std::string& waiting) const {
  return lock.wait([&] { say(waiting); }, options_.interrupted);
}

Json result_head(const CampaignKind& kind, const CampaignFile& file, const std::string& started,
                 const std::string& finished, bool complete) {
  const std::string name = kind.name;
  const run::Machine machine = run::this_machine();
  return {{"rouleau_" + name + "_result", 1},
          {"title", file.title},
          {name + "_file", file.file.string()},
          {"scene_file", file.scene_file.string()},
          {"program", run::program_version()},
          {"program_sha256", program_sha256()},
          {"machine",
           {{"cpu", machine.processor},
            {"cores", machine.processors},
            {"memory_bytes", machine.memory_bytes},
            {"system", machine.system},
            {"compiler", machine.compiler}}},
          {"started", started},
          {"finished", finished.empty() ? Json() : Json(finished)},
          {"complete", complete},
          {"axes", axes_json(file.axes)}};
}

std::string csv_line(const Json& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Json& field = fields[i];
    if (i > 0) line += ',';
    if (!field.is_null()) line += field.is_string() ? cell_text(field.get<std::string>()) : field.dump();
  }
  return line + '\n';
}

void write_result(const CampaignKind& kind, const fs::path& directory, const Json& result, const std::string& csv) {
  const std::string name = kind.name;
  files::write_file(directory / (name + ".csv"), csv);
  files::write_file(directory / (name + ".json"), result.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

void check_scene(const Json& scene, const std::string& name) {
  Faults faults;
  json::judge(with_shipped_cells(scene, name, faults), scene::scene_schema(), faults);
  faults.raise();
}

CampaignFile read_campaign_file(const CampaignKind& kind, const fs::path& file, const Json& schema) {
  CampaignFile campaign;
  campaign.document = std::make_shared<const json::Document>(json::Document::read(file));
  const json::Document& document = *campaign.document;
  json::validate(document, schema);
  const Json& root = document.root();
  campaign.title = root.value("title", file.stem().string());
  campaign.file = file;
  campaign.scene_file = root["scene"].is_string() ? file.parent_path() / root["scene"].get<std::string>() : file;
  campaign.scene = read_changed_scene(kind, campaign);
  if (root.contains("matrix")) campaign.axes = read_axes(document, "/matrix", campaign.scene);
  campaign.time_limit_s = read_time_limit(kind, document);
  return campaign;
}

}  // namespace rouleau::trial
