// Settings that make a scene's lattice and membranes finer or coarser, together or one alone.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "matrix.hpp"
#include "scene/dimension_words.hpp"
#include "shape/extent.hpp"
#include "units/units.hpp"

namespace rouleau::trial {

namespace {

using Json = nlohmann::json;

double length_of(const Json& quantity) {
  if (quantity.is_number()) return quantity.get<double>();
  return quantity.is_string() ? units::Units().to_si(quantity.get<std::string>(), "m", "length") : NAN;
}

/// The first cell's type; null without one.
const Json* first_type(const Json& scene) {
  const Json cells = scene.value("cells", Json::array());
  const auto typed = std::find_if(cells.begin(), cells.end(), [](const Json& entry) { return entry.contains("type"); });
  if (!cells.is_array() || typed == cells.end()) return nullptr;  // cells in a file alone have no type here
  return &scene.at("cell_types").at(typed->at("type").get<std::string>());
}

/// Radius of a type, or half its longest axis, in lattice spacings of the scene; NaN of a mesh.
double radius_in_spacings(const Json& scene, const Json& type) {
  const Json& of = type.at("shape").begin().value();
  double length = NAN;
  if (of.contains("radius")) length = length_of(of.at("radius"));
  for (const Json& axis : of.value("semi_axes", Json::array())) length = std::fmax(length, length_of(axis));
  const Json& domain = scene.at("domain");
  return length / (length_of(domain.at("size").at(0)) / domain.at("nodes").at(0).get<double>());
}

class Refinement {
 public:
  Refinement(const json::Document& document, std::string pointer, const Json& scene)
      : document_(document),
        axis_(std::move(pointer)),
        scene_(scene),
        key_(scene::words_of(static_cast<int>(scene.at("domain").at("nodes").size())).segments),
        of_(document.root()[Json::json_pointer(axis_)].value("of", "both")) {}

  [[nodiscard]] std::vector<Setting> settings() const {
    std::vector<Setting> all;
    const std::size_t count = document_.root()[Json::json_pointer(axis_ + "/refine")].size();
    for (std::size_t i = 0; i < count; ++i) all.push_back(setting(json::child_pointer(axis_ + "/refine", i)));
    return all;
  }

 private:
  [[nodiscard]] Setting setting(const std::string& pointer) const {
    const double factor = document_.root()[Json::json_pointer(pointer)].get<double>();
    Setting setting;
    const Json* first = first_type(scene_);
    if (of_ == "membranes") {
      if (first == nullptr)
        throw Error(Cause::bad_input, document_.place(axis_ + "/of"),
                    "the scene has no cells whose membranes this is of");
      setting.position = static_cast<double>(pieces(*first, "of the first cell", factor));
    } else {
      Json nodes = Json::array();
      for (const Json& base : scene_["domain"]["nodes"]) nodes.push_back(whole(base.get<long>(), factor, pointer));
      setting.set.emplace_back("/domain/nodes", nodes);
      setting.position = first == nullptr ? NAN : factor * radius_in_spacings(scene_, *first);
      if (std::isnan(setting.position)) setting.position = nodes[1].get<double>();
    }
    const Json types = scene_.value("cell_types", Json::object());
    for (const auto& [name, type] : types.items()) {
      const bool follows = !type.contains(key_) && !type.at("shape").contains("mesh");
      if (of_ == "both" && follows) continue;  // nodes of such a surface lie a lattice spacing apart anyway
      const long changed = pieces(type, "of " + in_quotes(name), of_ == "lattice" ? 1 : factor);
      if (of_ == "lattice") continue;
      setting.set.emplace_back(json::child_pointer(json::child_pointer("/cell_types", name), key_), changed);
    }
    setting.label = number(setting.position, 3);
    // Whole numbers in full: 1024 nodes, not 1.02e+03.
    if (std::abs(setting.position - std::round(setting.position)) < 1e-9 * setting.position)
      setting.label = std::to_string(std::lround(setting.position));
    return setting;
  }

  /// Segments or triangles of a type whose pieces are so many times shorter.
  [[nodiscard]] long pieces(const Json& type, const std::string& whose, double factor) const {
    if (type.contains("segments")) return std::lround(type.at("segments").get<double>() * factor);
    if (type.contains("triangles")) return shape::divided_triangles(type["triangles"].get<int>(), 1 / factor);
    if (type.at("shape").contains("mesh")) {
      if (of_ == "lattice") return 0;
      throw Error(Cause::bad_input, document_.place(axis_),
                  "the membrane " + whose + " is a mesh from a file, which cannot be divided",
                  {"say \"of\": \"lattice\", and make an axis of files with the pointer of shape/mesh/file"});
    }
    throw Error(Cause::bad_input, document_.place(axis_),
                "the triangles " + whose + " follow the lattice, for the scene does not say how many there are",
                {"give its \"triangles\" (20 n^2), for example by the study's \"set\""});
  }

  [[nodiscard]] long whole(long base, double factor, const std::string& pointer) const {
    const double nodes = static_cast<double>(base) * factor;
    const long rounded = std::lround(nodes);
    if (rounded > 0 && std::abs(nodes - static_cast<double>(rounded)) < 1e-9 * nodes) return rounded;
    const Json& all = scene_["domain"]["nodes"];
    long step = 0;  // multiples of 1/step keep all numbers of nodes whole
    for (const Json& count : all) step = std::gcd(step, count.get<long>());
    const auto steps = static_cast<double>(step);
    throw Error(Cause::bad_input, document_.place(pointer),
                "a factor of " + number(factor) + " makes " + number(nodes, 9) + " of the scene's " +
                    std::to_string(base) + " nodes, which is not whole; write a multiple of 1/" + std::to_string(step) +
                    ", for example " + number(std::max(1.0, std::round(factor * steps)) / steps, 12));
  }

  const json::Document& document_;
  std::string axis_;
  const Json& scene_;
  std::string key_;  ///< of the number of pieces that a membrane is cut into
  std::string of_;
};

}  // namespace

std::vector<Setting> refined_settings(const json::Document& document, const std::string& pointer,
                                      const Json& base_scene) {
  try {
    return Refinement(document, pointer, base_scene).settings();
  } catch (const units::UnitError& error) {
    throw Error(Cause::bad_input, document.place("/scene"),
                "the scene cannot be refined: " + std::string(error.what()));
  } catch (const Json::exception&) {
    throw Error(
        Cause::bad_input, document.place(pointer + "/refine"),
        "the scene cannot be refined: that wants domain.nodes, in two dimensions the segments of every cell type, and "
        "cells of types that there are");
  }
}

}  // namespace rouleau::trial
