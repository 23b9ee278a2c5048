#include "padded_triangles.hpp"

#include <algorithm>

namespace rouleau::core {

PaddedTriangles::PaddedTriangles(const Mesh& mesh)
    : count(mesh.triangle_count()), size(padded(count)), corners(mesh.corners()) {
  for (int t = 0; t < size; ++t)
    for (int k = 0; k < 3; ++k) corner[k].push_back(mesh.triangles()[std::min(t, count - 1)][k]);
  for (int& entry : corners.entry) {
    triangle.push_back(entry / 3);
    entry = entry % 3 * size + entry / 3;
  }
}

}  // namespace rouleau::core
