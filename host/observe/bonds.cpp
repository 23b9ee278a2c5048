#include "bonds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "rheology.hpp"

namespace rouleau::observe {

namespace {

void count_sizes(const Aggregates& aggregates, std::map<int, int>& sizes, double& by_number, double& by_weight) {
  sizes = aggregate_sizes(aggregates.label);
  by_number = number_mean(sizes), by_weight = weight_mean(sizes);
}

/// What contacts there are, of whichever rank's cells.
template <int D>
ContactSnapshot in_si(const CellContact& c, double length) {
  constexpr std::array of{&ContactSnapshot::contact_length, &ContactSnapshot::contact_area};
  ContactSnapshot s{c.cell_a, c.cell_b, {c.image.x, c.image.y, c.image.z}, c.gap * length};
  double measure = c.contact_length;
  for (int k = 1; k < D; ++k) measure *= length;
  s.*of[D - 2] = measure;
  return s;
}

}  // namespace

template <int D>
void describe_contacts(const std::vector<CellContact>& contacts, const Aggregates& aggregates, double length,
                       Snapshot& snapshot) {
  snapshot.aggregate_count = aggregates.count;
  count_sizes(aggregates, snapshot.aggregate_sizes, snapshot.aggregate_size_number_mean,
              snapshot.aggregate_size_weight_mean);
  const auto count = static_cast<double>(contacts.size());
  snapshot.contacts_per_cell = 2 * count / static_cast<double>(aggregates.cells.size());
  if (!contacts.empty()) snapshot.contact_gap = 0;
  for (const CellContact& contact : contacts) {
    snapshot.contacts.push_back(in_si<D>(contact, length));
    snapshot.contact_gap += contact.gap * length / count;
  }
}

template void describe_contacts<2>(const std::vector<CellContact>&, const Aggregates&, double, Snapshot&);
template void describe_contacts<3>(const std::vector<CellContact>&, const Aggregates&, double, Snapshot&);

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
  count_sizes(joined, snapshot.bonded_sizes, snapshot.bonded_size_number_mean, snapshot.bonded_size_weight_mean);
}

template <int D>
void observe_interactions(core::AnySolver<D>& solver, const scene::Scene& scene, const scene::Attractions& attracting,
                          const units::LatticeUnits& units, Snapshot& snapshot) {
  auto& tasks = *solver.cell_tasks();
  // In layers a cell's share in the stress is not a matter of its membrane alone.
  snapshot.particle_stress = std::nan("");
  if (scene.fluid.layers.empty()) {
    const ParticleStress stress = particle_stress(solver.cells(), scene, solver.setup().viscosity(), solver.ranks(),
                                                  [&](int c) { return tasks.force_across_images(c); });
    snapshot.particle_stress = units.to_si(stress.xy, units::dimension::pressure);
    snapshot.first_normal_stress = units.to_si(stress.first, units::dimension::pressure);
    snapshot.second_normal_stress = units.to_si(stress.second, units::dimension::pressure);
  }
  if (attracting.empty()) return;
  const auto halves = core::to_first(solver.ranks(), tasks.pair_energies());
  const double joule = units.to_si(1, units::dimension::energy_per_depth) * std::pow(units.length, D - 2);
  if (solver.ranks().first()) find_bonds(snapshot, halves, attracting, scene.output.bond_share, joule);
}

template void observe_interactions(core::AnySolver<2>&, const scene::Scene&, const scene::Attractions&,
                                   const units::LatticeUnits&, Snapshot&);
template void observe_interactions(core::AnySolver<3>&, const scene::Scene&, const scene::Attractions&,
                                   const units::LatticeUnits&, Snapshot&);

}  // namespace rouleau::observe
