#include "quantities.hpp"

#include <map>

namespace rouleau::host {

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

}  // namespace rouleau::host
