// Normals and areas of all surfaces where they are: what the corrections of a step share.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/worker.hpp"
#include "core/membrane/paged_array.hpp"
#include "padded_triangles.hpp"
#include "surfaces.hpp"

namespace rouleau::core {

class SurfaceNormals {
 public:
  explicit SurfaceNormals(const Surfaces& surfaces);

  /// Pass over cells: at the present positions.
  void measure(Worker worker, const Surfaces& surfaces, Whose whose = Whose::own);

  /// Of all nodes: the normals of the triangles around, each twice its area long, added up. That is six times the
  /// gradient of the cell's volume.
  [[nodiscard]] std::array<const double*, 3> sums() const { return {sum_[0].data(), sum_[1].data(), sum_[2].data()}; }
  /// Of all nodes: a third of the triangles around.
  [[nodiscard]] const double* node_areas() const { return node_area_.data(); }
  /// Of a cell's triangles; behind them as many as fill the last pack.
  [[nodiscard]] const double* triangle_areas(int cell) const { return triangle_area_[cell].data(); }

  /// Takes no memory for the cells that are not known, which have these nodes.
  void forget(const Surfaces& surfaces, std::span<const Range> nodes);

 private:
  std::vector<PaddedTriangles> meshes_;  // of each type
  std::array<PagedArray<double>, 3> sum_;
  PagedArray<double> node_area_;
  std::vector<std::vector<double>> triangle_area_;                 // of each cell
  WorkerScratch<std::array<std::vector<double>, 3>> of_triangle_;  // normals
};

}  // namespace rouleau::core
