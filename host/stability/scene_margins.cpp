#include "scene_margins.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.hpp"
#include "json/document.hpp"
#include "plan/read_scene.hpp"
#include "scene/stage_scales.hpp"
#include "units/units.hpp"

namespace rouleau::stability {

namespace {

using Json = nlohmann::json;
using namespace nlohmann::literals;

/// The parameter's value in a scene, in its unit; nothing where the scene does not have it.
std::optional<double> value_in(const Json& scene, const LimitsParameter& parameter) {
  const Json::json_pointer at(parameter.pointers.front());
  if (!scene.contains(at)) return std::nullopt;
  const Json& given = scene[at];
  if (given.is_number())
    return given.get<double>() / (parameter.unit.empty() ? 1 : units::Units().scale(parameter.unit));
  if (!given.is_string() || parameter.unit.empty()) return std::nullopt;
  return units::Units().to_si(given.get<std::string>(), parameter.unit, parameter.name) /
         units::Units().scale(parameter.unit);
}

/// Lattice value of one unit of the parameter in the stage where it is largest, or smallest.
double lattice_factor(const scene::Scene& scene, const LimitsParameter& parameter, bool largest) {
  if (parameter.unit.empty()) return 1;
  const units::Dimension dimension = units::Units().dimension(parameter.unit);
  double factor = NAN;
  for (int stage = 0; stage < static_cast<int>(scene.stages.size()); ++stage) {
    const double one =
        units::Units().scale(parameter.unit) / scene::make_stage_setting(scene, stage).units.to_si(1, dimension);
    factor = std::isnan(factor) ? one : largest ? std::max(factor, one) : std::min(factor, one);
  }
  return factor;
}

/// What is left out on either side contradicts nothing.
bool contradicts_value(const Json& in_scene, const Json& setting) {
  if (!in_scene.is_object() || !setting.is_object()) return in_scene != setting;
  for (const auto& [key, value] : setting.items()) {
    if (in_scene.contains(key) && contradicts_value(in_scene[key], value)) return true;
  }
  return false;
}

bool contradicts(const Json& scene, const LimitsState& state, const trial::Point& point) {
  for (std::size_t a = 0; a < point.setting.size(); ++a) {
    const trial::Axis& axis = state.limits->axes[a];
    for (const auto& [pointer, value] : axis.settings[point.setting[a]].set) {
      const Json::json_pointer at(pointer);
      if (scene.contains(at) && contradicts_value(scene[at], value)) return true;
    }
  }
  return false;
}

/// The scene that each combination was searched with, read when it is first wanted.
using SearchedScenes = std::map<const CombinationResult*, scene::Scene>;

const scene::Scene& searched_scene(SearchedScenes& scenes, const CombinationResult& combination) {
  const auto found = scenes.find(&combination);
  if (found != scenes.end()) return found->second;
  return scenes.emplace(&combination, plan::read_unpacked_scene(combination.scene_file).scene).first->second;
}

Json margin_of(const std::filesystem::path& file, const LimitsState& state, SearchedScenes& searched) {
  const LimitsParameter& parameter = *state.limits->parameter;
  Json entry = {{"scene", file.lexically_normal().generic_string()},
                {"value", nullptr},
                {"margin", nullptr},
                {"why_not", nullptr}};
  const Json scene = json::Document::read(file).root();
  const std::optional<double> value = value_in(scene, parameter);
  const auto dimensions = [](const Json& of) { return of.value("/domain/size"_json_pointer, Json()).size(); };
  if (!value || dimensions(scene) != dimensions(state.limits->scene)) return nullptr;
  entry["value"] = *value;
  const scene::Scene read = plan::read_unpacked_scene(file).scene;
  double least = INFINITY;
  bool matched = false;
  for (const CombinationResult& combination : state.combinations) {
    if (contradicts(scene, state, combination.point)) continue;
    matched = true;
    if (combination.scene_file.empty()) continue;
    const scene::Scene& base = searched_scene(searched, combination);
    for (const StabilityEdge& edge : combination.search.edges) {
      if (!edge.stable_up_to || !edge.unstable_from) continue;
      const bool above = edge.direction == StabilityEdge::Direction::above;
      const double limit = *edge.stable_up_to * lattice_factor(base, parameter, above);
      const double own = *value * lattice_factor(read, parameter, above);
      least = std::min(least, above ? limit / own : own / limit);
    }
  }
  if (*value == 0) {
    entry["why_not"] = "its value is 0";
  } else if (!matched) {
    entry["why_not"] = "no combination that was searched has this scene's settings";
  } else if (!std::isfinite(least)) {
    entry["why_not"] = "no edge was found in the range";
  } else {
    entry["margin"] = least;
  }
  return entry;
}

}  // namespace

Json scene_margins(const LimitsState& state) {
  Json margins = Json::array();
  if (!state.limits->parameter) return margins;
  SearchedScenes searched;
  for (const std::filesystem::path& file : state.limits->scenes) {
    try {
      Json entry = margin_of(file, state, searched);
      if (!entry.is_null()) margins.push_back(std::move(entry));
    } catch (const std::exception& error) {
      margins.push_back({{"scene", file.lexically_normal().generic_string()},
                         {"value", nullptr},
                         {"margin", nullptr},
                         {"why_not", error.what()}});
    }
  }
  return margins;
}

}  // namespace rouleau::stability
