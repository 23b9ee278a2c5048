#include "lattice.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/openings/section.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "scene_reader.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::scene {

double lattice_spacing(const Scene& scene) { return scene.domain.size.x() / scene.domain.nodes[0]; }

template <int D>
core::Domain<D> lattice_domain(const Scene& scene) {
  std::array<int, D> nodes;
  std::array<bool, D> periodic;
  std::copy_n(scene.domain.nodes.begin(), D, nodes.begin());
  std::copy_n(scene.domain.periodic.begin(), D, periodic.begin());
  core::Domain<D> domain(nodes, periodic);
  domain.open_axis = scene.domain.open_axis;
  return domain;
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
  for (const FluidLayer& layer : scene.fluid.layers)
    layers.push_back({layer.from / spacing, layer.to / spacing, layer.viscosity / scene.fluid.viscosity});
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

namespace {

template <int D>
std::vector<OpenPart> parts_at(const Scene& scene, int end) {
  const core::Domain<D> domain = lattice_domain<D>(scene);
  const core::RegionPointer<D> region = fluid_region<D>(scene);
  const double spacing = lattice_spacing(scene);
  const int axis = domain.flow_axis();
  std::vector<OpenPart> found;
  std::vector<Vector> places;  // of all nodes of the section
  const std::vector<int> parts = core::parts_of_section<D>(domain, end, [&](const std::array<int, D>& node) {
    core::Vec<D> place;
    Vector at = Vector::filled(D, end == 0 ? 0 : scene.domain.size[axis]);
    for (int k = 0; k < D; ++k) place[k] = node[k];
    for (int k = 0; k < D; ++k)
      if (k != axis) at[k] = units::coordinate(node[k], spacing);
    places.push_back(at);
    return !region || region->distance(place).value > 0;
  });
  const double of_node = std::pow(spacing, D - 1);
  for (std::size_t row = 0; row < parts.size(); ++row) {
    const int part = parts[row];
    if (part < 0) continue;
    if (part == static_cast<int>(found.size())) found.push_back({0, places[row]});
    OpenPart& of = found[part];
    of.area += of_node;
    for (int k = 0; k < D; ++k) {  // the mean of the images that lie nearest to it
      if (k == axis) continue;
      double apart = places[row][k] - of.at[k];
      if (domain.periodic[k]) apart -= scene.domain.size[k] * std::round(apart / scene.domain.size[k]);
      of.at[k] += apart * of_node / of.area;
    }
  }
  return found;
}

}  // namespace

std::vector<OpenPart> open_parts(const Scene& scene, int end) {
  return in_dimension(scene.domain.dimension(),
                      [&]<int D>(std::integral_constant<int, D>) { return parts_at<D>(scene, end); });
}

}  // namespace rouleau::scene
