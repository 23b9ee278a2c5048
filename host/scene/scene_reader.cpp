#include "scene_reader.hpp"

#include <algorithm>
#include <cmath>

#include "base/synonyms.hpp"
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

bool SceneFields::settled(const std::string& pointer) const {
  if (faults_ == nullptr || faults_->empty()) return true;
  const auto parent_of = [](const std::string& child) { return child.substr(0, child.rfind('/')); };
  const bool there = has(pointer);
  for (std::size_t i = 0; i < faults_->size(); ++i) {
    const std::string& faulty = (*faults_)[i].place().pointer;
    if (faulty == pointer || faulty.starts_with(pointer + '/')) return false;
    if (!there && (faulty == parent_of(pointer) || parent_of(faulty) == parent_of(pointer))) return false;
  }
  return true;
}

std::size_t SceneFields::count(const std::string& pointer) const {
  for (std::size_t i = 0; i < of_schema_; ++i)
    if ((*faults_)[i].place().pointer == pointer) throw Misread{};
  return at(pointer).size();
}

double SceneFields::quantity(const std::string& pointer, std::string_view unit, AllowedRange range) const {
  double value = std::nan("");
  attempt([&] { value = judged_quantity(pointer, unit, range); });
  return value;
}

double SceneFields::judged_quantity(const std::string& pointer, std::string_view unit, AllowedRange range) const {
  if (of_schema_ > 0 && !settled(pointer)) throw Misread{};
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
    if (box_ && range.within_box && unit == "m" && range.least > 0 && si > box_->most()) {
      refuse(pointer, json::shown(value) + (value.is_number() ? " (a plain number is taken in m)" : "") +
                          " is longer than the box, which is " + by_axes(*box_, 1e6, 6, " um") + "; " + name +
                          " must fit into it");
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

Vector SceneFields::quantities(const std::string& pointer, std::string_view unit, AllowedRange range,
                               int dimension) const {
  Vector read = Vector::filled(dimension, 0);
  const std::size_t count = std::min(this->count(pointer), static_cast<std::size_t>(dimension));
  for (std::size_t axis = 0; axis < count; ++axis)
    read[axis] = quantity(json::child_pointer(pointer, axis), unit, range);
  return read;
}

Vector SceneFields::vector(const std::string& pointer, std::string_view unit, AllowedRange range, int dimension) const {
  if (static_cast<int>(count(pointer)) != dimension) {
    refuse(pointer, json::subject(pointer) + " has " + std::to_string(count(pointer)) +
                        " components, and domain.size " + std::to_string(dimension) + "\ngive it as many");
  }
  return quantities(pointer, unit, range, dimension);
}

Vector SceneFields::place(const std::string& pointer, const Domain& domain, const char* what) const {
  const Vector read = quantities(pointer, "m", range::place, domain.dimension());
  const int lengths = static_cast<int>(count(pointer));
  if (lengths > domain.dimension() && is_known(domain))
    refuse(pointer, "there is no z in two dimensions\ngive two lengths");
  if (lengths < domain.dimension())
    refuse(pointer, std::string("in three dimensions a ") + what + " has three lengths");
  return read;
}

Eigen::Vector3d SceneFields::direction(const std::string& pointer) const {
  const auto written = value<std::array<double, 3>>(pointer);
  const Eigen::Vector3d direction(written[0], written[1], written[2]);
  if (!(direction.norm() > 1e-9 && direction.norm() < 1e9))
    refuse(pointer, "this axis has no direction\ngive three numbers that are not all 0");
  return direction.normalized();
}

std::filesystem::path SceneFields::file(const std::string& pointer) const {
  const auto name = value<std::string>(pointer);
  if (name.find('\0') != std::string::npos) refuse(pointer, "a file's name cannot hold a NUL character");
  auto file = std::filesystem::path(document_.file()).parent_path() / name;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    refuse(pointer,
           in_quotes(name) +
               (std::filesystem::exists(file, ignored) ? " is no plain file (folders, pipes and devices are not read)"
                                                       : " is no file") +
               "; a relative name begins with the scene's folder\nlooked for: " +
               printable(file.lexically_normal().string()));
  }
  return file;
}

std::string SceneFields::line(const std::string& pointer) const {
  auto text = value<std::string>(pointer);
  if (printable(text) != text) {
    refuse(pointer, in_quotes(text) + " holds a control character; " + json::subject(pointer) +
                        " is printed on one line: leave it out");
  }
  return text;
}

ModelChoice SceneFields::model(const std::string& pointer) const {
  const std::string parameters = pointer + "/parameters";
  return {value<std::string>(pointer + "/model"), has(parameters) ? at(parameters) : nlohmann::json::object(), pointer};
}

int SceneFields::cell_type(const std::string& pointer, const std::vector<CellType>& types,
                           const std::vector<std::string>& others) const {
  const auto name = value<std::string>(pointer);
  for (std::size_t i = 0; i < types.size(); ++i)
    if (types[i].name == name) return static_cast<int>(i);
  if (types.empty()) {
    if (lacks_types_ || !settled("/cell_types")) throw Misread{};
    lacks_types_ = faults_ != nullptr;
  }
  std::vector<std::string> names;
  names.reserve(types.size());
  for (const auto& type : types) names.push_back(type.name);
  const std::string there = "\ncell_types has: " + listed(names);
  names.insert(names.end(), others.begin(), others.end());
  refuse(pointer, "no cell type is called " + in_quotes(name) + did_you_mean(name, names) + there);
}

void SceneFields::require(const std::string& pointer, const std::string& key, const std::string& otherwise) const {
  const std::string member = json::child_pointer(pointer, key);
  if (has(member)) return;
  // Open numerics are chosen when the schema has found nothing.
  const bool open = has("/numerics") && (at("/numerics") == "auto" || has("/numerics/auto"));
  if ((of_schema_ > 0 && open) || !has(pointer) || !settled(member)) throw Misread{};
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
