#include "open_links.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "section.hpp"

namespace rouleau::core {

namespace {

/// The links that cross the plane of one end, by the node of the whole lattice that they come to.
template <class Set>
class EndLinks {
 public:
  static constexpr int dimension = Set::dimension;
  using Node = std::array<int, dimension>;

  EndLinks(const Domain<dimension>& domain, int end, const Opening& opening, const SolidNodes<dimension>* solid,
           const WallVelocity& walls, double viscosity)
      : domain_(domain.size, domain.periodic),
        solid_(solid),
        opening_(opening),
        way_(end == 0 ? 1 : -1),
        viscosity_(viscosity) {
    column_ = end == 0 ? 0 : domain.size[0] - 1;
    section_ = section_at(domain_, solid, walls, column_);
    if (opening.kind != Opening::Kind::velocity) return;
    // Links see the velocity between nodes; what they bring in all together is what was asked for.
    double wanted = 0, brought = 0;
    for (int i = 0; i < row_count(domain_.block); ++i) {
      Node node{column_};
      const auto row = row_of(domain_.block, i);
      std::copy(row.begin(), row.end(), node.begin() + 1);
      wanted += velocity(node);
      for (int q = 1; q < Set::velocity_count; ++q) brought += crosses(node, q) ? way_ * known(node, q) : 0;
    }
    if (brought != 0) scale_ = wanted / brought;
  }

  [[nodiscard]] int column() const { return column_; }
  /// Whether velocity q comes to a node of the column through the opening.
  [[nodiscard]] bool crosses(const Node& node, int q) const {
    if (Set::velocity[q][0] != way_) return false;
    const Node from = origin(node, q);
    if (std::any_of(from.begin(), from.end(), [](int place) { return place < 0; })) return false;
    return solid_ == nullptr || (!solid_->at(node) && !solid_->at(from));
  }
  [[nodiscard]] double known(const Node& node, int q) const {
    if (opening_.kind == Opening::Kind::pressure)
      return 6 * Set::weight[q] * opening_.value + resistance(node, q) * section_.dragged[row_number(node)];
    return 6 * Set::weight[q] * way_ * scale_ * (velocity(node) + velocity(origin(node, q))) / 2;
  }

  /// 6 w_q times the pressure between the node and the plane, half a spacing, for each velocity.
  [[nodiscard]] double resistance(const Node& node, int q) const {
    if (opening_.kind != Opening::Kind::pressure) return 0;
    return 3 * Set::weight[q] * way_ * viscosity_ / section_.driven[row_number(node)];
  }

  /// The velocity where a link crosses the plane: the node's times `rise`, and `drag`.
  struct Crossing {
    double rise = 1, drag = 0;
  };
  [[nodiscard]] Crossing crossing(const Node& node, int q) const {
    if (std::isinf(section_.mean_driven)) return {};
    const std::size_t here = row_number(node), there = row_number(origin(node, q));
    const double rise = (1 + section_.driven[there] / section_.driven[here]) / 2;
    return {rise, (section_.dragged[here] + section_.dragged[there]) / 2 - rise * section_.dragged[here]};
  }

 private:
  /// The node beside, in the column, that a link comes by; a coordinate of -1: it comes from a wall.
  [[nodiscard]] Node origin(Node node, int q) const {
    for (int k = 1; k < dimension; ++k) node[k] = domain_.wrapped(k, node[k] - Set::velocity[q][k]);
    return node;
  }
  [[nodiscard]] double velocity(const Node& node) const { return section_.velocity(row_number(node), opening_.value); }
  [[nodiscard]] std::size_t row_number(const Node& node) const {
    std::size_t row = 0;
    for (int k = dimension - 1; k > 0; --k)
      row = row * static_cast<std::size_t>(domain_.size[k]) + static_cast<std::size_t>(node[k]);
    return row;
  }

  Domain<dimension> domain_;
  const SolidNodes<dimension>* solid_;
  Opening opening_;
  int way_, column_;
  double viscosity_;
  Section section_;
  double scale_ = 1;
};

}  // namespace

template <class T, class Set>
OpenLinks<T, Set>::OpenLinks(Lattice<T, Set>& lattice, const std::array<Opening, 2>& openings,
                             const SolidNodes<dimension>* solid, const WallVelocity& walls, const FlowThere& flow)
    : half_force_(static_cast<T>(flow.body_force_x / 2)) {
  const Domain<dimension>& domain = lattice.domain();
  std::vector<EndLinks<Set>> ends;
  if (domain.wall_below(0)) ends.emplace_back(domain, 0, openings[0], solid, walls, flow.viscosity);
  if (domain.wall_above(0)) ends.emplace_back(domain, 1, openings[1], solid, walls, flow.viscosity);
  for (int i = 0; i < lattice.rows(); ++i) {
    first_.push_back(links_.size());
    const auto row = lattice.row(i);
    for (std::size_t end = 0; end < ends.size(); ++end) {
      std::array<int, dimension> node{ends[end].column()};
      for (int k = 1; k < dimension; ++k) node[k] = domain.block.begin[k] + row[k - 1];
      const int x = node[0] - domain.block.begin[0];
      for (int q = 1; q < Set::velocity_count; ++q) {
        if (!ends[end].crosses(node, q)) continue;
        auto from = row;
        for (int k = 1; k < dimension; ++k) from[k - 1] -= Set::velocity[q][k];
        const int beyond = x - Set::velocity[q][0];
        T* const own = lattice.slot(q, row, x) + x;
        const bool pressure = openings[domain.wall_below(0) ? end : 1].kind == Opening::Kind::pressure;
        links_.push_back({.own = own,
                          .back = lattice.slot(Set::opposite[q], from, beyond) + beyond,
                          .known = static_cast<T>(ends[end].known(node, q)),
                          .resistance = static_cast<T>(ends[end].resistance(node, q)),
                          .convection = static_cast<T>(pressure && flow.inertia ? 6 * Set::weight[q] : 0),
                          .rise = static_cast<T>(ends[end].crossing(node, q).rise),
                          .drag = static_cast<T>(ends[end].crossing(node, q).drag),
                          .next = *own,
                          .held = 0,
                          .x = x,
                          .q = static_cast<signed char>(q),
                          .pressure = pressure});
      }
    }
  }
  first_.push_back(links_.size());
}

template <class T, class Set>
void OpenLinks<T, Set>::before_collision(int i, const In& in) {
  int known = -1;
  T density = 0, velocity = 0;
  for_row(i, [&](Link& link) {
    if (!link.pressure) return;
    if (known != link.x) {
      known = link.x, density = 0, velocity = half_force_;
      for (int q = 0; q < Set::velocity_count; ++q) {
        density += in[q][link.x];
        velocity += static_cast<T>(Set::velocity[q][0]) * in[q][link.x];
      }
    }
    const auto weight = static_cast<T>(2 * Set::weight[link.q]);
    link.held =
        (in[link.q][link.x] + in[Set::opposite[link.q]][link.x]) / 2 - weight * density - link.resistance * velocity;
    const T crossing = velocity * link.rise + link.drag;
    link.held += link.convection * (crossing * crossing - velocity * velocity);
  });
}

template class OpenLinks<float, D2Q9>;
template class OpenLinks<double, D2Q9>;
template class OpenLinks<float, D3Q19>;
template class OpenLinks<double, D3Q19>;

}  // namespace rouleau::core
