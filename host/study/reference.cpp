#include "reference.hpp"

#include <filesystem>

#include "base/synonyms.hpp"
#include "json/document.hpp"
#include "json/shown.hpp"
#include "study_reader.hpp"

namespace rouleau::study {

namespace {

/// The number at a JSON pointer of a file that the study names.
double number_of_file(const StudyReader& reader, const json::Document& file, const std::string& pointer) {
  const std::string inside = reader.text(pointer);
  const auto tokens = json::split_pointer(inside);
  if (!tokens) {
    reader.scene_fields().refuse(pointer, in_quotes(inside) + " is no JSON pointer (for example \"/0/steady/D\")");
  }
  const nlohmann::json* at = &file.root();
  std::string reached;
  for (const std::string& token : *tokens) {
    const auto index = json::array_index(token);
    const nlohmann::json* next = nullptr;
    if (at->is_object() && at->contains(token)) next = &at->at(token);
    if (at->is_array() && index && *index < at->size()) next = &at->at(*index);
    if (next == nullptr) {
      std::vector<std::string> names;
      if (at->is_object())
        for (const auto& [name, value] : at->items()) names.push_back(name);
      reader.scene_fields().refuse(
          pointer, file.file() + " has nothing at " + in_quotes(inside) + ": " +
                       (reached.empty() ? "the document" : in_quotes(reached)) +
                       (at->is_array() ? " has the entries 0 to " + std::to_string(static_cast<long>(at->size()) - 1)
                                       : " has " + listed(names)) +
                       did_you_mean(token, names));
    }
    at = next;
    reached = json::child_pointer(reached, token);
  }
  if (!at->is_number())
    reader.scene_fields().refuse(
        pointer, file.file() + " has " + json::shown(*at) + " at " + in_quotes(inside) + ", which is not a number");
  return at->get<double>();
}

Reference reference_of_file(const StudyReader& reader, const json::Document& document, const std::string& pointer) {
  const std::string whose = "a reference with \"file\"";
  reader.only(pointer, {"file", "pointer", "uncertainty", "factor", "offset", "source"}, whose);
  reader.needs(pointer, "pointer", whose);
  const std::string name = reader.text(pointer + "/file");
  const json::Document file = json::Document::read(std::filesystem::path(document.file()).parent_path() / name);
  const double factor = reader.has(pointer + "/factor") ? reader.number(pointer + "/factor") : 1.0;
  const double offset = reader.has(pointer + "/offset") ? reader.number(pointer + "/offset") : 0.0;
  Reference result;
  result.kind = ReferenceKind::file;
  result.value = factor * number_of_file(reader, file, pointer + "/pointer") + offset;
  if (reader.has(pointer + "/uncertainty")) {
    result.uncertainty = reader.is_text(pointer + "/uncertainty")
                             ? std::abs(factor * number_of_file(reader, file, pointer + "/uncertainty"))
                             : reader.number(pointer + "/uncertainty");
  }
  result.source = reader.has(pointer + "/source") ? reader.text(pointer + "/source")
                                                  : name + " " + reader.text(pointer + "/pointer");
  return result;
}

Reference reference_of_value(const StudyReader& reader, const std::string& pointer) {
  reader.only(pointer, {"value", "uncertainty", "source"}, "a reference with \"value\"");
  Reference result;
  result.kind = ReferenceKind::value;
  result.value = reader.number(pointer + "/value");
  if (reader.has(pointer + "/uncertainty")) result.uncertainty = reader.number(pointer + "/uncertainty");
  result.source = reader.has(pointer + "/source") ? reader.text(pointer + "/source") : "given in the study";
  return result;
}

Reference reference_of_any_kind(const StudyReader& reader, const json::Document& document, const std::string& pointer) {
  const scene::SceneFields& scene = reader.scene_fields();
  Reference result;
  if (scene.at(pointer).is_string()) {
    reader.choice(pointer, {"richardson"});
    return result;
  }
  if (!scene.at(pointer).is_object()) {
    scene.refuse(pointer,
                 "a reference is \"richardson\", or an object with one of value, file, analytic, richardson, point");
  }
  if (reader.has(pointer + "/value")) return reference_of_value(reader, pointer);
  if (reader.has(pointer + "/file")) return reference_of_file(reader, document, pointer);
  if (reader.has(pointer + "/analytic")) {
    reader.only(pointer, {"analytic"}, "a reference with \"analytic\"");
    reader.choice(pointer + "/analytic", {"zero"});
    result.kind = ReferenceKind::analytic;
    result.value = 0;
    result.source = "exactly zero";
    return result;
  }
  if (reader.has(pointer + "/point")) {
    reader.only(pointer, {"point"}, "a reference with \"point\"");
    result.kind = ReferenceKind::point;
    result.labels = reader.labels(pointer + "/point");
    return result;
  }
  reader.only(pointer, {"richardson"}, "a reference");
  reader.needs(pointer, "richardson", "a reference that is an object");
  result.labels = reader.labels(pointer + "/richardson");
  return result;
}

}  // namespace

Reference read_reference(const scene::SceneFields& scene_fields, const json::Document& document,
                         const std::string& pointer) {
  Reference result = reference_of_any_kind(StudyReader(scene_fields), document, pointer);
  if (result.uncertainty < 0) scene_fields.refuse(pointer + "/uncertainty", "an uncertainty must not be below 0");
  return result;
}

const char* name_of(ReferenceKind kind) {
  switch (kind) {
    case ReferenceKind::value:
      return "value";
    case ReferenceKind::file:
      return "file";
    case ReferenceKind::analytic:
      return "analytic";
    case ReferenceKind::richardson:
      return "richardson";
    case ReferenceKind::point:
      return "point";
  }
  return "";
}

}  // namespace rouleau::study
