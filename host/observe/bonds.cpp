#include "bonds.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "aggregates.hpp"
#include "rheology.hpp"

namespace rouleau::observe {

void find_bonds(Snapshot& snapshot, const std::vector<core::PairEnergy>& halves, const scene::Attractions& attracting,
                double least, double unit) {
  std::vector<int> there;
  for (const CellSnapshot& cell : snapshot.cells) there.push_back(cell.cell);
  const auto cell_at = [&](int cell) -> const CellSnapshot& { return snapshot.cells[place_of(cell, there)]; };
  // What a face of the smaller one would win; negative: nothing attracts these. NaN: not known.
  const auto most = [&](int a, int b) {
    const CellSnapshot &one = cell_at(a), &other = cell_at(b);
    const auto found = attracting.find({std::min(one.type, other.type), std::max(one.type, other.type)});
    if (a == b || found == attracting.end()) return -1.0;
    return found->second / 2 *
           std::min(one.perimeter.value_or(one.surface_area), other.perimeter.value_or(other.surface_area));
  };
  using Key = std::tuple<int, int, std::array<int, 3>>;
  std::map<Key, double> energies;  // a pair has two halves, whose sum does not depend on their order
  for (const core::PairEnergy& half : halves) {
    const bool turned = half.other < half.cell;
    const core::ImageShift image = turned ? -half.shift : half.shift;
    energies[{std::min(half.cell, half.other), std::max(half.cell, half.other), {image.x, image.y, image.z}}] +=
        half.energy * unit;
  }
  for (ContactSnapshot& contact : snapshot.contacts) {
    const auto found = energies.find({contact.cell_a, contact.cell_b, contact.image});
    const double energy = found == energies.end() ? 0 : found->second, face = most(contact.cell_a, contact.cell_b);
    if (face > 0) contact.bond_share = -energy / face;
    if (std::isnan(face)) snapshot.bonds.push_back(contact);
  }
  for (const auto& [key, energy] : energies) {
    const auto& [a, b, image] = key;
    const double face = most(a, b);
    if (face > 0 && -energy >= least * face) snapshot.bonds.push_back({a, b, image, std::nan("")});
  }
  std::vector<CellContact> pairs;
  for (const ContactSnapshot& bond : snapshot.bonds) pairs.push_back({bond.cell_a, bond.cell_b, {}, 0, 0});
  const Aggregates joined = find_aggregates(std::move(there), pairs);
  for (std::size_t k = 0; k < joined.label.size(); ++k) snapshot.cells[k].bonded = joined.label[k];
  snapshot.attracts = true;
  snapshot.bonded_sizes = aggregate_sizes(joined.label);
  snapshot.bonded_size_number_mean = number_mean(snapshot.bonded_sizes);
  snapshot.bonded_size_weight_mean = weight_mean(snapshot.bonded_sizes);
}

}  // namespace rouleau::observe
