#include "report_compare.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "files/file.hpp"
#include "json/document.hpp"
#include "report_data.hpp"

namespace rouleau::report {

namespace {

using Json = nlohmann::json;
using Pointer = Json::json_pointer;

using Sides = std::vector<const Json*>;  ///< of the same place in each run, null where it has nothing

/// `row` with "values", null where a side has nothing.
Json entry(Json row, const Sides& sides) {
  row["values"] = Json::array();
  for (const Json* side : sides) row["values"].push_back(side != nullptr ? *side : Json());
  return row;
}

bool all_same(const Sides& sides) {
  return std::all_of(sides.begin(), sides.end(), [&](const Json* side) {
    return side == sides[0] || (side != nullptr && sides[0] != nullptr && *side == *sides[0]);
  });
}

template <class Holds>
bool all_are(const Sides& sides, Holds holds) {
  return std::all_of(sides.begin(), sides.end(), [&](const Json* side) { return side != nullptr && holds(*side); });
}

template <class Of>
Sides members(const Sides& sides, Of of) {
  Sides found;
  for (const Json* side : sides) found.push_back(of(*side));
  return found;
}

void add_differences(Json& rows, const Pointer& at, const Sides& sides) {
  if (all_same(sides)) return;
  if (all_are(sides, [](const Json& value) { return value.is_object(); })) {
    std::vector<std::string> keys;
    for (const Json* side : sides)
      for (const auto& item : side->items())
        if (std::find(keys.begin(), keys.end(), item.key()) == keys.end()) keys.push_back(item.key());
    for (const std::string& key : keys) {
      const auto member = [&](const Json& value) { return value.contains(key) ? &value[key] : nullptr; };
      add_differences(rows, at / key, members(sides, member));
    }
    return;
  }
  if (all_are(sides, [](const Json& value) { return value.is_array(); })) {
    std::size_t longest = 0;
    for (const Json* side : sides) longest = std::max(longest, side->size());
    for (std::size_t i = 0; i < longest; ++i) {
      const auto member = [&](const Json& value) { return i < value.size() ? &value[i] : nullptr; };
      add_differences(rows, at / i, members(sides, member));
    }
    return;
  }
  rows.push_back(entry({{"pointer", at.to_string()}}, sides));
}

const Json* plugin_of(const Json& summary, const Json& wanted) {
  for (const Json& plugin : summary.at("plugins"))
    if (plugin.at("id") == wanted.at("id") && plugin.at("kind") == wanted.at("kind")) return &plugin;
  return nullptr;
}

using Named = std::vector<std::pair<std::string, Json>>;

/// What a run came to, name by name: numbers, and the words that say what made them.
Named outcome_of(const Json& summary) {
  Named all;
  const bool joins = summary.contains("contacts") && !summary["contacts"]["attracting"].empty();
  for (const char* name : {"status", "outcome", "steps", "strain", "simulated_time_s", "aggregates_final", "wall_s",
                           "steps_per_s", "peak_rss_bytes", "threads", "precision", "git", "machine"})
    if (summary.contains(name) && (joins || name != std::string_view("aggregates_final")))
      all.emplace_back(name, summary[name]);
  if (summary.contains("failure")) all.emplace_back("failure", summary["failure"].value("reason", ""));
  for (const char* group : {"dimensionless", "conservation", "stretch"}) {
    if (!summary.contains(group) || !summary[group].is_object()) continue;
    for (const auto& [name, value] : summary[group].items())
      if (!value.is_structured()) all.emplace_back(std::string(group) + "/" + name, value);
  }
  if (!summary.contains("rheology")) return all;
  for (const Json& stage : summary["rheology"]) {
    const Json means = stage.value("means", Json::object());
    for (const auto& [name, value] : means.items())
      if (value.is_object() && (joins || !name.starts_with("aggregate")))
        all.emplace_back("mean/" + stage.value("stage", "") + "/" + name, value.value("mean", Json()));
  }
  return all;
}

const Json* named(const Named& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.first == name; });
  return found == all.end() ? nullptr : &found->second;
}

Json ended_run(const std::filesystem::path& directory) {
  if (!std::filesystem::is_directory(directory))
    throw Error(Cause::bad_input, Place{directory.string()}, "is no directory", {"name the directories of runs"});
  if (!std::filesystem::exists(directory / "summary.json"))
    throw Error(Cause::bad_input, Place{directory.string()},
                "has no summary.json: it is no run's directory, or its run has not ended");
  Json data = report_data(directory);
  data["directory"] = directory.string();
  return data;
}

Json scene_of(const std::filesystem::path& directory) {
  const auto file = directory / "scene.json";
  files::require_own(file);
  return std::filesystem::exists(file) ? json::Document::read(file).root() : Json();
}

}  // namespace

Json value_differences(const std::vector<Json>& values) {
  Json rows = Json::array();
  Sides sides;
  sides.reserve(values.size());
  for (const Json& value : values) sides.push_back(&value);
  add_differences(rows, Pointer(), sides);
  return rows;
}

Json plugin_differences(const std::vector<Json>& summaries) {
  Json rows = Json::array();
  std::vector<std::pair<Json, Json>> seen;  // kind and id
  for (const Json& owner : summaries) {
    for (const Json& plugin : owner.at("plugins")) {
      const std::pair<Json, Json> name(plugin.at("kind"), plugin.at("id"));
      if (std::find(seen.begin(), seen.end(), name) != seen.end()) continue;
      seen.push_back(name);
      std::vector<Json> used;
      used.reserve(summaries.size());
      for (const Json& summary : summaries) {
        const Json* own = plugin_of(summary, plugin);
        used.push_back(own == nullptr ? Json() : Json{{"version", own->at("version")}, {"sha256", own->at("sha256")}});
      }
      if (std::equal(used.begin() + 1, used.end(), used.begin())) continue;
      rows.push_back({{"kind", name.first}, {"id", name.second}, {"values", used}});
    }
  }
  return rows;
}

Json outcome_numbers(const std::vector<Json>& summaries) {
  std::vector<Named> all;
  all.reserve(summaries.size());
  for (const Json& summary : summaries) all.push_back(outcome_of(summary));
  std::vector<std::string> names;
  for (const Named& one : all)
    for (const auto& outcome : one)
      if (std::find(names.begin(), names.end(), outcome.first) == names.end()) names.push_back(outcome.first);
  Json rows = Json::array();
  for (const std::string& name : names) {
    Sides sides;
    for (const Named& one : all) sides.push_back(named(one, name));
    Json row = entry({{"name", name}}, sides);
    row["differs"] = !all_same(sides);
    rows.push_back(std::move(row));
  }
  return rows;
}

Json compare_data(const std::vector<std::filesystem::path>& directories) {
  Json result{{"runs", Json::array()}};
  std::vector<Json> scenes, summaries;
  for (const auto& directory : directories) {
    result["runs"].push_back(ended_run(directory));
    summaries.push_back(result["runs"].back()["summary"]);
    scenes.push_back(scene_of(directory));
  }
  const bool has_scenes = std::none_of(scenes.begin(), scenes.end(), [](const Json& scene) { return scene.is_null(); });
  result["differences"] = {{"scene", has_scenes ? value_differences(scenes) : Json()},
                           {"plugins", plugin_differences(summaries)},
                           {"outcome", outcome_numbers(summaries)}};
  return result;
}

}  // namespace rouleau::report
