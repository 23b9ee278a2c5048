#include "study_document.hpp"

#include <algorithm>
#include <set>

#include "embedded_schemas.hpp"
#include "input/json_pointer.hpp"
#include "input/scene.hpp"
#include "input/schema.hpp"
#include "input/wording.hpp"
#include "shared_keys.hpp"

namespace rouleau::host {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The scene with the changes of "set", found right as far as that can be said without plugins.
json read_base_scene(const Document& document, const fs::path& scene_file) {
  const json& given = document.root()["scene"];
  json scene = read_changed_scene(document, scene_file, "study's");
  try {
    validate(Document::parse(scene.dump(2), scene_file.string()), scene_schema());
  } catch (const Error& error) {
    // The changed scene has no lines of its own: those of the study, or of its "set".
    const std::string what = error.what(), problem = what.substr(std::min(what.find('\n') + 3, what.size()));
    if (!given.is_string()) throw Error(ExitCode::bad_input, document.place("/scene" + error.place().pointer), problem);
    throw Error(ExitCode::bad_input, document.place("/set"),
                "the scene with these changes is wrong, " + error.place().pointer + ": " + problem);
  }
  return scene;
}

/// An axis is a fault of the study, and not a result, where no setting of it fits the scene's schema.
void refuse_useless_axes(const Study& study) {
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    std::string first;
    bool any = false;
    for (std::size_t i = 0; i < study.axes[a].settings.size() && !any; ++i) {
      Point point = study.default_point;
      point.setting[a] = static_cast<int>(i);
      try {
        validate(Document::parse(scene_of(study.scene, study.axes, point).dump(2), "the scene"), scene_schema());
        any = true;
      } catch (const Error& error) {
        if (first.empty())
          first = error.place().pointer + std::string(error.what()).substr(to_string(error.place()).size());
      }
    }
    if (!any)
      throw Error(ExitCode::bad_input, study.document->place(child_pointer("/matrix", a)),
                  "no setting of this axis makes a scene that can be run; the first: " + first);
  }
}

std::vector<std::string> labels_in(const Axis& axis) {
  std::vector<std::string> labels;
  for (const Setting& setting : axis.settings) labels.push_back(setting.label);
  return labels;
}

int index_of(const std::vector<std::string>& words, const std::string& word, const Place& place,
             const std::string& what) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end())
    throw Error(ExitCode::bad_input, place,
                in_quotes(word) + " is no " + what + did_you_mean(word, words) + "; there are: " + listed(words));
  return static_cast<int>(found - words.begin());
}

int read_line(const Study& study) {
  const json& root = study.document->root();
  std::vector<std::string> names;
  for (const Axis& axis : study.axes) names.push_back(axis.name);
  if (root.contains("line")) return index_of(names, root["line"], study.document->place("/line"), "axis of the matrix");
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    if (study.axes[a].refines) return static_cast<int>(a);
  }
  return study.axes.empty() ? -1 : 0;
}

Point read_default(const Study& study) {
  const Document& document = *study.document;
  Point point;
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    int first = 0;
    if (study.axes[a].refines) {
      const json& factors = document.root()["matrix"][a]["refine"];
      const auto one = std::find(factors.begin(), factors.end(), json(1));
      first = one == factors.end() ? 0 : static_cast<int>(one - factors.begin());
    }
    point.setting.push_back(first);
  }
  std::vector<std::string> names;
  for (const Axis& axis : study.axes) names.push_back(axis.name);
  const json given = document.root().value("default", json::object());
  for (const auto& [name, label] : given.items()) {
    const std::string place = child_pointer("/default", name);
    const auto axis = static_cast<std::size_t>(index_of(names, name, document.key_place(place), "axis of the matrix"));
    point.setting[axis] = index_of(labels_in(study.axes[axis]), label, document.place(place), "label of this axis");
  }
  return point;
}

std::vector<Quantity> read_quantities(const Document& document) {
  std::vector<Quantity> quantities;
  std::set<std::string> names;
  for (std::size_t i = 0; i < document.root()["quantities"].size(); ++i) {
    const std::string pointer = child_pointer("/quantities", i);
    quantities.push_back(read_quantity(document, pointer));
    if (!names.insert(quantities.back().name).second)
      throw Error(ExitCode::bad_input, document.place(pointer + "/name"),
                  "two quantities are called " + in_quotes(quantities.back().name) + "; give each its own name");
  }
  return quantities;
}

}  // namespace

Study read_study(const fs::path& file) {
  Study study;
  study.document = std::make_shared<const Document>(Document::read(file));
  const Document& document = *study.document;
  validate(document, study_schema());
  const json& root = document.root();
  study.title = root.value("title", file.stem().string());
  study.file = file;
  study.scene_file = scene_file_of(document, file);
  study.scene = read_base_scene(document, study.scene_file);
  study.axes = read_axes(document, "/matrix", study.scene);
  study.default_point = read_default(study);
  study.line = read_line(study);
  refuse_useless_axes(study);
  study.quantities = read_quantities(document);
  study.threads = root.value("threads", study.threads);
  study.repeats = root.value("repeats", study.repeats);
  study.warm_up = root.value("warm_up", study.warm_up);
  if (root.contains("time_limit")) study.time_limit_s = read_time_limit(document, "10 min");
  return study;
}

const json& study_schema() {
  static const json schema = with_matrix_definitions(study_schema_text);
  return schema;
}

const json& study_result_schema() {
  static const json schema = json::parse(study_result_schema_text);
  return schema;
}

}  // namespace rouleau::host
