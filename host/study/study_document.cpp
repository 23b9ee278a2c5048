#include "study_document.hpp"

#include <algorithm>
#include <set>

#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json/json_pointer.hpp"

namespace rouleau::study {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// An axis is a fault of the study, and not a result, where no setting of it fits the scene's schema.
void refuse_useless_axes(const Study& study) {
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    std::string first;
    bool any = false;
    for (std::size_t i = 0; i < study.axes[a].settings.size() && !any; ++i) {
      trial::Point point = study.default_point;
      point.setting[a] = static_cast<int>(i);
      try {
        trial::check_scene(trial::scene_of(study.scene, study.axes, point), "the scene");
        any = true;
      } catch (const Error& error) {
        if (first.empty()) first = error.place().pointer + "\n  " + error.words();
      }
    }
    if (!any)
      throw Error(Cause::bad_input, study.document->place(json::child_pointer("/matrix", a)),
                  "no setting of this axis makes a scene that can be run; the first: " + first);
  }
}

std::vector<std::string> labels_in(const trial::Axis& axis) {
  std::vector<std::string> labels;
  for (const trial::Setting& setting : axis.settings) labels.push_back(setting.label);
  return labels;
}

int index_of(const std::vector<std::string>& words, const std::string& word, const Place& place,
             const std::string& what) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end())
    throw Error(Cause::bad_input, place,
                in_quotes(word) + " is no " + what + did_you_mean(word, words) + "; there are: " + listed(words));
  return static_cast<int>(found - words.begin());
}

int read_line(const Study& study) {
  const Json& root = study.document->root();
  std::vector<std::string> names;
  for (const trial::Axis& axis : study.axes) names.push_back(axis.name);
  if (root.contains("line")) return index_of(names, root["line"], study.document->place("/line"), "axis of the matrix");
  for (std::size_t a = 0; a < study.axes.size(); ++a)
    if (study.axes[a].refines) return static_cast<int>(a);
  return study.axes.empty() ? -1 : 0;
}

trial::Point read_default(const Study& study) {
  const json::Document& document = *study.document;
  trial::Point point;
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    int first = 0;
    if (const Json& axis = document.root()["matrix"][a]; axis.contains("refine")) {
      const Json& factors = axis["refine"];
      const auto one = std::find(factors.begin(), factors.end(), Json(1));
      first = one == factors.end() ? 0 : static_cast<int>(one - factors.begin());
    }
    point.setting.push_back(first);
  }
  std::vector<std::string> names;
  for (const trial::Axis& axis : study.axes) names.push_back(axis.name);
  const Json given = document.root().value("default", Json::object());
  for (const auto& [name, label] : given.items()) {
    const std::string place = json::child_pointer("/default", name);
    const auto axis = static_cast<std::size_t>(index_of(names, name, document.key_place(place), "axis of the matrix"));
    point.setting[axis] = index_of(labels_in(study.axes[axis]), label, document.place(place), "label of this axis");
  }
  return point;
}

std::vector<Quantity> read_quantities(const json::Document& document) {
  std::vector<Quantity> quantities;
  std::set<std::string> names;
  for (std::size_t i = 0; i < document.root()["quantities"].size(); ++i) {
    const std::string pointer = json::child_pointer("/quantities", i);
    quantities.push_back(read_quantity(document, pointer));
    if (!names.insert(quantities.back().name).second)
      throw Error(Cause::bad_input, document.place(pointer + "/name"),
                  "two quantities are called " + in_quotes(quantities.back().name) + "; give each its own name");
  }
  return quantities;
}

}  // namespace

Study read_study(const fs::path& file) {
  Study study;
  static_cast<trial::CampaignFile&>(study) = trial::read_campaign_file(trial::study_kind, file, study_schema());
  const Json& root = study.document->root();
  study.default_point = read_default(study);
  study.line = read_line(study);
  refuse_useless_axes(study);
  study.quantities = read_quantities(*study.document);
  study.threads = root.value("threads", study.threads);
  study.repeats = root.value("repeats", study.repeats);
  study.warm_up = root.value("warm_up", study.warm_up);
  return study;
}

}  // namespace rouleau::study
