#include "synonyms.hpp"

#include <algorithm>

#include "text.hpp"

namespace rouleau {

namespace {

struct Meaning {
  std::string_view ours, words;  // words: parted by spaces
};
constexpr Meaning table[] = {
    // fluid
    {"density", "rho"},
    {"viscosity", "mu eta dynamic_viscosity"},
    {"gravity", "acceleration g"},
    {"body_force", "force"},
    {"inertia", "convection"},
    {"collision", "operator"},
    // domain
    {"domain", "box geometry channel"},
    {"size", "box length lengths dimensions extent"},
    {"nodes", "resolution grid lattice"},
    // numerics
    {"tau", "omega relaxation relaxation_time relaxation_rate dt time_step"},
    {"kernel", "delta delta_function interpolation"},
    {"numerics", "solver"},
    {"f64", "double float64"},
    {"f32", "float float32 single"},
    // cells
    {"cells", "particles"},
    {"cell_types", "species types"},
    {"circle", "sphere disc disk capsule"},
    {"biconcave", "discocyte rbc red_cell"},
    {"ellipse", "ellipsoid"},
    {"semi_axes", "axes"},
    {"interior_viscosity", "viscosity inner_viscosity internal_viscosity viscosity_ratio viscosity_contrast"},
    {"interior_density", "inner_density internal_density density"},
    {"segments", "vertices nodes points"},
    {"membrane", "laws"},
    {"at", "position center"},
    {"angle", "orientation rotation theta"},
    {"spacing", "distance pitch"},
    {"count", "number"},
    {"hematocrit", "haematocrit volume_fraction area_fraction"},
    // interactions
    {"interactions", "potentials adhesion"},
    {"between", "pair"},
    // stages
    {"stages", "phases"},
    {"shear_rate", "shear gamma gamma_dot"},
    {"pressure_gradient", "pressure pressure_drop pressure_difference"},
    {"duration", "time end_time"},
    {"forces", "force pull tweezers"},
    {"toward", "direction"},
    {"share", "fraction"},
};

}  // namespace

const std::vector<Synonym>& synonyms() {
  static const std::vector<Synonym> all = [] {
    std::vector<Synonym> found;
    for (auto [ours, words] : table) {
      while (!words.empty()) {
        const std::size_t length = std::min(words.find(' '), words.size());
        found.push_back({words.substr(0, length), ours});
        words.remove_prefix(std::min(length + 1, words.size()));
      }
    }
    return found;
  }();
  return all;
}

std::string synonym(std::string_view word, const std::vector<std::string>& candidates) {
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  for (const Synonym& known : synonyms()) {
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
