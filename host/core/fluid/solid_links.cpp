#include "solid_links.hpp"

#include <algorithm>

namespace rouleau::core {

template <class T, class Set>
SolidLinks<T, Set>::SolidLinks(Lattice<T, Set>& lattice, const SolidNodes<dimension>& solid) {
  using Node = std::array<int, dimension>;
  const Domain<dimension>& domain = lattice.domain();
  const auto slot = [&](int q, const Node& node) {
    typename Lattice<T, Set>::Row row;
    std::copy(node.begin() + 1, node.end(), row.begin());
    return lattice.slot(q, row) + node[0];
  };
  for (int i = 0; i < lattice.rows(); ++i) {
    first_.push_back(links_.size());
    const auto row = lattice.row(i);
    Node node;  // of the block
    std::copy(row.begin(), row.end(), node.begin() + 1);
    const auto is_solid = [&](Node of_block) {
      for (int k = 0; k < dimension; ++k) of_block[k] += domain.block.begin[k];
      return solid.at(domain, of_block);
    };
    for (node[0] = 0; node[0] < lattice.size(0); ++node[0]) {
      if (is_solid(node)) continue;
      for (int q = 1; q < Set::velocity_count; ++q) {
        Node beyond = node, image = node;
        bool foreign = false;  // it leads into another block, from which nothing comes home
        for (int k = 0; k < dimension; ++k) {
          beyond[k] -= Set::velocity[q][k];
          if (beyond[k] >= 0 && beyond[k] < lattice.size(k)) continue;
          image[k] += Set::velocity[q][k] * lattice.size(k);
          foreign = foreign || !lattice.wraps(k);
        }
        if (!is_solid(beyond)) continue;
        T* const own = slot(q, node);
        links_.push_back({own, slot(Set::opposite[q], beyond), foreign ? own : slot(q, image), node[0], q});
      }
    }
  }
  first_.push_back(links_.size());
}

template class SolidLinks<float, D3Q19>;
template class SolidLinks<double, D3Q19>;

}  // namespace rouleau::core
