// How much of each lattice node's unit cube lies inside a closed surface.
#pragma once

#include <vector>

#include "core/surface/mesh.hpp"

namespace rouleau::core {

/// Values on the box around one cell, not wrapped into the lattice. Two nodes on every side are zero before smoothing.
struct VolumeFraction {
  int first[3] = {0, 0, 0};   ///< element (i, j, k) is lattice node first + (i, j, k)
  int size[3] = {0, 0, 0};    ///< no size: nothing covered
  std::vector<double> value;  ///< [z][y][x]

  [[nodiscard]] const double* row(int j, int k) const { return value.data() + at(j, k); }
  [[nodiscard]] double* row(int j, int k) { return value.data() + at(j, k); }

 private:
  [[nodiscard]] std::size_t at(int j, int k) const {
    return (static_cast<std::size_t>(k) * size[1] + j) * static_cast<std::size_t>(size[0]);
  }
};

/// The fraction along four lines through each cube, parallel to x, of which it is the mean: exact along them, so that the
/// sum of all values is the enclosed volume up to an error of second order. Where a surface overlaps itself twice it is 2.
void cover(const Mesh& mesh, Nodes nodes, VolumeFraction& fraction);

/// One pass of (1 2 1)/4 along each axis; keeps the sum.
void smooth(VolumeFraction& fraction, std::vector<double>& scratch);

}  // namespace rouleau::core
