// All membranes of a scene in two dimensions: closed polygons, in lattice units.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "cell_nodes.hpp"
#include "element_state.hpp"

namespace rouleau::core {

/// A closed polygon and its state of rest, which the cells of a type share. Lattice units, around the origin. Nodes are
/// counter-clockwise; segment i joins node i and the next node.
struct RestShape {
  std::vector<double> x, y;
  std::vector<double> rest_length;           ///< of segment i
  std::vector<double> rest_weight;           ///< (rest_length[i - 1] + rest_length[i]) / 2: rest measure of node i
  std::vector<double> rest_curvature;        ///< turning angle over rest_weight in the shape it was created with
  double rest_area = 0, rest_perimeter = 0;  ///< the second: sum of the rest lengths, or as created (created_as)

  /// Of segment i, as created.
  [[nodiscard]] double first_length(std::size_t i) const {
    const std::size_t next = (i + 1) % x.size();
    return std::hypot(x[next] - x[i], y[next] - y[i]);
  }
  /// Of each node at rest: its share of the perimeter, as it is of the area of a surface.
  [[nodiscard]] const std::vector<double>& node_measure() const { return rest_weight; }
};

/// Nodes counter-clockwise, at least three; `prestretch`: length as given over rest length.
RestShape make_rest_shape(std::vector<double> x, std::vector<double> y, double prestretch = 1);
/// Created in the shape of `first`, with its area and perimeter, and at rest as `rest` is, with as many nodes.
RestShape created_as(const RestShape& first, RestShape rest);

/// Closed polygons: the nodes of a cell are in the order of its type's shape.
struct Membranes : CellNodes {
  std::vector<std::shared_ptr<const RestShape>> types;

  [[nodiscard]] std::array<const double*, 2> positions() const { return pointers<2>(position); }
  [[nodiscard]] std::array<const double*, 2> forces() const { return pointers<2>(force); }
  [[nodiscard]] const RestShape& type_of(const CellRange& cell) const { return *types[cell.type]; }
};

/// Adds a cell that rests, its shape's origin at (x, y), turned counter-clockwise by `angle`.
void add_cell(Membranes& membranes, int type, double x, double y, double angle);

}  // namespace rouleau::core
