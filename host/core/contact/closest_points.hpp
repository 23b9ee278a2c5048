// The points of many triangles that are closest to many nodes.
#pragma once

#include <array>
#include <vector>

namespace rouleau::core {

/// Nodes, a triangle for each, and what is found of them.
struct ClosestPoints {
  std::vector<int> node;
  std::array<std::vector<int>, 3> corner;
  std::array<std::vector<double>, 3> moved;         ///< by so much the triangles' images lie beside them
  std::array<std::vector<double>, 3> weight, away;  ///< ClosestPoint
  std::vector<double> square;                       ///< of the distance

  /// Makes room for so many, and for whole packs.
  void resize(int count);
  /// Finds them all: `places` of all nodes.
  void find(int count, const std::array<const double*, 3>& places);
};

}  // namespace rouleau::core
