// All membranes of a scene in three dimensions: nodes of all cells in one structure of arrays, in lattice units.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "base/worker.hpp"
#include "mesh.hpp"

namespace rouleau::core {

/// A closed surface and its state of rest, which the cells of a type share. Lattice units, around the origin.
struct RestSurface {
  explicit RestSurface(Mesh joined) : mesh(std::move(joined)) {}
  Mesh mesh;
  std::vector<double> x, y, z;  ///< as created
  /// Of each triangle: the inverse of its metric at rest, with the edges from its first node to the second and third.
  std::vector<double> inverse_11, inverse_12, inverse_22;
  std::vector<double> triangle_area;   ///< at rest
  std::vector<double> node_area;       ///< at rest, the share of each node (node_areas)
  std::vector<double> third_area;      ///< at rest, a third of the triangles around each node: what area_ratio is over
  std::vector<double> rest_curvature;  ///< of the shape as created, over node_area
  double rest_volume = 0;              ///< as created: the fluid inside cannot leave
  double rest_surface_area = 0;        ///< sum of the triangles' areas at rest

  [[nodiscard]] Nodes nodes() const { return {x.data(), y.data(), z.data()}; }
};

/// `prestretch`: lengths as given over those at rest.
RestSurface make_rest_surface(Mesh mesh, std::vector<double> x, std::vector<double> y, std::vector<double> z,
                              double prestretch = 1);

/// One cell: its nodes in the arrays of Surfaces, in the order of its type's mesh.
struct SurfaceCell {
  int first, count;
  int type;
  [[nodiscard]] int end() const { return first + count; }
};

/// Positions are not wrapped into the periodic box, so that surfaces stay whole. Lattice node (0, 0, 0) lies at the
/// origin, walls half a spacing outside the first and the last node.
struct Surfaces {
  std::vector<std::shared_ptr<const RestSurface>> types;
  std::vector<SurfaceCell> cells;
  std::vector<double> x, y, z;                             ///< positions
  std::vector<double> force_x, force_y, force_z;           ///< on the nodes, set anew each step
  std::vector<double> velocity_x, velocity_y, velocity_z;  ///< displacement of the last step

  [[nodiscard]] int node_count() const { return static_cast<int>(x.size()); }
  [[nodiscard]] int cell_count() const { return static_cast<int>(cells.size()); }
  [[nodiscard]] const RestSurface& type_of(int cell) const { return *types[cells[cell].type]; }
  [[nodiscard]] Nodes nodes(int cell) const {
    const int first = cells[cell].first;
    return {&x[first], &y[first], &z[first]};
  }
  /// The nodes of a worker's cells, worker.share(cell_count()).
  [[nodiscard]] Range node_share(Worker worker) const {
    const Range share = worker.share(cell_count());
    const auto first = [this](int cell) { return cell < cell_count() ? cells[cell].first : node_count(); };
    return {first(share.begin), first(share.end)};
  }
};

/// Adds a cell that rests, its shape's origin at `center`, turned by `rotation`.
void add_cell(Surfaces& surfaces, int type, const Vec<3>& center,
              const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

}  // namespace rouleau::core
