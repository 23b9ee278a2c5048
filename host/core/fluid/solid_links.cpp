#include "solid_links.hpp"

#include <algorithm>

namespace rouleau::core {

template <class T, class Set>
SolidLinks<T, Set>::SolidLinks(Lattice<T, Set>& lattice, const SolidNodes<dimension>& solid) {
  using Node = std::array<int, dimension>;
  const Domain<dimension>& domain = lattice.domain();
  const auto slot = [&](int q, const Node& node) {  // of a node around the block, counted from its first
    typename Lattice<T, Set>::Row row;
    std::copy(node.begin() + 1, node.end(), row.begin());
    return lattice.slot(q, row) + node[0];
  };
  const auto moved = [](Node node, const Node& by) {
    for (int k = 0; k < dimension; ++k) node[k] += by[k];
    return node;
  };
  constexpr double half_way = 0.5;  // to a plane at the domain's end
  const auto out_of_domain = [&](const Node& node) {
    bool out = false;
    for (int k = 1; k < dimension; ++k) out = out || domain.wrapped(k, node[k]) < 0;
    return out;
  };
  const auto cut = [&](const Node& node, Node toward) {  // beyond an opening the section goes on
    if (domain.wrapped(0, node[0] + toward[0]) < 0) toward[0] = 0;
    return solid.cut(node, toward);
  };
  for (int i = 0; i < lattice.rows(); ++i) {
    first_.push_back(links_.size());
    const auto row = lattice.row(i);
    Node x;
    std::copy(row.begin(), row.end(), x.begin() + 1);
    for (x[0] = 0; x[0] < lattice.size(0); ++x[0]) {
      const Node node = moved(x, domain.block.begin);
      if (solid.at(node)) continue;
      for (int q = 1; q < Set::velocity_count; ++q) {
        const int w = Set::opposite[q];
        Node away, toward;
        for (int k = 0; k < dimension; ++k) away[k] = Set::velocity[q][k], toward[k] = -away[k];
        const Node beyond = moved(node, toward), behind = moved(node, away);
        const bool plane = out_of_domain(beyond);
        if (plane ? !(cut(node, toward) < half_way) : !solid.at(domain, beyond)) continue;
        const bool alone = out_of_domain(behind) || solid.at(domain, behind);
        const double share = alone ? half_way : cut(node, toward);
        T* const own = slot(q, x);
        links_.push_back({.own = own,
                          .toward = slot(w, x),
                          .back = plane ? own : slot(w, moved(x, toward)),
                          .toward_streamed = slot(q, moved(x, away)),
                          .factor = static_cast<T>((1 - 2 * share) / (1 + 2 * share)),
                          .left = *own,
                          .away = *slot(w, x),
                          .x = x[0],
                          .q = static_cast<signed char>(q),
                          .plane = plane});
      }
    }
  }
  first_.push_back(links_.size());
}

template class SolidLinks<float, D2Q9>;
template class SolidLinks<double, D2Q9>;
template class SolidLinks<float, D3Q19>;
template class SolidLinks<double, D3Q19>;

}  // namespace rouleau::core
