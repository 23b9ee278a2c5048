#include "quantities.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace rouleau::plugin {

const char* to_string(MembraneElement element) {
  constexpr std::array words{"segment", "triangle", "node", "cell"};
  return words.at(static_cast<std::size_t>(element));
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
  for (const auto& [element, own] : names)
    if (std::find(own.begin(), own.end(), name) != own.end()) return element;
  return std::nullopt;
}

std::string unit_of(const Manifest& manifest, const std::string& name) {
  // Lengths of the two-dimensional world are metres; what is per unit depth there is so in SI, too. Stresses, energies
  // per length there and per area in three dimensions have the same unit then.
  static const std::map<std::string, std::vector<std::string>> names = {
      {"1/s", {"stretch_rate"}},
      {"1/m", {"curvature", "rest_curvature"}},
      {"m", {"perimeter", "rest_perimeter", "distance"}},
      {"m2", {"area", "rest_area", "surface_area", "rest_surface_area"}},
      {"m3", {"volume", "rest_volume"}},
      {"m/s", {"normal_velocity", "tangential_velocity", "sliding_speed"}},
      {"N/m",
       {"tension", "perimeter_tension", "stress_1", "stress_2", "area_tension", "surface_tension", "tension_by_stretch",
        "stress_1_by_1", "stress_1_by_2", "stress_2_by_2", "area_tension_by_ratio"}},
      {"N s/m", {"shear_viscosity", "area_viscosity", "tension_by_rate"}},
      {"N", {"moment"}},
      {"J", {"moment_by_curvature"}},
      {"J/m2", {"energy"}},
      {"Pa", {"pressure", "force"}},
      {"Pa/m", {"force_by_distance"}}};
  if (manifest.kind == ModelKind::collision) return "";
  const bool of_cell = manifest.gives_output("pressure") || manifest.gives_output("perimeter_tension") ||
                       manifest.gives_output("surface_tension");
  if (name == "energy" && of_cell) return manifest.dimension() == 2 ? "J/m" : "J";
  for (const auto& [unit, own] : names)
    if (std::find(own.begin(), own.end(), name) != own.end()) return unit;
  return "";
}

units::Dimension dimension_of(const Manifest& manifest, const std::string& name) {
  static const units::Units units;
  const std::string unit = unit_of(manifest, name);
  return units.dimension(unit.empty() ? "1" : unit);
}

}  // namespace rouleau::plugin
