#include "volume_fraction.hpp"

#include <algorithm>
#include <cmath>

#include "core/membrane/rounding.hpp"
#include "core/surface/line_crossing.hpp"

namespace rouleau::core {

namespace {

constexpr int border = 2;  // nodes on every side

}  // namespace

void cover(const Mesh& mesh, Nodes nodes, VolumeFraction& fraction) {
  double least[3], most[3];
  const double* const along[3] = {nodes.x, nodes.y, nodes.z};
  bool usable = true;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(along[axis], along[axis] + mesh.node_count());
    least[axis] = *low, most[axis] = *high;
    for (int i = 0; i < mesh.node_count(); ++i) usable = usable && std::abs(along[axis][i]) < 1e9;
  }
  for (int axis = 0; axis < 3; ++axis) {
    fraction.first[axis] = usable ? floor_int(least[axis] + 0.5) - border : 0;
    fraction.size[axis] = usable ? floor_int(most[axis] + 0.5) + border + 1 - fraction.first[axis] : 0;
  }
  fraction.value.assign(static_cast<std::size_t>(fraction.size[0]) * fraction.size[1] * fraction.size[2], 0.0);
  if (!usable) return;
  // Lines lie a quarter and three quarters into a cube, line number n at first + n/2 - 1/4. Where one leaves the surface
  // at x, all nodes to the left gain what lies between them and x; where it enters, they lose it. What a whole node
  // gains is noted at the place of the crossing alone, and summed from right to left.
  for (const auto& corner : mesh.triangles()) {
    const Vec<3> a = nodes[corner[0]], b = nodes[corner[1]], c = nodes[corner[2]];
    const auto line_from = [&](int axis, double place) {
      return static_cast<int>(std::ceil(2 * (place - fraction.first[axis]) + 0.5));
    };
    const auto line_to = [&](int axis, double place) {
      return static_cast<int>(std::floor(2 * (place - fraction.first[axis]) + 0.5));
    };
    const int y_end = line_to(1, std::max({a.y(), b.y(), c.y()})), z_end = line_to(2, std::max({a.z(), b.z(), c.z()}));
    for (int m = line_from(2, std::min({a.z(), b.z(), c.z()})); m <= z_end; ++m) {
      for (int n = line_from(1, std::min({a.y(), b.y(), c.y()})); n <= y_end; ++n) {
        const auto crossing =
            line_crossing(a, b, c, {fraction.first[1] + 0.5 * n - 0.25, fraction.first[2] + 0.5 * m - 0.25});
        if (!crossing) continue;
        const double x = crossing->x, gain = crossing->leaves ? 0.25 : -0.25;
        double* row = fraction.row(n / 2, m / 2);
        const int node = std::clamp(floor_int(x + 0.5) - fraction.first[0], 1, fraction.size[0] - 1);
        const double part = x + 0.5 - (fraction.first[0] + node);
        row[node] += gain * part;
        row[node - 1] += gain * (1 - part);  // with what the sum from the right brings it has a whole one
      }
    }
  }
  for (int k = 0; k < fraction.size[2]; ++k) {
    for (int j = 0; j < fraction.size[1]; ++j) {
      double* row = fraction.row(j, k);
      for (int i = fraction.size[0] - 2; i >= 0; --i) row[i] += row[i + 1];
      for (int i = 0; i < fraction.size[0]; ++i) {
        if (std::abs(row[i]) < 1e-12) row[i] = 0;  // what enters and leaves cancels up to rounding
      }
    }
  }
}

void smooth(VolumeFraction& fraction, std::vector<double>& scratch) {
  const int width = fraction.size[0], height = fraction.size[1], depth = fraction.size[2];
  if (width == 0) return;
  const auto pass = [](const std::vector<double>& from, std::vector<double>& to, std::size_t begin, std::size_t end,
                       std::size_t stride) {
    for (std::size_t i = begin; i < end; ++i) to[i] = 0.25 * (from[i - stride] + from[i + stride]) + 0.5 * from[i];
  };
  const auto row = static_cast<std::size_t>(width), layer = row * static_cast<std::size_t>(height);
  const std::size_t all = layer * static_cast<std::size_t>(depth);
  scratch.assign(all, 0.0);
  pass(fraction.value, scratch, 1, all - 1, 1);  // the ends of rows are zero, so that neighbouring rows do not mix
  pass(scratch, fraction.value, row, all - row, row);
  pass(fraction.value, scratch, layer, all - layer, layer);
  fraction.value.swap(scratch);
}

}  // namespace rouleau::core
