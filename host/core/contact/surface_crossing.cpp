#include "surface_crossing.hpp"

#include <vector>

#include "surface_contacts.hpp"

namespace rouleau::core {

std::optional<SurfaceCrossing> find_crossing(const Surfaces& surfaces, const Domain<3>& domain) {
  constexpr double rounding = 1e-6;
  const SurfaceContacts contacts = SurfaceContacts::within(SurfaceCrossing::deepest, surfaces, domain);
  std::vector<std::vector<Vec<3>>> normals(surfaces.cells.size());  // of nodes; made where they are wanted
  std::optional<SurfaceCrossing> deepest;
  std::vector<SurfaceContact> list;
  for (const int cell : surfaces.own_cells()) {
    contacts.find(cell, surfaces, list);
    for (const SurfaceContact& contact : list) {
      std::vector<Vec<3>>& of_other = normals[contact.other];
      if (of_other.empty())
        of_other = node_normals(surfaces.type_of(contact.other).mesh, surfaces.nodes(contact.other));
      Vec<3> outward = Vec<3>::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        outward += contact.weight[k] * of_other[contact.corner[k] - surfaces.cells[contact.other].first];
      if (contact.direction.dot(outward) >= 0 || contact.distance < rounding) continue;
      if (!deepest || contact.distance > deepest->depth)
        deepest = SurfaceCrossing{cell, contact.other, contact.node, contact.distance};
    }
  }
  return deepest;
}

}  // namespace rouleau::core
