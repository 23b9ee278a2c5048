// All membranes of a scene: nodes of all cells in one structure of arrays, in lattice units.
#pragma once

#include <cstdint>
#include <vector>

#include "base/worker.hpp"
#include "element_state.hpp"
#include "topology.hpp"

namespace rouleau::core {

/// One cell: its nodes and segments in the arrays of Membranes.
struct CellRange : Segments {
  int type;               ///< index into the setup's cell types
  double rest_area;       ///< enclosed area as created: the fluid inside cannot leave
  double rest_perimeter;  ///< sum of the rest lengths
};

/// Two components for each node, of somebody else's.
struct NodeVectors {
  const double *x, *y;
};

/// Closed polygons, nodes counter-clockwise; segment i joins node i and the next node. Positions are not wrapped into
/// the periodic box, so that outlines stay whole. Lattice node (0, 0) lies at (0, 0), walls at y = -1/2 and ny - 1/2.
struct Membranes {
  std::vector<CellRange> cells;
  std::vector<double> x, y;                    ///< positions
  std::vector<double> force_x, force_y;        ///< on the nodes, set anew each step
  std::vector<double> velocity_x, velocity_y;  ///< displacement of the last step
  std::vector<double> largest_step;            ///< of each cell: no node moved further in the last step; empty: unknown
  std::vector<double> area_leakage;            ///< of each cell, over its rest area: area that the area correction has
                                               ///< kept from leaving it so far; empty: no correction
  std::vector<double> rest_length;             ///< of segment i
  std::vector<double> rest_weight;             ///< (rest_length[i - 1] + rest_length[i]) / 2: rest measure of node i
  std::vector<double> rest_curvature;          ///< turning angle over rest_weight in the shape it was created with
  std::vector<ElementState> state;             ///< what laws remember; empty where none does
  ContactMemory contacts;                      ///< what interactions between cells remember
  ContactMemory wall_contacts;                 ///< what interactions with walls remember
  std::vector<std::uint8_t> owned;             ///< of each cell: whether this rank computes its forces and moves it; of
                                               ///< others it knows where they are; empty: there are no others

  [[nodiscard]] NodeVectors positions() const { return {x.data(), y.data()}; }
  [[nodiscard]] NodeVectors forces() const { return {force_x.data(), force_y.data()}; }
  [[nodiscard]] int node_count() const { return static_cast<int>(x.size()); }
  [[nodiscard]] bool owns(int cell) const { return owned.empty() || owned[cell] != 0; }
  [[nodiscard]] int cell_count() const { return static_cast<int>(cells.size()); }
  /// The nodes of a worker's cells, worker.share(cell_count()).
  [[nodiscard]] Range node_share(Worker worker) const {
    const Range share = worker.share(cell_count());
    const auto first = [this](int cell) { return cell < cell_count() ? cells[cell].first : node_count(); };
    return {first(share.begin), first(share.end)};
  }
};

/// A closed polygon and its state of rest, which the cells of a type share. Lattice units, around the origin.
struct RestShape {
  std::vector<double> x, y;
  std::vector<double> rest_length, rest_weight, rest_curvature;  ///< as in Membranes
  double rest_area = 0, rest_perimeter = 0;
};

/// Nodes counter-clockwise, at least three; `prestretch`: length as given over rest length.
RestShape make_rest_shape(std::vector<double> x, std::vector<double> y, double prestretch = 1);

/// Adds a cell that rests, its shape's origin at (x, y), turned counter-clockwise by `angle`.
void add_cell(Membranes& membranes, int type, const RestShape& shape, double x, double y, double angle);

}  // namespace rouleau::core
