#include "solid_links.hpp"

#include <algorithm>

namespace rouleau::core {

template <class T, class Set>
SolidLinks<T, Set>::SolidLinks(const Lattice<T, Set>& lattice, const SolidNodes<dimension>& solid) {
  using Node = std::array<int, dimension>;
  const Domain<dimension>& domain = lattice.domain();
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
  const RowPieces<dimension>& pieces = lattice.pieces();
  for (std::size_t n = 0; n < pieces.first_piece(lattice.rows()); ++n) {
    first_.push_back(links_.size());
    const RowPiece& piece = pieces.piece(n);
    const auto row = lattice.row(piece.row);
    Node x;
    std::copy(row.begin(), row.end(), x.begin() + 1);
    for (x[0] = piece.begin; x[0] < piece.end; ++x[0]) {
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
        links_.push_back({.factor = static_cast<T>((1 - 2 * share) / (1 + 2 * share)),
                          .left = 0,
                          .away = 0,
                          .x = x[0],
                          .q = static_cast<signed char>(q),
                          .w = static_cast<signed char>(w),
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
