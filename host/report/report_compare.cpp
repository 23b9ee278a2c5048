#include "report_compare.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "json/document.hpp"
#include "report_data.hpp"

namespace rouleau::report {

namespace {

using Json = nlohmann::json;
using Pointer = Json::json_pointer;

/// {pointer or name: ..., a, b}, without the side that has nothing.
Json entry(Json row, const Json* a, const Json* b) {
  if (a != nullptr) row["a"] = *a;
  if (b != nullptr) row["b"] = *b;
  return row;
}

const Json* member(const Json& value, const std::string& key) {
  const auto found = value.find(key);
  return found == value.end() ? nullptr : &*found;
}

void add_differences(Json& rows, const Pointer& at, const Json* a, const Json* b) {
  if (a != nullptr && b != nullptr) {
    if (*a == *b) return;
    if (a->is_object() && b->is_object()) {
      std::vector<std::string> keys;
      for (const Json* side : {a, b})
        for (const auto& [key, value] : side->items())
          if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
      for (const std::string& key : keys) add_differences(rows, at / key, member(*a, key), member(*b, key));
      return;
    }
    if (a->is_array() && b->is_array()) {
      for (std::size_t i = 0; i < std::max(a->size(), b->size()); ++i)
        add_differences(rows, at / i, i < a->size() ? &(*a)[i] : nullptr, i < b->size() ? &(*b)[i] : nullptr);
      return;
    }
  }
  rows.push_back(entry({{"pointer", at.to_string()}}, a, b));
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
  for (const char* name : {"status", "outcome", "steps", "strain", "simulated_time_s", "aggregates_final", "wall_s",
                           "steps_per_s", "peak_rss_bytes", "threads", "precision", "git", "machine"})
    if (summary.contains(name)) all.emplace_back(name, summary[name]);
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
      if (value.is_object())
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
    throw Error(Cause::bad_input, Place{directory.string()}, "is no directory", {"name the directories of two runs"});
  if (!std::filesystem::exists(directory / "summary.json"))
    throw Error(Cause::bad_input, Place{directory.string()},
                "has no summary.json: it is no run's directory, or its run has not ended");
  Json data = report_data(directory);
  data["directory"] = directory.string();
  return data;
}

Json scene_of(const std::filesystem::path& directory) {
  const auto file = directory / "scene.json";
  return std::filesystem::exists(file) ? json::Document::read(file).root() : Json();
}

}  // namespace

Json value_differences(const Json& a, const Json& b) {
  Json rows = Json::array();
  add_differences(rows, Pointer(), &a, &b);
  return rows;
}

Json plugin_differences(const Json& summary_a, const Json& summary_b) {
  Json rows = Json::array();
  const auto used = [](const Json& plugin) {
    return Json{{"version", plugin.at("version")}, {"sha256", plugin.at("sha256")}};
  };
  const auto add = [&](const Json& plugin, const Json* a, const Json* b) {
    const Json left = a != nullptr ? used(*a) : Json(), right = b != nullptr ? used(*b) : Json();
    if (left == right) return;
    rows.push_back(entry({{"kind", plugin.at("kind")}, {"id", plugin.at("id")}}, a != nullptr ? &left : nullptr,
                         b != nullptr ? &right : nullptr));
  };
  for (const Json& plugin : summary_a.at("plugins")) add(plugin, &plugin, plugin_of(summary_b, plugin));
  for (const Json& plugin : summary_b.at("plugins"))
    if (plugin_of(summary_a, plugin) == nullptr) add(plugin, nullptr, &plugin);
  return rows;
}

Json outcome_numbers(const Json& summary_a, const Json& summary_b) {
  const Named a = outcome_of(summary_a), b = outcome_of(summary_b);
  Json rows = Json::array();
  const auto add = [&](const std::string& name, const Json* left, const Json* right) {
    Json row = entry({{"name", name}}, left, right);
    row["differs"] = left == nullptr || right == nullptr || *left != *right;
    rows.push_back(std::move(row));
  };
  for (const auto& [name, value] : a) add(name, &value, named(b, name));
  for (const auto& [name, value] : b)
    if (named(a, name) == nullptr) add(name, nullptr, &value);
  return rows;
}

Json compare_data(const std::filesystem::path& a, const std::filesystem::path& b) {
  Json result{{"runs", {ended_run(a), ended_run(b)}}};
  const Json scene_a = scene_of(a), scene_b = scene_of(b);
  const Json &summary_a = result["runs"][0]["summary"], &summary_b = result["runs"][1]["summary"];
  result["differences"] = {
      {"scene", scene_a.is_null() || scene_b.is_null() ? Json() : value_differences(scene_a, scene_b)},
      {"plugins", plugin_differences(summary_a, summary_b)},
      {"outcome", outcome_numbers(summary_a, summary_b)}};
  return result;
}

}  // namespace rouleau::report
