#include "synonyms.hpp"

#include <algorithm>

#include "text.hpp"

namespace rouleau {

namespace {

constexpr Synonym table[] = {
    // fluid
    {"rho", "density"},
    {"mu", "viscosity"},
    {"eta", "viscosity"},
    {"dynamic_viscosity", "viscosity"},
    {"acceleration", "gravity"},
    {"g", "gravity"},
    {"force", "body_force"},
    {"convection", "inertia"},
    {"operator", "collision"},
    // domain
    {"box", "domain"},
    {"geometry", "domain"},
    {"channel", "domain"},
    {"box", "size"},
    {"length", "size"},
    {"lengths", "size"},
    {"dimensions", "size"},
    {"extent", "size"},
    {"resolution", "nodes"},
    {"grid", "nodes"},
    {"lattice", "nodes"},
    // numerics
    {"omega", "tau"},
    {"relaxation", "tau"},
    {"relaxation_time", "tau"},
    {"relaxation_rate", "tau"},
    {"dt", "tau"},
    {"time_step", "tau"},
    {"delta", "kernel"},
    {"delta_function", "kernel"},
    {"interpolation", "kernel"},
    {"solver", "numerics"},
    {"double", "f64"},
    {"float64", "f64"},
    {"float", "f32"},
    {"float32", "f32"},
    {"single", "f32"},
    // cells
    {"particles", "cells"},
    {"species", "cell_types"},
    {"types", "cell_types"},
    {"sphere", "circle"},
    {"disc", "circle"},
    {"disk", "circle"},
    {"capsule", "circle"},
    {"discocyte", "biconcave"},
    {"rbc", "biconcave"},
    {"red_cell", "biconcave"},
    {"ellipsoid", "ellipse"},
    {"axes", "semi_axes"},
    {"viscosity", "interior_viscosity"},
    {"inner_viscosity", "interior_viscosity"},
    {"internal_viscosity", "interior_viscosity"},
    {"viscosity_ratio", "interior_viscosity"},
    {"viscosity_contrast", "interior_viscosity"},
    {"inner_density", "interior_density"},
    {"internal_density", "interior_density"},
    {"density", "interior_density"},
    {"vertices", "segments"},
    {"nodes", "segments"},
    {"points", "segments"},
    {"laws", "membrane"},
    {"position", "at"},
    {"center", "at"},
    {"orientation", "angle"},
    {"rotation", "angle"},
    {"theta", "angle"},
    {"distance", "spacing"},
    {"pitch", "spacing"},
    {"number", "count"},
    {"haematocrit", "hematocrit"},
    {"volume_fraction", "hematocrit"},
    {"area_fraction", "hematocrit"},
    // interactions
    {"potentials", "interactions"},
    {"adhesion", "interactions"},
    {"pair", "between"},
    // stages
    {"phases", "stages"},
    {"shear", "shear_rate"},
    {"gamma", "shear_rate"},
    {"gamma_dot", "shear_rate"},
    {"pressure", "pressure_gradient"},
    {"pressure_drop", "pressure_gradient"},
    {"pressure_difference", "pressure_gradient"},
    {"time", "duration"},
    {"end_time", "duration"},
    {"force", "forces"},
    {"pull", "forces"},
    {"tweezers", "forces"},
    {"direction", "toward"},
    {"fraction", "share"},
};

}  // namespace

std::span<const Synonym> synonyms() { return table; }

std::string synonym(std::string_view word, const std::vector<std::string>& candidates) {
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  for (const Synonym& known : table) {
    if (known.word != lower) continue;
    const auto found = std::find(candidates.begin(), candidates.end(), known.ours);
    if (found != candidates.end() && *found != word) return *found;
  }
  return {};
}

std::string likely(std::string_view word, const std::vector<std::string>& candidates) {
  auto meant = synonym(word, candidates);
  return meant.empty() ? nearest(word, candidates) : meant;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const auto near = likely(word, candidates);
  return near.empty() || near == word ? "" : "; did you mean " + in_quotes(near) + "?";
}

}  // namespace rouleau
