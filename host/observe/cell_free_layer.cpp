#include "cell_free_layer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace rouleau::observe {

namespace {

/// What a column has at each of its ends.
void narrow(CellFreeLayer& column, const CellFreeLayer& by) {
  column.lower = std::min(column.lower, by.lower);
  column.upper = std::min(column.upper, by.upper);
  column.empty = std::min(column.empty, by.empty);
}

/// The columns across y between the walls of a domain, by the node at which they stand.
class Columns {
 public:
  Columns(int count, int height)
      : upper_wall_(height - 0.5),
        columns_(static_cast<std::size_t>(count), CellFreeLayer{height / 2.0, height / 2.0}) {}

  /// A membrane between these heights.
  void meet(int column, double y, double other) {
    narrow(columns_[static_cast<std::size_t>(column)], {std::min(y, other) + 0.5, upper_wall_ - std::max(y, other), 0});
  }
  template <int D>
  [[nodiscard]] CellFreeLayer mean(const core::Ranks<D>& ranks) {
    core::join(ranks, columns_, narrow);
    const auto count = static_cast<double>(columns_.size());
    CellFreeLayer mean{0, 0, 0};
    for (const CellFreeLayer& column : columns_) {
      mean.lower += column.lower / count;
      mean.upper += column.upper / count;
      mean.empty += column.empty / count;
    }
    return mean;
  }

 private:
  double upper_wall_;
  std::vector<CellFreeLayer> columns_;
};

/// Calls visit(i) for the whole numbers from `least` to `most`. For none where they lie further apart than `longest`:
/// the last state of a run that blew up may hold anything.
template <class Visit>
void for_whole_numbers(double least, double most, double longest, Visit visit) {
  if (!(most - least < longest && std::abs(least) < 1e9)) return;
  for (double i = std::ceil(least); i <= most; ++i) visit(static_cast<int>(i));
}

/// Calls meet(i, v, w) for each whole number i at which the line from (a, va) to (b, vb) has values, from v to w: the
/// same, but for a line along which a does not change.
template <class Meet>
void at_whole_numbers(double a, double va, double b, double vb, double longest, Meet meet) {
  for_whole_numbers(std::min(a, b), std::max(a, b), longest, [&](int i) {
    const double v = b != a ? va + (vb - va) * (i - a) / (b - a) : va;
    meet(i, v, b != a ? v : vb);
  });
}

/// Calls meet(i, p, q) for each plane x = i in which a triangle of this rank's cells has a line, from p to q: (y, z). A
/// plane through a node belongs to what lies beyond it.
template <class Meet>
void for_lines_across(const core::Surfaces& surfaces, int longest, Meet meet) {
  using Place = std::array<double, 2>;
  for (const int c : surfaces.own_cells()) {
    const core::Nodes nodes = surfaces.nodes(c);
    for (const std::array<int, 3>& corners : surfaces.type_of(c).mesh.triangles()) {
      const core::Vec<3> at[] = {nodes[corners[0]], nodes[corners[1]], nodes[corners[2]]};
      const double left = std::min({at[0].x(), at[1].x(), at[2].x()}),
                   right = std::max({at[0].x(), at[1].x(), at[2].x()});
      for_whole_numbers(left, right, longest, [&](int x) {
        std::array<Place, 2> ends;
        int found = 0;
        for (int k = 0; k < 3; ++k) {
          const core::Vec<3>&from = at[k], &to = at[(k + 1) % 3];
          if ((from.x() <= x) == (to.x() <= x)) continue;
          const core::Vec<3> place = from + (to - from) * ((x - from.x()) / (to.x() - from.x()));
          ends[static_cast<std::size_t>(found++)] = {place.y(), place.z()};
        }
        if (found == 2) meet(x, ends[0], ends[1]);
      });
    }
  }
}

}  // namespace

