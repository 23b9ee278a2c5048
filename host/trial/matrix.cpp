#include "matrix.hpp"

#include <cmath>
#include <set>

#include "base/text.hpp"
#include "json/document.hpp"
#include "json/json_pointer.hpp"
#include "units/units.hpp"

namespace rouleau::trial {

namespace {

using Json = nlohmann::json;

const Json& value_at(const json::Document& document, const std::string& pointer) {
  return document.root()[Json::json_pointer(pointer)];
}

/// Keys of the object at a pointer in the order of the text, which the parsed object does not keep.
std::vector<std::string> keys_in_order(const json::Document& document, const std::string& pointer) {
  json::TextTree::Index node = 0;
  const auto tokens = json::split_pointer(pointer).value();
  for (const std::string& token : tokens) node = document.tree().child(document.text(), node, token).value();
  std::vector<std::string> keys;
  for (const json::TextTree::Index child : document.tree().children(node))
    keys.push_back(json::TextTree::key(document.text(), document.tree()[child].key));
  return keys;
}

/// How a value is called in charts and tables.
std::string label_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return number(value.get<double>());
  if (value.is_object() && value.contains("model") && value["model"].is_string()) return value["model"];
  if (value.is_object() && value.size() == 1) return value.begin().key();
  if (!value.is_array()) return value.dump();
  std::string label;
  for (const Json& part : value) label += (label.empty() ? "" : ", ") + label_of(part);
  return label;
}

/// The number that a value stands for, in SI where it has a unit; NaN for any other.
double position_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  if (value.is_array() && !value.empty()) return position_of(value[0]);
  if (!value.is_string()) return NAN;
  const std::string text = value.get<std::string>();
  char* end = nullptr;
  const double count = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  if (end == text.c_str() || unit.empty() || unit.front() != ' ') return NAN;
  try {
    return count * units::Units().scale(unit.substr(1));
  } catch (const units::UnitError&) {
    return NAN;
  }
}

void put(Json& scene, const std::string& pointer, const Json& value, const Place& place) {
  try {
    json::put_value(scene, pointer, value);
  } catch (const json::PutError& error) {
    throw Error(Cause::bad_input, place, "of the scene: " + std::string(error.what()));
  }
}

class AxisReader {
 public:
  AxisReader(const json::Document& document, std::string pointer, const Json& scene)
      : document_(document), pointer_(std::move(pointer)), scene_(scene), axis_(value_at(document, pointer_)) {}

  [[nodiscard]] Axis read() const {
    Axis axis{axis_["name"], {}, axis_.contains("refine") && axis_.value("of", "both") != "membranes"};
    if (axis_.contains("refine")) axis.settings = refined_settings(document_, pointer_, scene_);
    if (axis_.contains("values")) axis.settings = values();
    if (axis_.contains("settings")) axis.settings = named();
    if (axis_.contains("threads")) axis.settings = threads();
    relabel(axis);
    check_labels(axis);
    return axis;
  }

 private:
  [[noreturn]] void refuse(const std::string& pointer, const std::string& problem) const {
    throw Error(Cause::bad_input, document_.place(pointer), problem);
  }

  [[nodiscard]] std::vector<Setting> values() const {
    const bool zipped = axis_.contains("pointers");
    const std::vector<std::string> pointers =
        zipped ? axis_["pointers"].get<std::vector<std::string>>() : std::vector<std::string>{axis_["pointer"]};
    std::vector<Setting> settings;
    for (std::size_t i = 0; i < axis_["values"].size(); ++i) {
      const std::string place = json::child_pointer(pointer_ + "/values", i);
      const Json& value = axis_["values"][i];
      if (zipped && value.size() != pointers.size())
        refuse(place, std::to_string(value.size()) + " values for " + std::to_string(pointers.size()) +
                          " pointers; write one value for each");
      Setting setting{label_of(value), {}, position_of(value)};
      Json tried = scene_;
      for (std::size_t k = 0; k < pointers.size(); ++k) {
        setting.set.emplace_back(pointers[k], zipped ? value[k] : value);
        const std::string from = zipped ? json::child_pointer(pointer_ + "/pointers", k) : pointer_ + "/pointer";
        put(tried, pointers[k], setting.set.back().second, document_.place(from));
      }
      settings.push_back(std::move(setting));
    }
    return settings;
  }

  [[nodiscard]] std::vector<Setting> named() const {
    std::vector<Setting> settings;
    for (const std::string& name : keys_in_order(document_, pointer_ + "/settings")) {
      const std::string place = json::child_pointer(pointer_ + "/settings", name);
      Setting setting{name, {}, position_of(name)};
      Json tried = scene_;
      put_changes(tried, document_, place);
      for (const std::string& key : keys_in_order(document_, place))
        setting.set.emplace_back(key, value_at(document_, place)[key]);
      settings.push_back(std::move(setting));
    }
    return settings;
  }

