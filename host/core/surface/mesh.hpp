// Closed surfaces of triangles: how the nodes of a cell are joined to a membrane in three dimensions.
#pragma once

#include <array>
#include <vector>

#include "core/domain/vec.hpp"

namespace rouleau::core {

/// Triangles with their nodes counter-clockwise seen from outside. Every edge joins two triangles, every node has one
/// closed ring of them around it.
class Mesh {
 public:
  /// Throws std::invalid_argument, with the triangle or node, for what is no such surface in one piece: a hole, an edge
  /// of three triangles, triangles that run in opposite directions, a node between two rings or without a triangle.
  Mesh(int node_count, std::vector<std::array<int, 3>> triangles);

  struct Edge {
    int a, b;         ///< nodes: in the triangle `left` b follows a
    int left, right;  ///< triangles
  };
  /// Entries [first[i], first[i + 1]) of `entry` belong to node i.
  struct Rings {
    std::vector<int> first, entry;
  };

  [[nodiscard]] int node_count() const { return node_count_; }
  [[nodiscard]] int triangle_count() const { return static_cast<int>(triangles_.size()); }
  [[nodiscard]] int edge_count() const { return static_cast<int>(edges_.size()); }
  [[nodiscard]] const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
  /// Edges of a triangle; number k lies opposite to its corner k.
  [[nodiscard]] const std::vector<std::array<int, 3>>& triangle_edges() const { return triangle_edges_; }
  /// Corners around a node: corner k of triangle t is entry 3 t + k.
  [[nodiscard]] const Rings& corners() const { return corners_; }
  [[nodiscard]] const Rings& node_edges() const { return node_edges_; }

 private:
  void join_edges();
  void make_rings();

  int node_count_;
  std::vector<std::array<int, 3>> triangles_, triangle_edges_;
  std::vector<Edge> edges_;
  Rings corners_, node_edges_;
};

/// Positions of the nodes of a mesh, components apart.
struct Nodes {
  const double *x, *y, *z;
  [[nodiscard]] Vec<3> operator[](int i) const { return {x[i], y[i], z[i]}; }
};

/// Enclosed volume, positive where triangles run counter-clockwise seen from outside.
double enclosed_volume(const Mesh& mesh, Nodes nodes);
double surface_area(const Mesh& mesh, Nodes nodes);
/// Whether a point lies inside.
bool encloses(const Mesh& mesh, Nodes nodes, const Vec<3>& point);

/// Twice the area of each triangle, along its outer normal.
std::vector<Vec<3>> area_vectors(const Mesh& mesh, Nodes nodes);

/// Outer normal at each node, a unit vector: that of the triangles around it, by their areas.
std::vector<Vec<3>> node_normals(const Mesh& mesh, Nodes nodes);

/// Share of the surface that belongs to each node: the part of its triangles that lies nearest to it (of an obtuse one
/// half to the obtuse corner and a quarter to each other). Their sum is the surface's area. Curvature over this area
/// converges at every node, nodes with five neighbours included, which a third of each triangle does not.
/// Meyer, Desbrun, Schroder and Barr, Visualization and Mathematics III (2003).
std::vector<double> node_areas(const Mesh& mesh, Nodes nodes);

/// Integral of the sum of both principal curvatures over the surface that belongs to each node: half of length times
/// turning angle of its edges, positive where the surface bulges outward.
std::vector<double> integrated_curvature(const Mesh& mesh, Nodes nodes);

/// Ellipsoid of homogeneous mass with the volume and the second moments of what a surface encloses.
struct InertiaEllipsoid {
  Vec<3> center;
  std::array<double, 3> semi_axes;  ///< largest first
  std::array<Vec<3>, 3> axes;       ///< unit vectors
};
InertiaEllipsoid inertia_ellipsoid(const Mesh& mesh, Nodes nodes);

/// Of the two axes that lie closest to the plane of x and y, Taylor's deformation (a - b)/(a + b), and the angle of the
/// longer one against x, in (-pi/2, pi/2].
struct PlaneDeformation {
  double deformation, angle;
};
PlaneDeformation deformation_in_xy(const InertiaEllipsoid& ellipsoid);

}  // namespace rouleau::core
