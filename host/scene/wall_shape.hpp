// Shapes of walls, as a scene writes them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "vector.hpp"

namespace rouleau::scene {

/// Shapes with borders that may move along themselves: m, m/s, 1/s.
struct WallBox {
  Vector lower, upper;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};
/// In two dimensions a disc.
struct WallSphere {
  Vector center;
  double radius;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
};
/// Of three dimensions.
struct WallCylinder {
  int axis;
  std::array<double, 2> center;  ///< along the other two axes, in their order
  double radius, from, to;
  double velocity = 0, angular_velocity = 0;  ///< along its axis, and about it
};

/// A part of the domain, in its coordinates, m. What reaches along an axis without an end has an infinite number there.
struct WallShape {
  using Box = WallBox;
  using Sphere = WallSphere;
  using Cylinder = WallCylinder;
  struct Outline {
    std::vector<std::array<double, 2>> points;
    double lower, upper;
  };  ///< a closed polygon of x and y; in three dimensions between two heights along z
  struct Mesh {
    std::filesystem::path file;
    double unit;                          ///< m, of the file's coordinates
    Vector at;                            ///< where the file's origin lies
    double angle;                         ///< rad, about z, or about the axis
    std::optional<Eigen::Vector3d> axis;  ///< unit vector that the file's y axis is turned to
  };                                      ///< closed triangles, of three dimensions
  struct Image {
    std::vector<std::filesystem::path> files;  ///< one, or a stack along z
    double pixel, spacing;                     ///< m; `spacing` of a stack's pictures
    bool light;                                ///< what is light belongs to it; false: what is dark
    Vector at;                                 ///< its lower left corner
  };
  enum class Kind { all_of, any_of, first_without_others };
  struct Joined {
    Kind kind;
    std::vector<WallShape> parts;
  };
  std::variant<Box, Sphere, Cylinder, Outline, Mesh, Image, Joined> is;
  std::string pointer = {};  ///< JSON pointer of what says so
};

}  // namespace rouleau::scene
