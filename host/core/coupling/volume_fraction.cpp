#include <algorithm>
#include <cmath>

#include "cell_fraction.hpp"
#include "core/membrane/rounding.hpp"
#include "core/surface/line_crossing.hpp"

namespace rouleau::core {

void cover(const Surfaces& surfaces, int cell, CellFraction<3>& fraction) {
  if (!clear_around(box_of<3>(surfaces, cell), fraction)) return;
  const Nodes nodes = surfaces.nodes(cell);
  // Lines lie a quarter and three quarters into a cube, line number n at first + n/2 - 1/4. Where one leaves the
  // surface at x, all nodes to the left gain what lies between them and x; where it enters, they lose it. What a whole
  // node gains is noted at the place of the crossing alone, and summed from right to left.
  for (const auto& corner : surfaces.type_of(cell).mesh.triangles()) {
    const Vec<3> a = nodes[corner[0]], b = nodes[corner[1]], c = nodes[corner[2]];
    const auto line_from = [&](int axis, double place) {
      return -floor_int(-(2 * (place - fraction.first[axis]) + 0.5));
    };
    const auto line_to = [&](int axis, double place) { return floor_int(2 * (place - fraction.first[axis]) + 0.5); };
    const LinesThroughTriangle triangle(a, b, c);
    const int y_end = line_to(1, std::max({a.y(), b.y(), c.y()})), z_end = line_to(2, std::max({a.z(), b.z(), c.z()}));
    const int y_begin = line_from(1, std::min({a.y(), b.y(), c.y()}));
    for (int m = line_from(2, std::min({a.z(), b.z(), c.z()})); m <= z_end; ++m) {
      for (int n = y_begin; n <= y_end; ++n) {
        const auto crossing =
            triangle.crossing({fraction.first[1] + 0.5 * n - 0.25, fraction.first[2] + 0.5 * m - 0.25});
        if (!crossing) continue;
        const double x = crossing->x, gain = crossing->leaves ? 0.25 : -0.25;
        const int r = m / 2 * fraction.size[1] + n / 2;
        double* row = fraction.row(r);
        const int node = std::clamp(floor_int(x + 0.5) - fraction.first[0], 1, fraction.size[0] - 1);
        const double part = x + 0.5 - (fraction.first[0] + node);
        row[node] += gain * part;
        row[node - 1] += gain * (1 - part);  // with what the sum from the right brings it has a whole one
        fraction.begin[r] = std::min(fraction.begin[r], node - 1);
        fraction.end[r] = std::max(fraction.end[r], node + 1);
      }
    }
  }
  for (int r = 0; r < fraction.row_count(); ++r) {
    double* row = fraction.row(r);
    int &begin = fraction.begin[r], &end = fraction.end[r];
    end = std::max(begin, end);
    for (int i = end - 2; i >= begin; --i) row[i] += row[i + 1];
    for (int i = begin; i < end; ++i)
      if (std::abs(row[i]) < 1e-12) row[i] = 0;  // what enters and leaves cancels up to rounding
    while (begin < end && row[begin] == 0) ++begin;
    while (end > begin && row[end - 1] == 0) --end;
  }
}

}  // namespace rouleau::core
