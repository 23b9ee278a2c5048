#include "vessel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/fluid/solid_nodes.hpp"

namespace rouleau::shape {

namespace {

/// Of a box, down to parts no larger than a spacing, which a wall is taken to cut in a plane.
template <int D>
double content_of(const core::Region<D>& region, const core::Vec<D>& lower, const core::Vec<D>& size, double spacing) {
  const double value = region.distance(lower + size / 2).value, reach = size.norm() / 2;
  if (std::abs(value) >= reach) return value > 0 ? size.prod() : 0;
  const double largest = size.maxCoeff();
  if (largest <= spacing) return size.prod() * std::clamp(0.5 + value / largest, 0.0, 1.0);
  double sum = 0;
  core::Vec<D> part = size;
  for (int k = 0; k < D; ++k) part[k] = size[k] > spacing ? size[k] / 2 : size[k];
  for (int i = 0; i < (1 << D); ++i) {
    core::Vec<D> corner = lower;
    bool there = true;
    for (int k = 0; k < D; ++k) {
      if ((i >> k & 1) == 0) continue;
      there = there && part[k] < size[k];
      corner[k] += part[k];
    }
    if (there) sum += content_of(region, corner, part, spacing);
  }
  return sum;
}

template <int D>
double content_between(const scene::Domain& domain, const scene::Vector& lower, const scene::Vector& upper) {
  return content_of<D>(*domain.region<D>(), lower.in<D>(), (upper - lower).in<D>(), domain.size.x() / domain.nodes[0]);
}

}  // namespace

double fluid_content(const scene::Domain& domain, const scene::Vector& lower, const scene::Vector& upper) {
  bool whole = true;
  for (int k = 0; k < domain.dimension(); ++k) whole = whole && lower[k] <= 0 && upper[k] >= domain.size[k];
  if (whole) return domain.content();
  return domain.dimension() == 3 ? content_between<3>(domain, lower, upper) : content_between<2>(domain, lower, upper);
}

template <int D>
std::vector<std::array<double, D>> wall_pieces(const scene::Domain& domain) {
  using Node = std::array<int, D>;
  const double spacing = domain.size.x() / domain.nodes[0];
  Node size;
  std::array<bool, D> periodic;
  std::copy_n(domain.nodes.begin(), D, size.begin());
  std::copy_n(domain.periodic.begin(), D, periodic.begin());
  const core::Domain<D> lattice(size, periodic);
  const auto place_of = [&](const Node& node) {
    core::Vec<D> place;
    for (int k = 0; k < D; ++k) place[k] = (node[k] + 0.5) * spacing;
    return place;
  };
  const auto depth = [&](const Node& node) { return -domain.region<D>()->distance(place_of(node)).value; };
  const core::SolidNodes<D> solid(size, [&](const Node& node) { return depth(node) >= 0; });
  std::vector<bool> seen(static_cast<std::size_t>(lattice.nodes()));
  const auto first_visit = [&](const Node& node) {
    std::size_t number = 0;
    for (int k = D - 1; k >= 0; --k)
      number = number * static_cast<std::size_t>(size[k]) + static_cast<std::size_t>(node[k]);
    if (seen[number] || !solid.at(node)) return false;
    return seen[number] = true, true;
  };
  std::vector<std::array<double, D>> pieces;
  std::vector<Node> waiting;
  for (long i = 0; i < lattice.nodes(); ++i) {
    Node node;
    long rest = i;
    for (int k = 0; k < D; rest /= size[k++]) node[k] = static_cast<int>(rest % size[k]);
    if (!first_visit(node)) continue;
    Node deepest = node;
    double most = depth(node);
    for (waiting = {node}; !waiting.empty();) {
      const Node here = waiting.back();
      waiting.pop_back();
      if (const double deep = depth(here); deep > most) most = deep, deepest = here;
      for (int side = 0; side < 2 * D; ++side) {
        Node next = here;
        next[side / 2] = lattice.wrapped(side / 2, here[side / 2] + (side % 2 == 0 ? 1 : -1));
        if (next[side / 2] >= 0 && first_visit(next)) waiting.push_back(next);
      }
    }
    std::array<double, D>& piece = pieces.emplace_back();
    for (int k = 0; k < D; ++k) piece[k] = (deepest[k] + 0.5) * spacing;
  }
  return pieces;
}
template std::vector<std::array<double, 2>> wall_pieces<2>(const scene::Domain&);
template std::vector<std::array<double, 3>> wall_pieces<3>(const scene::Domain&);

}  // namespace rouleau::shape
