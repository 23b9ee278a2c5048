#include "start_gaps.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "constants.hpp"
#include "core/contact/cell_grid.hpp"
#include "core/contact/surface_contacts.hpp"
#include "core/membrane/geometry.hpp"
#include "placed_cells.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"

namespace rouleau::plan {

namespace {

constexpr double reach = 2;  // spacings

double gap_between(const core::Membranes& cells, const core::Domain<2>& domain) {
  const core::CellGrid<2> grid(core::boxes_of<2>(cells), reach, domain);
  double gap = std::numeric_limits<double>::infinity();
  std::vector<int> near;
  for (int cell = 0; cell < cells.cell_count(); ++cell) {
    grid.find(cell, near);
    for (const int other : near) gap = std::min(gap, core::smallest_gap(cells, cell, other, domain, reach));
  }
  return gap;
}

double gap_between(const core::Surfaces& cells, const core::Domain<3>& domain) {
  const core::SurfaceContacts contacts = core::SurfaceContacts::within(reach, cells, domain);
  double gap = std::numeric_limits<double>::infinity();
  std::vector<core::SurfaceContact> of_cell;
  for (int cell = 0; cell < cells.cell_count(); ++cell) {
    contacts.find(cell, cells, of_cell);
    for (const core::SurfaceContact& contact : of_cell) gap = std::min(gap, contact.distance);
  }
  return gap;
}

template <int D>
void measure(const scene::Scene& scene, StartGaps& gaps) {
  const Cells<D> cells = make_known_cells<D>(scene, [](int) { return true; });
  const core::Domain<D> domain = scene::lattice_domain<D>(scene);
  gaps.cells = std::min(gaps.cells, gap_between(cells, domain));
  if constexpr (D == 3) {
    if (scene.domain.tube_radius) {
      const double radius = *scene.domain.tube_radius / scene::lattice_spacing(scene);
      for (int cell = 0; cell < cells.cell_count(); ++cell)
        gaps.tube = std::min(gaps.tube, radius - core::farthest_from_axis(cells, cell, domain));
      return;
    }
  }
  const auto& places = cells.position;
  for (int k = 1; k < D; ++k) {
    if (!domain.walled(k)) continue;
    const auto [least, most] = std::minmax_element(places[k].begin(), places[k].end());
    const double gap = std::min(*least + 0.5, domain.size[k] - 0.5 - *most);
    if (gap < reach) gaps.walls = std::min(gaps.walls, gap);
  }
}

}  // namespace

StartGaps start_gaps(const scene::Scene& scene) {
  constexpr std::size_t most = 20'000;
  StartGaps gaps;
  scene::Scene placed = scene;
  for (auto packing = scene.packings.rbegin(); packing != scene.packings.rend(); ++packing) {
    const auto first = placed.cells.begin() + packing->first;
    placed.cells.erase(first, first + packing->count);
    const double gap = packing->gap / scene::lattice_spacing(scene);
    if (scene.domain.tube_radius) gaps.tube = std::min(gaps.tube, gap);
    if (!(gap < least_gap_at_start)) continue;
    gaps.cells = std::min(gaps.cells, gap);
    if (scene::has_walls(scene.domain) && !scene.domain.tube_radius) gaps.walls = std::min(gaps.walls, gap);
  }
  if (placed.cells.empty() || placed.cells.size() > most) return gaps;
  scene.domain.dimension() == 3 ? measure<3>(placed, gaps) : measure<2>(placed, gaps);
  return gaps;
}

}  // namespace rouleau::plan