  [[nodiscard]] std::vector<Setting> threads() const {
    std::vector<Setting> settings;
    for (const Json& count : axis_["threads"])
      settings.push_back({count.dump(), {}, count.get<double>(), count.get<int>()});
    return settings;
  }

  void relabel(Axis& axis) const {
    if (!axis_.contains("labels")) return;
    const Json& labels = axis_["labels"];
    if (labels.size() != axis.settings.size())
      refuse(pointer_ + "/labels", std::to_string(labels.size()) + " labels for " +
                                       std::to_string(axis.settings.size()) + " settings; write one for each");
    for (std::size_t i = 0; i < labels.size(); ++i) axis.settings[i].label = labels[i];
  }

  void check_labels(const Axis& axis) const {
    const auto check = [&](const std::string& pointer, const std::string& label) {
      if (printable(label) == label) return;
      refuse(pointer, in_quotes(label) +
                          " holds a control character; names and labels are printed on one line: leave it "
                          "out");
    };
    check(pointer_ + "/name", axis.name);
    std::set<std::string> seen;
    for (const Setting& setting : axis.settings) {
      check(pointer_, setting.label);
      if (seen.insert(setting.label).second) continue;
      refuse(pointer_, "two settings of this axis are called " + in_quotes(setting.label) +
                           "; leave one out, or tell them apart by \"labels\"");
    }
  }

  const json::Document& document_;
  std::string pointer_;
  const Json& scene_;
  const Json& axis_;
};

const Setting& setting_of(const Axis& axis, const Point& point, std::size_t index) {
  return axis.settings[point.setting[index]];
}

}  // namespace

std::vector<Axis> read_axes(const json::Document& document, const std::string& pointer, const Json& base_scene) {
  constexpr std::size_t most_points = 10'000;
  std::size_t points = 1;
  std::vector<Axis> axes;
  std::set<std::string> names;
  for (std::size_t i = 0; i < value_at(document, pointer).size(); ++i) {
    const std::string place = json::child_pointer(pointer, i);
    axes.push_back(AxisReader(document, place, base_scene).read());
    if (!names.insert(axes.back().name).second)
      throw Error(Cause::bad_input, document.place(place + "/name"),
                  "two axes are called " + in_quotes(axes.back().name) + "; give each its own name");
    points *= axes.back().settings.size();
    if (points > most_points)
      throw Error(Cause::bad_input, document.place(place),
                  "with this axis the matrix has " + std::to_string(points) + " points; at most " +
                      std::to_string(most_points) + " can be run: take fewer axes or values");
  }
  return axes;
}

std::vector<Point> cross(const std::vector<Axis>& axes) {
  std::vector<Point> points{Point{}};
  for (const Axis& axis : axes) {
    std::vector<Point> more;
    for (const Point& point : points) {
      for (std::size_t i = 0; i < axis.settings.size(); ++i) {
        more.push_back(point);
        more.back().setting.push_back(static_cast<int>(i));
      }
    }
    points = std::move(more);
  }
  return points;
}

Json scene_of(const Json& base, const std::vector<Axis>& axes, const Point& point) {
  Json scene = base;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Setting& setting = setting_of(axes[a], point, a);
    const Place place{"axis " + in_quotes(axes[a].name) + ", setting " + in_quotes(setting.label), {}, 0, 0};
    for (const auto& [pointer, value] : setting.set) put(scene, pointer, value, place);
  }
  return scene;
}

int threads_of(const std::vector<Axis>& axes, const Point& point, int otherwise) {
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const int threads = setting_of(axes[a], point, a).threads;
    if (threads > 0) otherwise = threads;
  }
  return otherwise;
}

Json labels_of(const std::vector<Axis>& axes, const Point& point) {
  Json labels = Json::object();
  for (std::size_t a = 0; a < axes.size(); ++a) labels[axes[a].name] = setting_of(axes[a], point, a).label;
  return labels;
}

std::string name_of(const std::vector<Axis>& axes, const Point& point) {
  std::string name;
  for (std::size_t a = 0; a < axes.size(); ++a)
    name += (name.empty() ? "" : ", ") + axes[a].name + ' ' + setting_of(axes[a], point, a).label;
  return name.empty() ? "the scene" : name;
}

void put_changes(Json& scene, const json::Document& document, const std::string& pointer) {
  for (const std::string& key : keys_in_order(document, pointer))
    put(scene, key, value_at(document, pointer)[key], document.key_place(json::child_pointer(pointer, key)));
}

}  // namespace rouleau::trial
