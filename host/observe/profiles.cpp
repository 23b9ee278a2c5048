#include "profiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/lattice.hpp"

namespace rouleau::observe {

namespace {

/// The bins of a scene, in spacings: over the height, or from the axis of a tube to its wall.
struct Bins {
  int count;
  bool radial, wraps;
  double height, depth, width;  ///< of the lattice along y and z; of a bin
  explicit Bins(const scene::Scene& scene)
      : count(scene.output.profiles->bins),
        radial(scene.output.profiles->radial),
        wraps(scene.domain.periodic[1] && !radial),
        height(scene.domain.nodes[1]),
        depth(scene.domain.in_plane() ? 1 : scene.domain.nodes[2]),
        width((radial ? *scene.domain.tube_radius / scene::lattice_spacing(scene) : height) / count) {}

  /// Of a place, whose lattice node 0 lies half a spacing from the edge; the last one of what lies beyond.
  [[nodiscard]] int at(double y, double z) const {
    double from = radial ? std::hypot(y - (height - 1) / 2, z - (depth - 1) / 2) : y + 0.5;
    if (wraps) from -= height * std::floor(from / height);
    return std::clamp(static_cast<int>(std::floor(from / width)), 0, count - 1);
  }
  /// What a bin holds across x.
  [[nodiscard]] double section(int bin) const {
    return radial ? std::numbers::pi * width * width * (2 * bin + 1) : width * depth;
  }
};

template <int D, class AddCell>
std::vector<double> shares(const core::CellNodes& cells, const scene::Scene& scene, const core::Ranks<D>& ranks,
                           AddCell add_cell) {
  const Bins bins(scene);
  std::vector<core::ExactSum> sums(static_cast<std::size_t>(bins.count));
  for (const int c : cells.own_cells())
    add_cell(cells.cells[c], bins, [&](int bin, double content) { sums[bin].add(content); });
  core::add_up(ranks, sums);
  std::vector<double> share(sums.size());
  for (int k = 0; k < bins.count; ++k) share[k] = sums[k].value() / (bins.section(k) * scene.domain.nodes[0]);
  return share;
}

}  // namespace

std::vector<double> hematocrit_profile(const core::Membranes& m, const scene::Scene& scene,
                                       const core::Ranks<2>& ranks) {
  return shares(m, scene, ranks, [&](const core::CellRange& cell, const Bins& bins, auto add) {
    for (int i = cell.first; i < cell.end(); ++i) {
      const int next = cell.next(i);
      const double x0 = m.position[0][i] - m.position[0][cell.first], y0 = m.position[1][i],
                   x1 = m.position[0][next] - m.position[0][cell.first], y1 = m.position[1][next];
      // Cut where it crosses from bin to bin, which lie at whole numbers of widths from half a spacing below node 0.
      const double low = (std::min(y0, y1) + 0.5) / bins.width, high = (std::max(y0, y1) + 0.5) / bins.width;
      double before = low;
      for (double cut = std::floor(low) + 1; before < high; ++cut) {
        const double after = std::min(cut, high), middle = (before + after) / 2 * bins.width - 0.5;
        const double x = x0 + (x1 - x0) * (y1 == y0 ? 0.5 : (middle - y0) / (y1 - y0));
        add(bins.at(middle, 0), std::copysign((after - before) * bins.width, y1 - y0) * x);
        before = after;
      }
    }
  });
}

std::vector<double> hematocrit_profile(const core::Surfaces& s, const scene::Scene& scene,
                                       const core::Ranks<3>& ranks) {
  constexpr int pieces = 4;  // along an edge
  return shares(s, scene, ranks, [&](const core::CellRange& cell, const Bins& bins, auto add) {
    const core::Mesh& mesh = s.types[cell.type]->mesh;
    const auto at = [&](int node) {
      const int i = cell.first + node;
      return core::Vec<3>(s.position[0][i] - s.position[0][cell.first], s.position[1][i], s.position[2][i]);
    };
    for (const auto& [a, b, c] : mesh.triangles()) {
      const core::Vec<3> origin = at(a), u = (at(b) - origin) / pieces, v = (at(c) - origin) / pieces;
      const double facing = (u.y() * v.z() - u.z() * v.y()) / 2;  // area of a piece as seen along x
      for (int i = 0; i < pieces; ++i) {
        for (int j = 0; i + j < pieces; ++j) {
          // The piece with corner (i, j), and the one that fills the parallelogram.
          for (const double third : {1.0 / 3, 2.0 / 3}) {
            if (third > 0.5 && i + j + 1 >= pieces) continue;
            const core::Vec<3> middle = origin + (i + third) * u + (j + third) * v;
            add(bins.at(middle.y(), middle.z()), facing * middle.x());
          }
        }
      }
    }
  });
}

std::vector<double> velocity_profile(const std::vector<double>& rows, const scene::Scene& scene) {
  const Bins bins(scene);
  const int height = scene.domain.nodes[1];
  std::vector<double> sum(static_cast<std::size_t>(bins.count)), weight(sum);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const int y = static_cast<int>(row) % height, z = static_cast<int>(row) / height;
    if (bins.radial) {
      if (std::hypot(y - (bins.height - 1) / 2, z - (bins.depth - 1) / 2) > bins.width * bins.count) continue;
      const int bin = bins.at(y, z);
      sum[bin] += rows[row], weight[bin] += 1;
      continue;
    }
    for (int bin = static_cast<int>(y / bins.width); bin < bins.count && bin * bins.width < y + 1; ++bin) {
      const double share = std::min(y + 1.0, (bin + 1) * bins.width) - std::max<double>(y, bin * bins.width);
      if (share > 0) sum[bin] += share * rows[row], weight[bin] += share;
    }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= weight[k];
  return sum;
}

double place_of_bin(const scene::Scene& scene, int bin) {
  return (bin + 0.5) * Bins(scene).width * scene::lattice_spacing(scene);
}

void ProfileHistory::follow(const Snapshot& snapshot) {
  if (snapshot.velocity_profile.empty()) return;
  if (stages_.empty() || stages_.back().stage != snapshot.stage_name) stages_.push_back({snapshot.stage_name, {}});
  stages_.back().instants.push_back({snapshot.time, snapshot.velocity_profile, snapshot.hematocrit_profile});
}

}  // namespace rouleau::observe
