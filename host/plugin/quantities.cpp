#include "quantities.hpp"

#include <algorithm>
#include <map>

namespace rouleau::plugin {

namespace {

struct Quantity {
  units::Dimension dimension;
  const char* unit;
};

/// Lengths of the two-dimensional world are metres; what is per unit depth there is so in SI, too. Stresses, energies
/// per length there and per area in three dimensions have the same unit then.
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
                                                             {"invariant_1", number},
                                                             {"invariant_2", number},
                                                             {"area_ratio", number},
                                                             {"volume", {{{0, 3, 0}}, "m3"}},
                                                             {"rest_volume", {{{0, 3, 0}}, "m3"}},
                                                             {"surface_area", {{{0, 2, 0}}, "m2"}},
                                                             {"rest_surface_area", {{{0, 2, 0}}, "m2"}},
                                                             {"tension", {{{1, 0, -2}}, "N/m"}},
                                                             {"moment", {{{1, 1, -2}}, "N"}},
                                                             {"pressure", {{{1, -1, -2}}, "Pa"}},
                                                             {"perimeter_tension", {{{1, 0, -2}}, "N/m"}},
                                                             {"stress_1", {{{1, 0, -2}}, "N/m"}},
                                                             {"stress_2", {{{1, 0, -2}}, "N/m"}},
                                                             {"area_tension", {{{1, 0, -2}}, "N/m"}},
                                                             {"shear_viscosity", {{{1, 0, -1}}, "N s/m"}},
                                                             {"area_viscosity", {{{1, 0, -1}}, "N s/m"}},
                                                             {"surface_tension", {{{1, 0, -2}}, "N/m"}},
                                                             {"energy", {{{1, 0, -2}}, "J/m2"}},
                                                             {"tension_by_stretch", {{{1, 0, -2}}, "N/m"}},
                                                             {"tension_by_rate", {{{1, 0, -1}}, "N s/m"}},
                                                             {"moment_by_curvature", {{{1, 2, -2}}, "J"}},
                                                             {"stress_1_by_1", {{{1, 0, -2}}, "N/m"}},
                                                             {"stress_1_by_2", {{{1, 0, -2}}, "N/m"}},
                                                             {"stress_2_by_2", {{{1, 0, -2}}, "N/m"}},
                                                             {"area_tension_by_ratio", {{{1, 0, -2}}, "N/m"}},
                                                             {"distance", {{{0, 1, 0}}, "m"}},
                                                             {"normal_velocity", {{{0, 1, -1}}, "m/s"}},
                                                             {"tangential_velocity", {{{0, 1, -1}}, "m/s"}},
                                                             {"sliding_speed", {{{0, 1, -1}}, "m/s"}},
                                                             {"force", {{{1, -1, -2}}, "Pa"}},
                                                             {"force_by_distance", {{{1, -2, -2}}, "Pa/m"}}};
  static const Quantity energy_of_cell[2] = {{{{1, 1, -2}}, "J/m"}, {{{1, 2, -2}}, "J"}};  // by dimension
  if (manifest.kind == ModelKind::collision) return number;
  const bool of_cell = manifest.gives_output("pressure") || manifest.gives_output("perimeter_tension") ||
                       manifest.gives_output("surface_tension");
  if (name != "energy" || !of_cell) return quantities.at(name);
  return energy_of_cell[manifest.dimension() - 2];
}

}  // namespace

const char* to_string(MembraneElement element) {
  switch (element) {
    case MembraneElement::segment:
      return "segment";
    case MembraneElement::triangle:
      return "triangle";
    case MembraneElement::node:
      return "node";
    case MembraneElement::cell:
      return "cell";
  }
  return "unknown";
}

const std::vector<std::string>& inputs_of(ModelKind kind, int dimension) {
  static const std::vector<std::string> collision = {"populations", "force", "relaxation_rate"};
  static const std::vector<std::string> membrane[2] = {
      {"stretch", "stretch_rate", "curvature", "rest_curvature", "area", "rest_area", "perimeter", "rest_perimeter"},
      {"curvature", "rest_curvature", "invariant_1", "invariant_2", "area_ratio", "volume", "rest_volume",
       "surface_area", "rest_surface_area"}};
  static const std::vector<std::string> pair = {"distance", "normal_velocity", "tangential_velocity", "sliding_speed"};
  if (kind == ModelKind::membrane) return membrane[dimension - 2];
  return kind == ModelKind::collision ? collision : pair;
}

const std::vector<std::string>& outputs_of(ModelKind kind, int dimension) {
  static const std::vector<std::string> collision = {"populations", "velocity"};
  static const std::vector<std::string> membrane[2] = {
      {"tension", "moment", "pressure", "perimeter_tension", "energy", "tension_by_stretch", "tension_by_rate",
       "moment_by_curvature"},
      {"moment", "pressure", "energy", "moment_by_curvature", "stress_1", "stress_2", "area_tension", "surface_tension",
       "shear_viscosity", "area_viscosity", "stress_1_by_1", "stress_1_by_2", "stress_2_by_2",
       "area_tension_by_ratio"}};
  static const std::vector<std::string> pair = {"energy", "force", "force_by_distance"};
  if (kind == ModelKind::membrane) return membrane[dimension - 2];
  return kind == ModelKind::collision ? collision : pair;
}

std::optional<MembraneElement> element_of(const std::string& name) {
  static const std::map<MembraneElement, std::vector<std::string>> names = {
      {MembraneElement::segment, {"stretch", "stretch_rate", "tension", "tension_by_stretch", "tension_by_rate"}},
      {MembraneElement::triangle,
       {"invariant_1", "invariant_2", "stress_1", "stress_2", "shear_viscosity", "area_viscosity", "stress_1_by_1",
        "stress_1_by_2", "stress_2_by_2"}},
      {MembraneElement::node,
       {"curvature", "rest_curvature", "moment", "moment_by_curvature", "area_ratio", "area_tension",
        "area_tension_by_ratio"}},
      {MembraneElement::cell,
       {"area", "rest_area", "perimeter", "rest_perimeter", "pressure", "perimeter_tension", "volume", "rest_volume",
        "surface_area", "rest_surface_area", "surface_tension"}}};
  for (const auto& [element, own] : names) {
    if (std::find(own.begin(), own.end(), name) != own.end()) return element;
  }
  return std::nullopt;
}

units::Dimension dimension_of(const Manifest& manifest, const std::string& name) {
  return quantity_of(manifest, name).dimension;
}

std::string unit_of(const Manifest& manifest, const std::string& name) { return quantity_of(manifest, name).unit; }

}  // namespace rouleau::plugin
