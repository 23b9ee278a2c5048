#include "aggregates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "core/contact/cell_grid.hpp"
#include "core/contact/surface_contacts.hpp"
#include "core/membrane/geometry.hpp"

namespace rouleau::observe {

namespace {

std::vector<core::Bounds> all_bounds(const core::Membranes& m) {
  std::vector<core::Bounds> boxes;
  for (const core::CellRange& cell : m.cells) boxes.push_back(core::bounds(m, cell));
  return boxes;
}

/// Calls visit(a, cells) for each of `cells` with those that may come within `reach` of it, in ascending order: what is
/// found must not depend on the grid.
template <class Visit>
void for_each_near(const std::vector<core::Bounds>& boxes, const std::vector<int>& cells, double reach,
                   const core::Domain<2>& domain, Visit visit) {
  const core::CellGrid<2> grid(core::boxes_of(boxes), reach, domain);
  std::vector<int> near;
  for (const int cell : cells) {
    grid.find(cell, near);
    std::sort(near.begin(), near.end());
    visit(cell, near);
  }
}

std::vector<int> numbered(std::size_t cells) {
  std::vector<int> numbers(cells);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

std::vector<CellContact> find_touching_cells(const core::Membranes& m, const core::Domain<2>& domain, double reach) {
  std::vector<CellContact> contacts;
  const std::vector<core::Bounds> boxes = all_bounds(m);
  for_each_near(boxes, numbered(boxes.size()), reach, domain, [&](int a, const std::vector<int>& near) {
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
  const core::SurfaceContacts all = core::SurfaceContacts::within(reach, s, domain);
  std::vector<core::SurfaceContact> of_cell;
  std::map<std::tuple<int, int, core::ImageShift>, CellContact> found;
  for (int cell = 0; cell < s.cell_count(); ++cell) {
    all.find(cell, s, of_cell);
    for (const core::SurfaceContact& contact : of_cell) {
      // A pair is known by its first cell and the image of the second; a cell and its own image are seen from both sides.
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
    if (contact.gap < reach) contacts.push_back(contact);
  }
  return contacts;
}

std::vector<double> smallest_gaps(const core::Surfaces& s, const core::Domain<3>& domain) {
  double most = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (domain.periodic[k]) most = std::min(most, domain.period(k) / 2);
  }
  std::vector<double> gaps(s.cells.size(), std::numeric_limits<double>::infinity());
  std::vector<core::SurfaceContact> of_cell;
  for (double reach = std::min(4.0, most);; reach = std::min(2 * reach, most)) {
    const core::SurfaceContacts all = core::SurfaceContacts::within(reach, s, domain);
    for (int cell = 0; cell < s.cell_count(); ++cell) {
      all.find(cell, s, of_cell);
      for (const core::SurfaceContact& contact : of_cell) {  // which both cells feel
        gaps[cell] = std::min(gaps[cell], contact.distance);
        gaps[contact.other] = std::min(gaps[contact.other], contact.distance);
      }
    }
    const bool open = std::any_of(gaps.begin(), gaps.end(), [](double gap) { return std::isinf(gap); });
    if (!open || reach == most) break;
  }
  return gaps;
}

std::vector<double> smallest_gaps(const core::Membranes& m, const core::Domain<2>& domain) {
  std::vector<double> gaps(m.cells.size(), std::numeric_limits<double>::infinity());
  const std::vector<core::Bounds> boxes = all_bounds(m);
  std::vector<int> open = numbered(boxes.size());
  double first = 1;  // about the size of a cell, and not much of the box
  for (const core::Bounds& b : boxes)
    if (b.usable()) first = std::max({first, b.x_max - b.x_min, b.y_max - b.y_min});
  const double most = 2 * std::max(domain.period(0), domain.period(1));
  for (double reach = std::min(first, domain.period(0) / 16); reach < most && !open.empty(); reach *= 2) {
    for_each_near(boxes, open, reach, domain, [&](int a, const std::vector<int>& near) {
      double& gap = gaps[a];
      for (const int b : near) gap = std::min(gap, core::smallest_gap(m, a, b, domain, std::min(gap, reach)));
    });
    std::erase_if(open, [&](int a) { return std::isfinite(gaps[a]); });
  }
  return gaps;
}

double wall_gap(const core::Membranes& m, const core::CellRange& cell, const core::Domain<2>& domain) {
  if (!domain.walled(1)) return std::nan("");
  const core::Bounds box = core::bounds(m, cell);
  return std::min(box.y_min + 0.5, domain.size[1] - 0.5 - box.y_max);
}

Aggregates find_aggregates(int cells, const std::vector<CellContact>& contacts) {
  Aggregates result;
  result.label.resize(static_cast<std::size_t>(cells));
  std::iota(result.label.begin(), result.label.end(), 0);
  // Labels only ever fall, so repeating until nothing changes ends with the smallest index of each component.
  for (bool changed = true; changed;) {
    changed = false;
    for (const CellContact& c : contacts) {
      int &a = result.label[c.cell_a], &b = result.label[c.cell_b];
      if (a == b) continue;
      a = b = std::min(a, b);
      changed = true;
    }
  }
  std::vector<bool> crossed(static_cast<std::size_t>(cells), false);
  for (const CellContact& c : contacts) {
    if (!(c.image == core::ImageShift{})) crossed[result.label[c.cell_a]] = true;
  }
  result.through_image.resize(static_cast<std::size_t>(cells));
  for (int i = 0; i < cells; ++i) {
    const auto label = static_cast<std::size_t>(result.label[i]);
    result.through_image[i] = crossed[label];
    if (result.label[i] == i) ++result.count;
  }
  return result;
}

}  // namespace rouleau::observe
