#include "triangle_surface.hpp"

#include <utility>

namespace rouleau::shape {

core::RestSurface rest_surface(const TriangleSurface& surface, double prestretch) {
  std::vector<double> x, y, z;
  for (const core::Vec<3>& node : surface.nodes) {
    x.push_back(node.x());
    y.push_back(node.y());
    z.push_back(node.z());
  }
  return core::make_rest_surface(core::Mesh(static_cast<int>(surface.nodes.size()), surface.triangles), std::move(x),
                                 std::move(y), std::move(z), prestretch);
}

}  // namespace rouleau::shape
