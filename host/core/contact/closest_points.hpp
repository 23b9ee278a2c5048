// The points of many triangles that are closest to many places.
#pragma once

#include <array>
#include <vector>

namespace rouleau::core {

/// Places, a triangle for each, and what is found of them.
struct ClosestPoints {
  std::array<std::vector<double>, 3> place;
  std::array<std::vector<int>, 3> corner;
  std::array<std::vector<double>, 3> weight, away;  ///< ClosestPoint
  std::vector<double> square;                       ///< of the distance

  /// Makes room for so many, and for whole packs.
  void resize(int count);
  /// Finds them all: `nodes` are where the corners are.
  void find(int count, const std::array<const double*, 3>& nodes);
};

}  // namespace rouleau::core
