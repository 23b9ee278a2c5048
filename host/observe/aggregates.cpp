#include "aggregates.hpp"

#include <algorithm>
#include <numeric>

#include "core/membrane/geometry.hpp"

namespace rouleau::observe {

std::vector<CellContact> find_contacts(const core::Membranes& m, const core::PeriodicBox& box, double reach) {
  std::vector<CellContact> contacts;
  const int cells = static_cast<int>(m.cells.size());
  std::vector<core::Bounds> boxes;
  for (const core::CellRange& cell : m.cells) boxes.push_back(core::bounds(m, cell));
  for (int a = 0; a < cells; ++a) {
    for (int b = a; b < cells; ++b) {
      const core::CellRange &cell = m.cells[static_cast<std::size_t>(a)], &other = m.cells[static_cast<std::size_t>(b)];
      core::for_each_image(
          boxes[static_cast<std::size_t>(a)], boxes[static_cast<std::size_t>(b)], reach, box,
          [&](core::ImageShift shift) {
            // A cell and its own image are one contact, seen from both sides.
            if (a == b && (shift.y < 0 || (shift.y == 0 && shift.x <= 0))) return;
            const double gap = core::outline_distance(m, cell, other, shift, box, reach);
            if (gap < reach) {
              contacts.push_back({a, b, shift, gap, core::facing_length(m, cell, other, shift, box, reach)});
            }
          });
    }
  }
  return contacts;
}

Aggregates find_aggregates(int cells, const std::vector<CellContact>& contacts) {
  Aggregates result;
  result.label.resize(static_cast<std::size_t>(cells));
  std::iota(result.label.begin(), result.label.end(), 0);
  // Labels only ever fall, so repeating until nothing changes ends with the smallest index of each component.
  for (bool changed = true; changed;) {
    changed = false;
    for (const CellContact& c : contacts) {
      int &a = result.label[static_cast<std::size_t>(c.cell_a)], &b = result.label[static_cast<std::size_t>(c.cell_b)];
      if (a == b) continue;
      a = b = std::min(a, b);
      changed = true;
    }
  }
  std::vector<bool> crossed(static_cast<std::size_t>(cells), false);
  for (const CellContact& c : contacts) {
    if (!(c.image == core::ImageShift{}))
      crossed[static_cast<std::size_t>(result.label[static_cast<std::size_t>(c.cell_a)])] = true;
  }
  result.through_image.resize(static_cast<std::size_t>(cells));
  for (int i = 0; i < cells; ++i) {
    const auto label = static_cast<std::size_t>(result.label[static_cast<std::size_t>(i)]);
    result.through_image[static_cast<std::size_t>(i)] = crossed[label];
    if (result.label[static_cast<std::size_t>(i)] == i) ++result.count;
  }
  return result;
}

}  // namespace rouleau::observe
