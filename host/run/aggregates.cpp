#include "aggregates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cell/geometry.hpp"

namespace rouleau::host {

namespace {

/// Distance of a point from the polygon of a cell shifted by (sx, sy).
double distance_to(const Membranes& m, const CellRange& cell, double sx, double sy, double px, double py) {
  double least = std::numeric_limits<double>::infinity();
  for (int j = cell.first; j < cell.end(); ++j) {
    const auto a = static_cast<std::size_t>(j), b = static_cast<std::size_t>(cell.next(j));
    const double ax = m.x[a] + sx, ay = m.y[a] + sy, dx = m.x[b] - m.x[a], dy = m.y[b] - m.y[a];
    const double length2 = dx * dx + dy * dy;
    const double s = length2 > 0 ? std::clamp(((px - ax) * dx + (py - ay) * dy) / length2, 0.0, 1.0) : 0.0;
    const double rx = px - ax - s * dx, ry = py - ay - s * dy;
    least = std::min(least, rx * rx + ry * ry);
  }
  return std::sqrt(least);
}

}  // namespace

std::vector<CellContact> find_contacts(const Membranes& m, const PeriodicBox& box, double reach) {
  std::vector<CellContact> contacts;
  const int cells = static_cast<int>(m.cells.size());
  std::vector<Bounds> boxes;
  for (const CellRange& cell : m.cells) boxes.push_back(bounds(m, cell));

  const auto examine = [&](int a, int b, int kx, int ky) {
    const double sx = kx * box.nx, sy = ky * box.ny;
    const CellRange& ca = m.cells[static_cast<std::size_t>(a)];
    const CellRange& cb = m.cells[static_cast<std::size_t>(b)];
    const Bounds &pa = boxes[static_cast<std::size_t>(a)], &pb = boxes[static_cast<std::size_t>(b)];
    if (pb.y_min + sy - pa.y_max >= reach || pa.y_min - pb.y_max - sy >= reach) return;
    CellContact contact{a, b, {kx, ky}, std::numeric_limits<double>::infinity(), 0.0};
    for (int i = ca.first; i < ca.end(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double d = distance_to(m, cb, sx, sy, m.x[k], m.y[k]);
      contact.gap = std::min(contact.gap, d);
      if (d < reach) contact.contact_length += m.rest_weight[k];
    }
    for (int i = cb.first; i < cb.end(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      contact.gap = std::min(contact.gap, distance_to(m, ca, -sx, -sy, m.x[k], m.y[k]));
    }
    if (contact.gap < reach) contacts.push_back(contact);
  };

  for (int a = 0; a < cells; ++a) {
    for (int b = a; b < cells; ++b) {
      const Bounds &pa = boxes[static_cast<std::size_t>(a)], &pb = boxes[static_cast<std::size_t>(b)];
      // Images of b that can come within reach of a; unwrapped cells may be many boxes apart.
      const auto images = [&](double a0, double a1, double b0, double b1, double period) {
        if (period <= 0) return std::array<int, 2>{0, 0};
        return std::array<int, 2>{static_cast<int>(std::ceil((a0 - reach - b1) / period)),
                                  static_cast<int>(std::floor((a1 + reach - b0) / period))};
      };
      const auto ix = images(pa.x_min, pa.x_max, pb.x_min, pb.x_max, box.nx),
                 iy = images(pa.y_min, pa.y_max, pb.y_min, pb.y_max, box.ny);
      for (int ky = iy[0]; ky <= iy[1]; ++ky) {
        for (int kx = ix[0]; kx <= ix[1]; ++kx) {
          const bool own_image_seen = a == b && (ky < 0 || (ky == 0 && kx <= 0));
          if (!own_image_seen) examine(a, b, kx, ky);
        }
      }
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
    if (!(c.image == ImageShift{}))
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

}  // namespace rouleau::host
