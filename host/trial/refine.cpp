// Settings that make a scene's lattice and membranes finer or coarser together.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "matrix.hpp"
#include "units/units.hpp"

namespace rouleau::trial {

namespace {

using Json = nlohmann::json;

double length_of(const Json& quantity) {
  if (quantity.is_number()) return quantity.get<double>();
  return quantity.is_string() ? units::Units().to_si(quantity.get<std::string>(), "m", "length") : NAN;
}

/// Radius of the first cell's type, or half its longest axis, in lattice spacings of the base scene; NaN without cells.
double radius_in_spacings(const Json& scene) {
  const Json cells = scene.value("cells", Json::array());
  const auto typed = std::find_if(cells.begin(), cells.end(), [](const Json& entry) { return entry.contains("type"); });
  if (!cells.is_array() || typed == cells.end()) return NAN;  // cells in a file alone have no type here
  const Json& first = *typed;
  const Json& shape = scene.at("cell_types").at(first.at("type").get<std::string>()).at("shape");
  const auto kind = shape.begin();
  const Json& of = kind.value();
  Json length;
  if (of.contains("radius")) {
    length = of.at("radius");
  } else if (of.contains("semi_axes")) {
    const Json& axes = of.at("semi_axes");
    length = length_of(axes.at(0)) < length_of(axes.at(1)) ? axes.at(1) : axes.at(0);
  }
  const Json& domain = scene.at("domain");
  const double spacing = length_of(domain.at("size").at(0)) / domain.at("nodes").at(0).get<double>();
  return length_of(length) / spacing;
}

class Refinement {
 public:
  Refinement(const json::Document& document, const Json& scene)
      : document_(document), scene_(scene), radius_(radius_in_spacings(scene)) {}

  [[nodiscard]] Setting setting(const std::string& pointer) const {
    const double factor = document_.root()[Json::json_pointer(pointer)].get<double>();
    Setting setting;
    Json nodes = Json::array();
    for (const Json& base : scene_.at("domain").at("nodes")) nodes.push_back(whole(base.get<long>(), factor, pointer));
    setting.set.emplace_back("/domain/nodes", nodes);
    const Json types = scene_.value("cell_types", Json::object());
    for (const auto& [name, type] : types.items()) {
      const long segments = std::lround(type.at("segments").get<double>() * factor);
      setting.set.emplace_back(json::child_pointer(json::child_pointer("/cell_types", name), "segments"), segments);
    }
    setting.position = std::isnan(radius_) ? nodes[1].get<double>() : radius_ * factor;
    setting.label = number(setting.position, 3);
    // Whole numbers in full: 1024 nodes, not 1.02e+03.
    if (std::abs(setting.position - std::round(setting.position)) < 1e-9 * setting.position)
      setting.label = std::to_string(std::lround(setting.position));
    return setting;
  }

 private:
  [[nodiscard]] long whole(long base, double factor, const std::string& pointer) const {
    const double nodes = static_cast<double>(base) * factor;
    const long rounded = std::lround(nodes);
    if (rounded > 0 && std::abs(nodes - static_cast<double>(rounded)) < 1e-9 * nodes) return rounded;
    const Json& all = scene_["domain"]["nodes"];
    // Multiples of 1/step keep both numbers of nodes whole.
    const long step = std::gcd(all[0].get<long>(), all[1].get<long>());
    const auto steps = static_cast<double>(step);
    throw Error(Cause::bad_input, document_.place(pointer),
                "a factor of " + number(factor) + " makes " + number(nodes, 9) + " of the scene's " +
                    std::to_string(base) + " nodes, which is not whole; write a multiple of 1/" + std::to_string(step) +
                    ", for example " + number(std::max(1.0, std::round(factor * steps)) / steps, 12));
  }

  const json::Document& document_;
  const Json& scene_;
  double radius_;
};

}  // namespace

std::vector<Setting> refined_settings(const json::Document& document, const std::string& pointer,
                                      const Json& base_scene) {
  try {
    const Refinement refinement(document, base_scene);
    std::vector<Setting> settings;
    const Json& factors = document.root()[Json::json_pointer(pointer)];
    for (std::size_t i = 0; i < factors.size(); ++i)
      settings.push_back(refinement.setting(json::child_pointer(pointer, i)));
    return settings;
  } catch (const units::UnitError& error) {
    throw Error(Cause::bad_input, document.place("/scene"),
                "the scene cannot be refined: " + std::string(error.what()));
  } catch (const Json::exception&) {
    throw Error(
        Cause::bad_input, document.place(pointer),
        "the scene cannot be refined: that wants domain.nodes and the segments of every cell type, and cells of "
        "types that there are");
  }
}

}  // namespace rouleau::trial
