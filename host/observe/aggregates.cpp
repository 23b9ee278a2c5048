#include "aggregates.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/contact/cell_grid.hpp"
#include "core/contact/surface_patches.hpp"
#include "core/contact/triangle_contacts.hpp"
#include "core/membrane/geometry.hpp"

namespace rouleau::observe {

namespace {

/// Calls visit(a, cells) for this rank's cells for which wanted(a) holds, with the cells it knows that may come within
/// `reach` of it, both in ascending order: what is found must not depend on the grid.
template <class Wanted, class Visit>
void for_each_near(const core::Membranes& m, const std::vector<core::BoundingBox<2>>& boxes, double reach,
                   const core::Domain<2>& domain, Wanted wanted, Visit visit) {
  const core::CellGrid<2> grid(boxes, reach, domain);
  std::vector<int> near;
  for (const int cell : m.own_cells()) {
    if (!wanted(cell)) continue;
    grid.find(cell, near);
    std::sort(near.begin(), near.end());
    visit(cell, near);
  }
}

/// Which gaps of own cells have not been found.
std::vector<char> open_ones(const core::CellNodes& cells, const std::vector<double>& gaps) {
  std::vector<char> open(gaps.size(), 0);
  for (const int c : cells.own_cells()) open[c] = std::isinf(gaps[c]) ? 1 : 0;
  return open;
}

}  // namespace

std::vector<CellContact> find_touching_cells(const core::Membranes& m, const core::Domain<2>& domain, double reach) {
  std::vector<CellContact> contacts;
  const std::vector<core::BoundingBox<2>> boxes = core::boxes_of_known<2>(m);
  const auto each = [](int) { return true; };
  for_each_near(m, boxes, reach, domain, each, [&](int a, const std::vector<int>& near) {
    for (const int b : near) {
      if (b < a) continue;
      const core::CellRange &cell = m.cells[a], &other = m.cells[b];
      core::for_each_image(boxes[a], boxes[b], reach, domain, [&](core::ImageShift shift) {
        // A cell and its own image are one contact, seen from both sides.
        if (a == b && (shift.y < 0 || (shift.y == 0 && shift.x <= 0))) return;
        const double gap = core::outline_distance(m, cell, other, shift, domain, reach);
        if (gap < reach) {
          contacts.push_back({a, b, shift, gap, core::facing_length(m, cell, other, shift, domain, reach)});
        }
      });
    }
  });
  return contacts;
}

std::vector<CellContact> find_touching_cells(const core::Surfaces& s, const core::Domain<3>& domain, double reach) {
  const core::TriangleContacts all = core::TriangleContacts::within(reach, s, domain);
  std::vector<core::TriangleContact> of_cell;
  std::map<std::tuple<int, int, core::ImageShift>, CellContact> found;
  for (const int cell : s.known_cells()) {
    all.find(cell, s, of_cell);
    for (const core::TriangleContact& contact : of_cell) {
      // A pair is known by its first cell and the image of the second; a cell and its own image are seen from both
      // sides.
      const bool turned = contact.other < cell || (contact.other == cell && contact.shift < core::ImageShift{});
      const core::ImageShift image = turned ? -contact.shift : contact.shift;
      const int a = turned ? contact.other : cell, b = turned ? cell : contact.other;
      CellContact& pair = found.try_emplace({a, b, image}, CellContact{a, b, image, reach, 0}).first->second;
      pair.gap = std::min(pair.gap, contact.distance);
      if (!turned) pair.contact_length += s.type_of(cell).node_area[contact.node - s.cells[cell].first];
    }
  }
  std::vector<CellContact> contacts;
  for (const auto& [key, contact] : found) {
    if (contact.gap < reach && s.owns(contact.cell_a)) contacts.push_back(contact);
  }
  return contacts;
}

std::vector<double> smallest_gaps(core::Surroundings<3>& around, const core::Domain<3>& domain) {
  const core::Surfaces& s = around.cells();
  double most = domain.size[0] + domain.size[1] + domain.size[2];
  for (int k = 0; k < 3; ++k) {
    if (domain.periodic[k]) most = std::min(most, domain.period(k) / 2);
  }
  if (std::isinf(most)) most = domain.size[0] + domain.size[1] + domain.size[2];  // from corner to corner, and more
  std::vector<double> gaps(s.cells.size(), std::numeric_limits<double>::infinity());
  std::vector<int> near;
  std::vector<char> open = open_ones(s, gaps);
  for (double reach = std::min(4.0, most); around.show(reach, open); reach = std::min(2 * reach, most)) {
    core::SurfacePatches patches(s, domain);
    const core::CellGrid<3> grid(around.boxes(), reach, domain);
    for (const int cell : s.own_cells()) {
      if (open[cell] == 0 || !around.boxes()[cell].usable()) continue;
      grid.find(cell, near);
      gaps[cell] = patches.gap(cell, near, around.boxes(), reach);
    }
    if (reach == most) break;
    open = open_ones(s, gaps);
  }
  return gaps;
}

std::vector<double> smallest_gaps(core::Surroundings<2>& around, const core::Domain<2>& domain) {
  const core::Membranes& m = around.cells();
  std::vector<double> gaps(m.cells.size(), std::numeric_limits<double>::infinity());
  double first = 1;  // about the size of a cell, and not much of the box
  for (const core::BoundingBox<2>& box : around.boxes())
    if (box.usable()) first = std::max({first, box.most[0] - box.least[0], box.most[1] - box.least[1]});
  const double length = domain.size[0], most = 2 * std::max(length, domain.period(1));
  double reach = std::min(first, length / 16);
  for (std::vector<char> open = open_ones(m, gaps); reach < most && around.show(reach, open); reach *= 2) {
    const auto is_open = [&](int cell) { return open[cell] != 0; };
    const std::vector<core::BoundingBox<2>> boxes = core::boxes_of_known<2>(m);
    for_each_near(m, boxes, reach, domain, is_open, [&](int a, const std::vector<int>& near) {
      double& gap = gaps[a];
      for (const int b : near) gap = std::min(gap, core::smallest_gap(m, a, b, domain, std::min(gap, reach)));
    });
    open = open_ones(m, gaps);
  }
  return gaps;
}

std::size_t place_of(int number, const std::vector<int>& ascending) {
  const auto guess = static_cast<std::size_t>(number);  // right where all are there
  if (guess < ascending.size() && ascending[guess] == number) return guess;
  return static_cast<std::size_t>(std::lower_bound(ascending.begin(), ascending.end(), number) - ascending.begin());
}

Aggregates find_aggregates(int cells, const std::vector<CellContact>& contacts) {
  std::vector<int> all(static_cast<std::size_t>(cells));
  std::iota(all.begin(), all.end(), 0);
  return find_aggregates(std::move(all), contacts);
}

Aggregates find_aggregates(std::vector<int> cells, const std::vector<CellContact>& contacts) {
  Aggregates result;
  result.label = cells;
  // Labels only ever fall, so repeating until nothing changes ends with the smallest number of each component.
  for (bool changed = true; changed;) {
    changed = false;
    for (const CellContact& c : contacts) {
      int &a = result.label[place_of(c.cell_a, cells)], &b = result.label[place_of(c.cell_b, cells)];
      if (a == b) continue;
      a = b = std::min(a, b);
      changed = true;
    }
  }
  std::vector<bool> crossed(cells.size(), false);
  for (const CellContact& c : contacts) {
    if (!(c.image == core::ImageShift{})) crossed[place_of(result.label[place_of(c.cell_a, cells)], cells)] = true;
  }
  result.through_image.resize(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    result.through_image[i] = crossed[place_of(result.label[i], cells)];
    if (result.label[i] == cells[i]) ++result.count;
  }
  result.cells = std::move(cells);
  return result;
}

std::string aggregates_in_words(std::vector<std::size_t> sizes) {
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  const auto single = std::find_if(sizes.begin(), sizes.end(), [](std::size_t size) { return size < 2; });
  const auto rouleaux = static_cast<std::size_t>(single - sizes.begin()), singles = sizes.size() - rouleaux;
  std::string alone = std::to_string(singles) + (singles == 1 ? " single cell" : " single cells");
  if (rouleaux == 0) return alone;
  const auto size = [&](std::size_t rouleau) { return std::to_string(sizes[rouleau]); };
  std::string words = rouleaux == 1 ? "a rouleau of " + size(0) : "rouleaux of " + size(0);
  if (rouleaux > 4) {
    words = std::to_string(rouleaux) + " rouleaux of " + size(rouleaux - 1) + " to " + size(0);
  } else {
    for (std::size_t i = 1; i < rouleaux; ++i) words += (i + 1 == rouleaux ? " and " : ", ") + size(i);
  }
  words += " cells";
  return singles > 0 ? words + " and " + alone : words;
}

}  // namespace rouleau::observe
