// All membranes of a scene in three dimensions: closed surfaces of triangles, in lattice units.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "core/membrane/geometry.hpp"
#include "core/membrane/membranes.hpp"
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
  double rest_surface_area = 0;        ///< sum of the triangles' areas at rest; with a stress-free shape as created

  /// Nodes of the shape in which it is free of stress, where that is another than the one it is created with.
  std::array<std::vector<double>, 3> stress_free;

  [[nodiscard]] Nodes nodes() const { return {x.data(), y.data(), z.data()}; }
  [[nodiscard]] Nodes nodes_at_rest() const {
    return stress_free[0].empty() ? nodes()
                                  : Nodes{stress_free[0].data(), stress_free[1].data(), stress_free[2].data()};
  }
  /// Of each node at rest: its share of the area, as it is of the perimeter of an outline.
  [[nodiscard]] const std::vector<double>& node_measure() const { return node_area; }
};

/// `prestretch`: lengths as given over those at rest.
RestSurface make_rest_surface(Mesh mesh, std::vector<double> x, std::vector<double> y, std::vector<double> z,
                              double prestretch = 1);
/// Created in the shape of `first`, with its area and volume, and at rest as `rest` is; both have the same mesh.
RestSurface created_as(const RestSurface& first, RestSurface rest);

/// Closed surfaces: the nodes of a cell are in the order of its type's mesh.
struct Surfaces : CellNodes {
  std::vector<std::shared_ptr<const RestSurface>> types;

  [[nodiscard]] std::array<const double*, 3> positions() const { return pointers<3>(position); }
  [[nodiscard]] std::array<const double*, 3> forces() const { return pointers<3>(force); }
  [[nodiscard]] const RestSurface& type_of(int cell) const { return *types[cells[cell].type]; }
  [[nodiscard]] Nodes nodes(int cell) const {
    const int first = cells[cell].first;
    return {&position[0][first], &position[1][first], &position[2][first]};
  }
};

/// The cells of a scene in D dimensions.
template <int D>
using Cells = std::conditional_t<D == 2, Membranes, Surfaces>;

/// Smallest and largest stretch of an edge: length over rest length.
StretchRange stretch_range(const Surfaces& surfaces, int cell);
/// The same of length over that of other nodes, times a factor.
StretchRange stretch_range(const Surfaces& surfaces, int cell, Nodes then, double factor = 1);
/// Smallest and largest principal stretch of any triangle, as created against its state of rest.
StretchRange first_stretch(const RestSurface& surface);

/// Adds a cell that rests, its shape's origin at `center`, turned by `rotation`.
void add_cell(Surfaces& surfaces, int type, const Vec<3>& center,
              const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());

}  // namespace rouleau::core
