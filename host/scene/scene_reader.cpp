#include "scene_reader.hpp"

#include <cmath>

#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "json/shown.hpp"

namespace rouleau::scene {
namespace {

std::string with_unit(double value, std::string_view unit) {
  return number(value) + (unit == "1" ? "" : ' ' + std::string(unit));
}

}  // namespace

const nlohmann::json& SceneFields::at(const std::string& pointer) const {
  return document_.root().at(nlohmann::json::json_pointer(pointer));
}

bool SceneFields::has(const std::string& pointer) const {
  return document_.root().contains(nlohmann::json::json_pointer(pointer));
}

double SceneFields::quantity(const std::string& pointer, std::string_view unit, AllowedRange range) const {
  const auto& value = at(pointer);
  const auto name = json::subject(pointer);
  double si = 0.0;
  if (value.is_number()) {
    si = value.get<double>();
  } else if (!value.is_string()) {
    refuse(pointer, json::shown(value) + " is no quantity; write " + name + " as a number in " + std::string(unit) +
                        " or as text with its unit");
  } else {
    try {
      si = units_.to_si(value.get_ref<const std::string&>(), unit, name);
    } catch (const units::UnitError& error) {
      refuse(pointer, error.what());
    }
  }
  if (si >= range.least && si <= range.most) {
    if (value.is_number() && si != 0 && !(si >= range.plain_least && si <= range.plain_most)) {
      refuse(pointer, json::shown(value) + " has no unit, and as " + with_unit(si, unit) +
                          " it is far from any usual " + name + "\nwrite it with the unit that is meant: \"" +
                          with_unit(si, range.common_unit) + "\", or \"" + with_unit(si, unit) + '"');
    }
    // A length, that is: a place may lie in another image of the box.
    if (box_ && unit == "m" && range.least > 0 && si > box_->maxCoeff()) {
      refuse(pointer, json::shown(value) + (value.is_number() ? " (a plain number is taken in m)" : "") +
                          " is longer than the box, which is " + number(box_->x() * 1e6) + " um x " +
                          number(box_->y() * 1e6) + " um; " + name + " must fit into it");
    }
    return si;
  }
  // A plain number that ought to have had a unit is the likeliest reason for a value out of range.
  const auto as_si = value.is_number() ? " (a plain number is taken in " + std::string(unit) + ')' : "";
  if (!(si > 0.0) && range.least > 0.0)
    refuse(pointer, json::shown(value) + " is not positive; " + name + " must be above zero");
  if (!(si >= 0.0) && range.least == 0.0)
    refuse(pointer, json::shown(value) + " is negative; " + name + " must be zero or above");
  refuse(pointer, json::shown(value) + " is out of range" + as_si + "; " + name + " must lie between " +
                      with_unit(range.least, unit) + " and " + with_unit(range.most, unit));
}

double SceneFields::quantity_or(const std::string& pointer, std::string_view unit, AllowedRange range,
                                double otherwise) const {
  return has(pointer) ? quantity(pointer, unit, range) : otherwise;
}

Eigen::Vector2d SceneFields::quantities(const std::string& pointer, std::string_view unit, AllowedRange range) const {
  return {quantity(json::child_pointer(pointer, 0U), unit, range),
          quantity(json::child_pointer(pointer, 1U), unit, range)};
}

std::string SceneFields::line(const std::string& pointer) const {
  auto text = at(pointer).get<std::string>();
  if (printable(text) != text) {
    refuse(pointer, in_quotes(text) + " holds a control character; " + json::subject(pointer) +
                        " is printed on one line: leave it out");
  }
  return text;
}

ModelChoice SceneFields::model(const std::string& pointer) const {
  return {at(pointer + "/model").get<std::string>(), value_or(pointer + "/parameters", nlohmann::json::object()),
          pointer};
}

int SceneFields::cell_type(const std::string& pointer, const std::vector<CellType>& types,
                           const std::vector<std::string>& others) const {
  const auto& name = at(pointer).get_ref<const std::string&>();
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i].name == name) return static_cast<int>(i);
  }
  std::vector<std::string> names;
  names.reserve(types.size());
  for (const auto& type : types) names.push_back(type.name);
  const std::string there = "\ncell_types has: " + listed(names);
  names.insert(names.end(), others.begin(), others.end());
  refuse(pointer, "no cell type is called " + in_quotes(name) + did_you_mean(name, names) + there);
}

void SceneFields::require(const std::string& pointer, const std::string& key, const std::string& otherwise) const {
  if (has(json::child_pointer(pointer, key))) return;
  refuse(pointer, in_quotes(key) + " is missing in " + json::subject(pointer) + "\ngive " + key + ", " + otherwise);
}

void SceneFields::require_room(std::size_t cells, std::size_t more, const std::string& pointer) const {
  if (more <= std::size_t{most_cells} - cells) return;
  refuse(pointer, "with these there would be " + std::to_string(cells + more) + " cells; at most " +
                      std::to_string(most_cells) + " can be computed");
}

void SceneFields::refuse(const std::string& pointer, const std::string& problem) const {
  throw Error(Cause::bad_input, document_.place(pointer), indented(problem));
}

void SceneFields::refuse_key(const std::string& pointer, const std::string& problem) const {
  throw Error(Cause::bad_input, document_.key_place(pointer), indented(problem));
}

}  // namespace rouleau::scene
