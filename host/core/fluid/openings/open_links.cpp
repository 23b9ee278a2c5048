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
      : domain_(domain.in_one_block()),
        nodes_(domain),
        solid_(solid),
        opening_(opening),
        way_(end == 0 ? 1 : -1),
        viscosity_(viscosity) {
    place_ = end == 0 ? 0 : domain.size[nodes_.axis()] - 1;
    section_ = section_at(domain_, solid, walls, place_);
    if (opening.kind != Opening::Kind::velocity) return;
    // Links see the velocity between nodes; what they bring in all together is what was asked for.
    double wanted = 0, brought = 0;
    for (int i = 0; i < nodes_.count(); ++i) {
      const Node node = nodes_.node(i, place_);
      wanted += velocity(node);
      for (int q = 1; q < Set::velocity_count; ++q) brought += crosses(node, q) ? way_ * known(node, q) : 0;
    }
    if (brought != 0) scale_ = wanted / brought;
  }

  /// Of the outermost nodes, along the axis.
  [[nodiscard]] int place() const { return place_; }
  [[nodiscard]] bool of_pressure() const { return opening_.kind == Opening::Kind::pressure; }
  /// Whether velocity q comes to one of the outermost nodes through the opening.
  [[nodiscard]] bool crosses(const Node& node, int q) const {
    if (Set::velocity[q][nodes_.axis()] != way_) return false;
    const Node from = origin(node, q);
    if (std::any_of(from.begin(), from.end(), [](int place) { return place < 0; })) return false;
    return solid_ == nullptr || (!solid_->at(node) && !solid_->at(from));
  }
  [[nodiscard]] double known(const Node& node, int q) const {
    if (of_pressure())
      return 6 * Set::weight[q] * opening_.value + resistance(node, q) * section_.dragged[nodes_.number(node)];
    return 6 * Set::weight[q] * way_ * scale_ * (velocity(node) + velocity(origin(node, q))) / 2;
  }

  /// 6 w_q times the pressure between the node and the plane, half a spacing, for each velocity.
  [[nodiscard]] double resistance(const Node& node, int q) const {
    if (!of_pressure()) return 0;
    return 3 * Set::weight[q] * way_ * viscosity_ / section_.driven[nodes_.number(node)];
  }

  /// The velocity where a link crosses the plane: the node's times `rise`, and `drag`.
  struct Crossing {
    double rise = 1, drag = 0;
  };
  [[nodiscard]] Crossing crossing(const Node& node, int q) const {
    if (std::isinf(section_.mean_driven)) return {};
    const std::size_t here = nodes_.number(node), there = nodes_.number(origin(node, q));
    const double rise = (1 + section_.driven[there] / section_.driven[here]) / 2;
    return {rise, (section_.dragged[here] + section_.dragged[there]) / 2 - rise * section_.dragged[here]};
  }

 private:
  /// The outermost node beside that a link comes by; a coordinate of -1: it comes from a wall.
  [[nodiscard]] Node origin(Node node, int q) const {
    for (int k = 0; k < dimension; ++k)
      if (k != nodes_.axis()) node[k] = domain_.wrapped(k, node[k] - Set::velocity[q][k]);
    return node;
  }
  [[nodiscard]] double velocity(const Node& node) const {
    return section_.velocity(nodes_.number(node), opening_.value);
  }

  Domain<dimension> domain_;
  SectionNodes<dimension> nodes_;
  const SolidNodes<dimension>* solid_;
  Opening opening_;
  int way_, place_;
  double viscosity_;
  Section section_;
  double scale_ = 1;
};

}  // namespace

template <class T, class Set>
OpenLinks<T, Set>::OpenLinks(Lattice<T, Set>& lattice, const std::array<Opening, 2>& openings,
                             const SolidNodes<dimension>* solid, const WallVelocity& walls, const FlowThere& flow)
    : axis_(lattice.domain().flow_axis()), half_force_(static_cast<T>(flow.body_force / 2)) {
  const Domain<dimension>& domain = lattice.domain();
  std::vector<EndLinks<Set>> ends;
  if (domain.wall_below(axis_)) ends.emplace_back(domain, 0, openings[0], solid, walls, flow.viscosity);
  if (domain.wall_above(axis_)) ends.emplace_back(domain, 1, openings[1], solid, walls, flow.viscosity);
  for (int i = 0; i < lattice.rows(); ++i) {
    first_.push_back(links_.size());
    std::array<int, dimension> node = domain.block.begin;
    for (int k = 1; k < dimension; ++k) node[k] += lattice.row(i)[k - 1];
    for (const EndLinks<Set>& end : ends) {
      if (axis_ > 0 && node[axis_] != end.place()) continue;
      const int last = axis_ == 0 ? end.place() : domain.block.end[0] - 1;
      for (node[0] = axis_ == 0 ? last : domain.block.begin[0]; node[0] <= last; ++node[0])
        add(lattice, end, node, flow.inertia);
    }
  }
  first_.push_back(links_.size());
}

template <class T, class Set>
template <class End>
void OpenLinks<T, Set>::add(Lattice<T, Set>& lattice, const End& end, const std::array<int, dimension>& node,
                            bool inertia) {
  const Box<dimension>& block = lattice.domain().block;
  const int x = node[0] - block.begin[0];
  for (int q = 1; q < Set::velocity_count; ++q) {
    if (!end.crosses(node, q)) continue;
    typename Lattice<T, Set>::Row row{}, from{};
    for (int k = 1; k < dimension; ++k)
      row[k - 1] = node[k] - block.begin[k], from[k - 1] = row[k - 1] - Set::velocity[q][k];
    const int beyond = x - Set::velocity[q][0];
    T* const own = lattice.slot(q, row, x) + x;
    // Across x a row goes on beyond the opening. Rows at one end there, as beside a wall: nothing streams over it.
    T* const back = axis_ == 0 ? lattice.slot(Set::opposite[q], from, beyond) + beyond : own;
    links_.push_back({.own = own,
                      .back = back,
                      .known = static_cast<T>(end.known(node, q)),
                      .resistance = static_cast<T>(end.resistance(node, q)),
                      .convection = static_cast<T>(end.of_pressure() && inertia ? 6 * Set::weight[q] : 0),
                      .rise = static_cast<T>(end.crossing(node, q).rise),
                      .drag = static_cast<T>(end.crossing(node, q).drag),
                      .next = *own,
                      .held = 0,
                      .passed = 0,
                      .x = x,
                      .q = static_cast<signed char>(q),
                      .pressure = end.of_pressure()});
  }
}

template <class T, class Set>
void OpenLinks<T, Set>::before_collision(int i, const In& in) {
  int known = -1;
  T density = 0, velocity = 0;
  for (Link& link : of_row(i)) {
    if (!link.pressure) continue;
    if (known != link.x) {
      known = link.x, density = 0, velocity = half_force_;
      for (int q = 0; q < Set::velocity_count; ++q) {
        density += in[q][link.x];
        velocity += static_cast<T>(Set::velocity[q][axis_]) * in[q][link.x];
      }
    }
    const auto weight = static_cast<T>(2 * Set::weight[link.q]);
    link.held =
        (in[link.q][link.x] + in[Set::opposite[link.q]][link.x]) / 2 - weight * density - link.resistance * velocity;
    const T crossing = velocity * link.rise + link.drag;
    link.held += link.convection * (crossing * crossing - velocity * velocity);
  }
}

template class OpenLinks<float, D2Q9>;
template class OpenLinks<double, D2Q9>;
template class OpenLinks<float, D3Q19>;
template class OpenLinks<double, D3Q19>;

}  // namespace rouleau::core
