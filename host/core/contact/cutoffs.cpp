#include "cutoffs.hpp"

#include <algorithm>
#include <stdexcept>

namespace rouleau::core {

namespace {

constexpr double thinnest_skin = 0.01, thickest_skin = 0.5, usual_skin = 0.2;
constexpr double lifetime = 120;  // steps that lists should last

}  // namespace

double suitable_skin(const CellNodes& cells) {
  if (cells.largest_step.empty()) return usual_skin;  // nobody keeps account of the steps
  double skin = thinnest_skin;                        // also where a step is no number: the run's own checks will tell
  for (const int c : cells.known_cells()) skin = std::max(skin, lifetime * cells.largest_step[c]);
  return std::min(std::max(skin, lifetime * cells.largest_step_of_others), thickest_skin);
}

void Cutoffs::raise(int a, int b, double cutoff) {
  const double value = std::max((*this)(a, b), cutoff);
  cutoff_[static_cast<std::size_t>(a) * types_ + b] = value;
  cutoff_[static_cast<std::size_t>(b) * types_ + a] = value;
}

double Cutoffs::largest() const { return *std::max_element(cutoff_.begin(), cutoff_.end()); }

double contact_reach(const std::vector<Interaction>& interactions) {
  double largest = -1;
  for (const Interaction& interaction : interactions) largest = std::max(largest, cutoff_of(interaction.potential));
  return interactions.empty() ? 0 : largest + 2 * thickest_skin;
}

Cutoffs pair_cutoffs(const CellNodes& cells, const std::vector<Interaction>& interactions) {
  int types = 1;
  for (const CellRange& cell : cells.cells) types = std::max(types, cell.type + 1);
  for (const Interaction& interaction : interactions)
    types = std::max({types, interaction.between[0] + 1, interaction.between[1] + 1});
  Cutoffs cutoffs(types);
  for (const Interaction& i : interactions) cutoffs.raise(i.between[0], i.between[1], cutoff_of(i.potential));
  return cutoffs;
}

std::vector<double> self_cutoffs(std::size_t types, const std::vector<SelfInteraction>& within_cells) {
  std::vector<double> cutoffs(within_cells.empty() ? 0 : types, 0.0);
  for (const auto& [type, potential, strength] : within_cells) {
    if (!potential.state.empty() || potential.reads("normal_velocity") || reads_sliding(potential))
      throw std::invalid_argument("a potential within a membrane depends on the distance alone: " + potential.id);
    cutoffs[type] = std::max(cutoffs[type], cutoff_of(potential));
  }
  return cutoffs;
}

}  // namespace rouleau::core
