#include "surface_normals.hpp"

#include <algorithm>

#include "core/domain/run_loop.hpp"
#include "core/domain/vectors.hpp"

namespace rouleau::core {

namespace {

struct NormalTask {
  int triangles;
  const double* place[3];
  const int* corner[3];
  double *normal[3], *area;
};

/// Triangles: normals, twice the area long, and areas.
struct FindNormals {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const NormalTask* task) {
    using S = Pack<double, register_bytes / 8>;
    const NormalTask t = *task;
    for (int k = 0; k < t.triangles; k += S::size) {
      const auto corner = [&](int c) { return Vectors<S>::gather(t.place, t.corner[c] + k); };
      const Vectors<S> first = corner(0), normal = cross(corner(1) - first, corner(2) - first);
      normal.store(t.normal, k);
      (0.5 * sqrt(dot(normal, normal))).store(t.area + k);
    }
  }
};

}  // namespace

SurfaceNormals::SurfaceNormals(const Surfaces& surfaces)
    : node_area_(surfaces.position[0].size()),
      triangle_area_(surfaces.cells.size()),
      of_triangle_(surfaces.cells.size()) {
  for (const auto& type : surfaces.types) meshes_.emplace_back(type->mesh);
  for (auto& values : sum_) values = PagedArray<double>(surfaces.position[0].size());
}

void SurfaceNormals::measure(Worker worker, const Surfaces& surfaces, Whose whose) {
  const CellNumbers cells = surfaces.known_cells(worker);
  for (const int cell : cells) {
    if (!surfaces.is(cell, whose)) continue;
    const CellRange& range = surfaces.cells[cell];
    const PaddedTriangles& mesh = meshes_[range.type];
    const auto size = static_cast<std::size_t>(mesh.size);
    auto& of_triangle = of_triangle_.of(cells.first_place());
    for (auto& values : of_triangle) values.resize(std::max(values.size(), size));
    triangle_area_[cell].resize(size);
    const Nodes nodes = surfaces.nodes(cell);
    NormalTask task{};
    task.triangles = mesh.count, task.area = triangle_area_[cell].data();
    task.place[0] = nodes.x, task.place[1] = nodes.y, task.place[2] = nodes.z;
    point_into(task.corner, mesh.corner), point_into(task.normal, of_triangle);
    run_loop<FindNormals>(task);
    const std::array<const double*, 4> values{task.normal[0], task.normal[1], task.normal[2], task.area};
    for (int i = 0; i < range.count; ++i) {
      const auto [x, y, z, area] = mesh.sums_of_triangles(values, i);
      const int node = range.first + i;
      sum_[0][node] = x, sum_[1][node] = y, sum_[2][node] = z, node_area_[node] = area / 3;
    }
  }
}

void SurfaceNormals::forget(const Surfaces& surfaces, std::span<const Range> nodes) {
  for (auto* values : {&sum_[0], &sum_[1], &sum_[2], &node_area_}) release(*values, nodes);
  surfaces.forget_unknown_of(triangle_area_);
}

}  // namespace rouleau::core
