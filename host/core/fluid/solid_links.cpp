#include "solid_links.hpp"

#include <algorithm>

namespace rouleau::core {

namespace {

/// Calls function(node, q, share, plane) for the links over a wall from fluid nodes, by the velocities q that come back
/// along them: nodes of the lattice from `first` to `end` along x.
template <class Set, class Function>
void for_cut_links(const Domain<Set::dimension>& domain, const SolidNodes<Set::dimension>& solid,
                   const std::array<int, Set::dimension>& first, int end, Function function) {
  constexpr int dimension = Set::dimension;
  constexpr double half_way = 0.5;  // to a plane at the domain's end
  using Node = std::array<int, dimension>;
  const auto out_of_domain = [&](const Node& node) {
    bool out = false;
    for (int k = 0; k < dimension; ++k) out = out || (k != domain.open_axis && domain.wrapped(k, node[k]) < 0);
    return out;
  };
  const auto cut = [&](const Node& node, Node toward) {  // beyond an opening the section goes on
    if (const int k = domain.open_axis; k >= 0 && domain.wrapped(k, node[k] + toward[k]) < 0) toward[k] = 0;
    return solid.cut(node, toward);
  };
  for (Node node = first; node[0] < end; ++node[0]) {
    if (solid.at(node)) continue;
    for (int q = 1; q < Set::velocity_count; ++q) {
      Node toward, beyond, behind;
      for (int k = 0; k < dimension; ++k) {
        toward[k] = -Set::velocity[q][k];
        beyond[k] = node[k] + toward[k], behind[k] = node[k] - toward[k];
      }
      const bool plane = out_of_domain(beyond);
      if (plane ? !(cut(node, toward) < half_way) : !solid.at(domain, beyond)) continue;
      const bool alone = out_of_domain(behind) || solid.at(domain, behind);
      function(node, q, alone ? half_way : cut(node, toward), plane);
    }
  }
}

}  // namespace

template <class T, class Set>
SolidLinks<T, Set>::SolidLinks(const Lattice<T, Set>& lattice, const SolidNodes<dimension>& solid, double time) {
  using Node = std::array<int, dimension>;
  const Domain<dimension>& domain = lattice.domain();
  const auto factor = [](double share) { return (1 - 2 * share) / (1 + 2 * share); };
  const auto velocity_along = [&](const Node& node, int q) {  // of the wall
    Node toward;
    for (int k = 0; k < dimension; ++k) toward[k] = -Set::velocity[q][k];
    const Vec<dimension> velocity = time * solid.velocity(node, toward);
    double along = 0;
    for (int k = 0; k < dimension; ++k) along += Set::velocity[q][k] * velocity[k];
    return along;
  };
  // Walls that move along themselves give no mass to fluid that moves with them; links add up to some, which is taken
  // from all alike.
  double mass = 0, weights = 0;
  const Box<dimension> all{{}, domain.size};
  for (int i = 0; time != 0 && i < row_count(all); ++i) {
    const auto row = row_of(all, i);
    Node first{};
    std::copy(row.begin(), row.end(), first.begin() + 1);
    for_cut_links<Set>(domain, solid, first, domain.size[0], [&](const Node& node, int q, double share, bool) {
      const double along = velocity_along(node, q);
      mass += Set::weight[q] * along, weights += along != 0 ? Set::weight[q] * (1 + factor(share)) : 0;
    });
  }
  const RowPieces<dimension>& pieces = lattice.pieces();
  const int begin = domain.block.begin[0];
  for (std::size_t n = 0; n < pieces.first_piece(lattice.rows()); ++n) {
    first_.push_back(links_.size());
    const RowPiece& piece = pieces.piece(n);
    const auto row = lattice.row(piece.row);
    Node first{begin + piece.begin};
    for (int k = 1; k < dimension; ++k) first[k] = domain.block.begin[k] + row[k - 1];
    for_cut_links<Set>(domain, solid, first, begin + piece.end, [&](const Node& node, int q, double share, bool plane) {
      links_.push_back({.factor = static_cast<T>(factor(share)),
                        .left = 0,
                        .away = 0,
                        .x = node[0] - begin,
                        .q = static_cast<signed char>(q),
                        .w = static_cast<signed char>(Set::opposite[q]),
                        .plane = plane});
      if (weights == 0) return;
      const double along = velocity_along(node, q), own_along = along != 0 ? along - mass / weights : 0;
      given_.push_back(static_cast<T>(6 * Set::weight[q] * (1 + factor(share)) * own_along));
    });
  }
  first_.push_back(links_.size());
  for (std::size_t i = 0; i < given_.size(); ++i) links_[i].left = -given_[i];  // as restart() of populations of zero
  start_walls();
}

template class SolidLinks<float, D2Q9>;
template class SolidLinks<double, D2Q9>;
template class SolidLinks<float, D3Q19>;
template class SolidLinks<double, D3Q19>;

}  // namespace rouleau::core