CellFreeLayer cell_free_layer(const core::Membranes& membranes, const core::Domain<2>& domain,
                              const core::Ranks<2>& ranks) {
  Columns columns(domain.size[0], domain.size[1]);
  for (const int c : membranes.own_cells()) {
    const core::CellRange& cell = membranes.cells[c];
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(cell.next(i));
      at_whole_numbers(membranes.position[0][from], membranes.position[1][from], membranes.position[0][to],
                       membranes.position[1][to], domain.size[0],
                       [&](int x, double y, double other) { columns.meet(domain.wrapped(0, x), y, other); });
    }
  }
  return columns.mean(ranks);
}

CellFreeLayer cell_free_layer(const core::Surfaces& surfaces, const core::Domain<3>& domain,
                              const core::Ranks<3>& ranks) {
  Columns columns(domain.size[0] * domain.size[2], domain.size[1]);
  for_lines_across(surfaces, domain.size[0], [&](int x, const auto& p, const auto& q) {
    at_whole_numbers(p[1], p[0], q[1], q[0], domain.size[2], [&](int z, double y, double other) {
      const int column = domain.wrapped(0, x), layer = domain.wrapped(2, z);
      if (column >= 0 && layer >= 0) columns.meet(layer * domain.size[0] + column, y, other);
    });
  });
  return columns.mean(ranks);
}

CellFreeLayer cell_free_layer_in_tube(const core::Surfaces& surfaces, const core::Domain<3>& domain, double radius,
                                      const core::Ranks<3>& ranks) {
  const int half =
      std::max(1, static_cast<int>(std::ceil(std::numbers::pi * radius)));  // of the rays, half an angle off z
  const double angle = std::numbers::pi / half, axis_y = (domain.size[1] - 1) / 2.0,
               axis_z = (domain.size[2] - 1) / 2.0;
  std::vector<double> gaps(static_cast<std::size_t>(2 * half * domain.size[0]), radius);
  const auto narrow_gap = [](double& gap, double by) { gap = std::min(gap, by); };
  for_lines_across(surfaces, domain.size[0], [&](int x, const auto& p, const auto& q) {
    const double py = p[0] - axis_y, pz = p[1] - axis_z, dy = q[0] - p[0], dz = q[1] - p[1];
    if (!(std::hypot(py, pz) < 1e9 && std::hypot(dy, dz) < 2 * radius)) return;
    // The shorter way around the axis from one end to the other; rays are numbered by their angle with z, so that the
    // upper half comes first.
    const double begin = std::atan2(py, pz);
    double end = std::atan2(py + dy, pz + dz);
    if (end - begin > std::numbers::pi) end -= 2 * std::numbers::pi;
    if (end - begin < -std::numbers::pi) end += 2 * std::numbers::pi;
    for_whole_numbers(std::min(begin, end) / angle - 0.5, std::max(begin, end) / angle - 0.5, 2 * half, [&](int ray) {
      const double toward_y = std::sin((ray + 0.5) * angle), toward_z = std::cos((ray + 0.5) * angle),
                   across = toward_z * dy - toward_y * dz;
      const double distance =
          across != 0 ? (pz * dy - py * dz) / across : std::max(std::hypot(py, pz), std::hypot(py + dy, pz + dz));
      const int number = ((ray % (2 * half)) + 2 * half) % (2 * half);
      narrow_gap(gaps[static_cast<std::size_t>(number * domain.size[0] + domain.wrapped(0, x))], radius - distance);
    });
  });
  core::join(ranks, gaps, narrow_gap);
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  const auto mean = [&](auto from, auto to) {
    double sum = 0;
    for (auto gap = from; gap != to; ++gap) sum += *gap;
    return sum / static_cast<double>(to - from);
  };
  const auto empty = static_cast<double>(std::count(gaps.begin(), gaps.end(), radius));
  return {mean(middle, gaps.end()), mean(gaps.begin(), middle), empty / static_cast<double>(gaps.size())};
}

}  // namespace rouleau::observe
