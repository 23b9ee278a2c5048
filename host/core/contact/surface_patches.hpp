// Distances between surfaces at one instant, where lists of candidates would not be used again.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "closest_points.hpp"
#include "core/domain/images.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// Surfaces in patches, of nodes and of triangles that follow each other and so lie side by side in most meshes, with a
/// box around each: only where boxes come nearer than what has been found are the points themselves looked at.
/// Distances are those of TriangleContacts, to the bit.
class SurfacePatches {
 public:
  /// Both outlive this, and nothing moves meanwhile. Of cells that are not known nothing is asked.
  SurfacePatches(const Surfaces& surfaces, const Domain<3>& domain)
      : surfaces_(surfaces), domain_(domain), cells_(surfaces.cells.size()) {}

  struct Point {
    double square;  ///< of the distance
    int triangle;   ///< of equally near ones the first
    std::array<double, 3> weight;
    Vec<3> away;  ///< from the closest point to the place
  };
  /// The point of a cell's surface closest to a place, if it lies within `most`.
  std::optional<Point> closest(const Vec<3>& place, int cell, double most);
  /// The smallest distance between a cell and any image of the others, itself among them, from the nodes of either to
  /// the surface of the other, if it is not more than `most`; else infinite. `boxes`: of all cells.
  double gap(int cell, std::span<const int> others, const std::vector<BoundingBox<3>>& boxes, double most);

 private:
  using Box = Eigen::AlignedBox3d;
  struct Patches {
    std::vector<Box> nodes, triangles;
  };
  static constexpr int size = 16;  // of a patch
  const Patches& of(int cell);
  /// Lowers `square` to that of the smallest distance of the nodes of one cell from the surface of another, moved.
  void lower(double& square, int from, int to, const Vec<3>& moved);
  void look(double& square, int from, int nodes, int to, int triangles, const Vec<3>& moved);

  const Surfaces& surfaces_;
  const Domain<3>& domain_;
  std::vector<Patches> cells_;
  ClosestPoints points_;
  struct Near {
    double square;
    int nodes, triangles;
  };
  std::vector<Near> near_;
};

}  // namespace rouleau::core
