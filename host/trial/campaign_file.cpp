#include "campaign_file.hpp"

#include <algorithm>
#include <cmath>

#include "base/faults.hpp"
#include "base/text.hpp"
#include "json/schema.hpp"
#include "plan/read_scene.hpp"
#include "scene/named_files.hpp"
#include "scene/read_scene.hpp"
#include "units/units.hpp"

namespace rouleau::trial {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

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

}  // namespace

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
