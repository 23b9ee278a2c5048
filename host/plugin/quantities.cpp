#include "quantities.hpp"

#include <map>

namespace rouleau::plugin {

namespace {

struct Quantity {
  units::Dimension dimension;
  const char* unit;
};

/// Lengths of the two-dimensional world are metres; what is per unit depth there is so in SI, too.
const Quantity& quantity_of(const Manifest& manifest, const std::string& name) {
  static const Quantity number{{}, ""};
  static const std::map<std::string, Quantity> quantities = {{"stretch", number},
                                                             {"stretch_rate", {{{0, 0, -1}}, "1/s"}},
                                                             {"curvature", {{{0, -1, 0}}, "1/m"}},
                                                             {"rest_curvature", {{{0, -1, 0}}, "1/m"}},
                                                             {"area", {{{0, 2, 0}}, "m2"}},
                                                             {"rest_area", {{{0, 2, 0}}, "m2"}},
                                                             {"perimeter", {{{0, 1, 0}}, "m"}},
                                                             {"rest_perimeter", {{{0, 1, 0}}, "m"}},
                                                             {"tension", {{{1, 0, -2}}, "N/m"}},
                                                             {"moment", {{{1, 1, -2}}, "N"}},
                                                             {"pressure", {{{1, -1, -2}}, "Pa"}},
                                                             {"perimeter_tension", {{{1, 0, -2}}, "N/m"}},
                                                             {"energy", {{{1, 0, -2}}, "J/m2"}},
                                                             {"tension_by_stretch", {{{1, 0, -2}}, "N/m"}},
                                                             {"tension_by_rate", {{{1, 0, -1}}, "N s/m"}},
                                                             {"moment_by_curvature", {{{1, 2, -2}}, "J"}},
                                                             {"distance", {{{0, 1, 0}}, "m"}},
                                                             {"normal_velocity", {{{0, 1, -1}}, "m/s"}},
                                                             {"tangential_velocity", {{{0, 1, -1}}, "m/s"}},
                                                             {"force", {{{1, -1, -2}}, "Pa"}},
                                                             {"force_by_distance", {{{1, -2, -2}}, "Pa/m"}}};
  static const Quantity energy_of_cell{{{1, 1, -2}}, "J/m"};
  if (manifest.kind == ModelKind::collision) return number;
  const bool of_cell = manifest.gives_output("pressure") || manifest.gives_output("perimeter_tension");
  return name == "energy" && of_cell ? energy_of_cell : quantities.at(name);
}

}  // namespace

const char* to_string(ModelKind kind) {
  switch (kind) {
    case ModelKind::collision:
      return "collision";
    case ModelKind::membrane:
      return "membrane";
    case ModelKind::interaction:
      return "interaction";
  }
  return "unknown";
}

const char* to_string(MembraneElement element) {
  switch (element) {
    case MembraneElement::segment:
      return "segment";
    case MembraneElement::node:
      return "node";
    case MembraneElement::cell:
      return "cell";
  }
  return "unknown";
}

const std::vector<std::string>& inputs_of(ModelKind kind) {
  static const std::map<ModelKind, std::vector<std::string>> inputs = {
      {ModelKind::collision, {"populations", "force", "relaxation_rate"}},
      {ModelKind::membrane,
       {"stretch", "stretch_rate", "curvature", "rest_curvature", "area", "rest_area", "perimeter", "rest_perimeter"}},
      {ModelKind::interaction, {"distance", "normal_velocity", "tangential_velocity"}}};
  return inputs.at(kind);
}

const std::vector<std::string>& outputs_of(ModelKind kind) {
  static const std::map<ModelKind, std::vector<std::string>> outputs = {
      {ModelKind::collision, {"populations", "velocity"}},
      {ModelKind::membrane,
       {"tension", "moment", "pressure", "perimeter_tension", "energy", "tension_by_stretch", "tension_by_rate",
        "moment_by_curvature"}},
      {ModelKind::interaction, {"energy", "force", "force_by_distance"}}};
  return outputs.at(kind);
}

std::optional<MembraneElement> element_of(const std::string& name) {
  static const std::map<std::string, MembraneElement> elements = {
      {"stretch", MembraneElement::segment},          {"stretch_rate", MembraneElement::segment},
      {"tension", MembraneElement::segment},          {"tension_by_stretch", MembraneElement::segment},
      {"tension_by_rate", MembraneElement::segment},  {"curvature", MembraneElement::node},
      {"rest_curvature", MembraneElement::node},      {"moment", MembraneElement::node},
      {"moment_by_curvature", MembraneElement::node}, {"area", MembraneElement::cell},
      {"rest_area", MembraneElement::cell},           {"perimeter", MembraneElement::cell},
      {"rest_perimeter", MembraneElement::cell},      {"pressure", MembraneElement::cell},
      {"perimeter_tension", MembraneElement::cell}};
  const auto found = elements.find(name);
  return found == elements.end() ? std::nullopt : std::optional(found->second);
}

units::Dimension dimension_of(const Manifest& manifest, const std::string& name) {
  return quantity_of(manifest, name).dimension;
}

std::string unit_of(const Manifest& manifest, const std::string& name) { return quantity_of(manifest, name).unit; }

}  // namespace rouleau::plugin
