#include "lattice_size.hpp"

#include <algorithm>
#include <cmath>

#include "scene/scene_reader.hpp"

namespace rouleau::plan {

LatticeSize lattice_size(const scene::Domain& domain) {
  LatticeSize size{domain.nodes[0], domain.nodes[1]};
  if (domain.depth) size.push_back(domain.depth->nodes);
  return size;
}

std::vector<double> sides(const scene::Domain& domain) {
  std::vector<double> lengths{domain.size.x(), domain.size.y()};
  if (domain.depth) lengths.push_back(domain.depth->size);
  return lengths;
}

scene::Domain with_lattice(scene::Domain domain, const LatticeSize& nodes) {
  domain.nodes = {nodes[0], nodes[1]};
  if (domain.depth) domain.depth->nodes = nodes[2];
  return domain;
}

double fluid_nodes(const scene::Domain& domain) {
  if (!domain.tube_radius) return domain.node_count();
  return domain.node_count() * domain.content() / (domain.size.prod() * domain.depth->size);
}

std::optional<LatticeSize> coarsest_lattice(const std::vector<double>& sides) {
  constexpr double tolerance = 1e-9;
  for (int rows = 4; rows <= most_coarse_rows; ++rows) {
    LatticeSize found;
    for (const double side : sides) {
      const double nodes = rows * side / sides[1];
      if (nodes > 3.5 && nodes < scene::most_nodes_of_side + 0.5 &&
          std::abs(nodes - std::round(nodes)) < tolerance * nodes)
        found.push_back(static_cast<int>(std::lround(nodes)));
    }
    if (found.size() == sides.size()) return refined(found, 1);
  }
  return {};
}

std::optional<LatticeSize> refined(LatticeSize nodes, int factor) {
  double all = 1;
  for (int& of_side : nodes) {
    if (of_side > scene::most_nodes_of_side / factor) return {};
    all *= of_side *= factor;
  }
  if (all > static_cast<double>(scene::most_nodes_of_block)) return {};
  return nodes;
}

int fewest_ranks(const scene::Domain& domain) {
  return static_cast<int>(std::ceil(domain.node_count() / static_cast<double>(scene::most_nodes_of_block)));
}

}  // namespace rouleau::plan
