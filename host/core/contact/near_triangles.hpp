// Triangles of surfaces and their images that may lie near the nodes of one cell.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "core/domain/images.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// Images of cells in patches of triangles that follow each other, which lie side by side in most meshes: who asks for
/// the triangles near a place looks at patches first.
class NearTriangles {
 public:
  struct Triangle {
    int triangle;   ///< number in its cell
    Vec<3> middle;  ///< of the image
    double radius;  ///< no corner lies farther from it
    double around;  ///< reach plus that
  };
  /// Triangles, or patches of them, [begin, end), and a box that holds all places that one of them is near.
  struct Part {
    std::size_t begin, end;
    Eigen::AlignedBox3d reached;
  };
  /// One image of a cell.
  struct Image {
    int other;
    ImageShift shift;
    bool within;               ///< it is the cell's own surface
    Part part{};               ///< its patches
    std::vector<Part> near{};  ///< those of them that the chosen place is near
  };

  /// Adds those triangles of an image that lie within the reach of a box; the image, if there are any.
  void add(const BoundingBox<3>& box, Image image, double reach, const Surfaces& surfaces, const Domain<3>& domain);
  /// After all have been added, by cell, then by shift: the order of images.
  void sort_images();
  [[nodiscard]] const std::vector<Image>& images() const { return images_; }

  /// Chooses a place that for_near() is about.
  void choose(const Eigen::AlignedBox3d& box);
  /// Calls function(triangle, distance) for an image's triangles that are near a place in the chosen box; `distance`:
  /// of their middles.
  template <class Function>
  void for_near(const Vec<3>& place, const Image& image, Function function) const {
    for (const Part& patch : image.near) {
      if (!patch.reached.contains(place)) continue;
      for (std::size_t t = patch.begin; t < patch.end; ++t) {
        const double square = (place - triangles_[t].middle).squaredNorm();
        if (square <= triangles_[t].around * triangles_[t].around) function(triangles_[t], std::sqrt(square));
      }
    }
  }

 private:
  std::vector<Triangle> triangles_;
  std::vector<Part> patches_;
  std::vector<Image> images_;
};

}  // namespace rouleau::core
