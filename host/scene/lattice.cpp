#include "lattice.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/solid_nodes.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {

double lattice_spacing(const Scene& scene) { return scene.domain.size.x() / scene.domain.nodes[0]; }

template <int D>
core::Domain<D> lattice_domain(const Scene& scene) {
  std::array<int, D> nodes;
  std::array<bool, D> periodic;
  std::copy_n(scene.domain.nodes.begin(), D, nodes.begin());
  std::copy_n(scene.domain.periodic.begin(), D, periodic.begin());
  return {nodes, periodic};
}
template core::Domain<2> lattice_domain(const Scene&);
template core::Domain<3> lattice_domain(const Scene&);

template <int D>
core::RegionPointer<D> fluid_region(const Scene& scene) {
  const double spacing = lattice_spacing(scene);
  if constexpr (D == 3) {
    if (scene.domain.tube_radius)
      return core::tube_region(lattice_domain<D>(scene).size, *scene.domain.tube_radius / spacing);
  }
  const core::RegionPointer<D>& region = scene.domain.region<D>();
  // The domain begins half a spacing before its first node.
  return region ? core::magnified<D>(region, 1 / spacing, core::Vec<D>::Constant(-0.5)) : nullptr;
}
template core::RegionPointer<2> fluid_region(const Scene&);
template core::RegionPointer<3> fluid_region(const Scene&);

std::vector<core::Layer> lattice_layers(const Scene& scene) {
  std::vector<core::Layer> layers;
  const double spacing = lattice_spacing(scene);
  for (const FluidLayer& layer : scene.fluid.layers) {
    layers.push_back({layer.from / spacing, layer.to / spacing, layer.viscosity / scene.fluid.viscosity});
  }
  return layers;
}

double fluid_nodes(const Domain& domain) { return domain.node_count() * (domain.content() / domain.size.product()); }

std::optional<LatticeSize> coarsest_lattice(const Vector& sides) {
  constexpr double tolerance = 1e-9;
  for (int rows = 4; rows <= most_coarse_rows; ++rows) {
    LatticeSize found;
    for (const double side : sides) {
      const double nodes = rows * side / sides[1];
      if (nodes > 3.5 && nodes < most_nodes_of_side + 0.5 && std::abs(nodes - std::round(nodes)) < tolerance * nodes)
        found.push_back(static_cast<int>(std::lround(nodes)));
    }
    if (static_cast<int>(found.size()) == sides.dimension()) return refined(found, 1);
  }
  return {};
}

std::optional<LatticeSize> refined(LatticeSize nodes, int factor) {
  double all = 1;
  for (int& of_side : nodes) {
    if (of_side > most_nodes_of_side / factor) return {};
    all *= of_side *= factor;
  }
  if (all > static_cast<double>(most_nodes_of_block)) return {};
  return nodes;
}

int fewest_ranks(const Domain& domain) {
  return static_cast<int>(std::ceil(domain.node_count() / static_cast<double>(most_nodes_of_block)));
}

}  // namespace rouleau::scene
