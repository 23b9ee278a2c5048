#include "wall_reach.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/walls.hpp"
#include "core/geometry/formulas.hpp"

namespace rouleau::core {

template <int D>
WallReach<D>::WallReach(const Domain<D>& domain, const SolidNodes<D>& solid, const Region<D>& region, int of_stencil,
                        double time)
    : domain_(domain), points_(of_stencil), time_(time), region_(&region), around_(domain.block) {
  std::size_t count = 1;
  for (int k = 0; k < D; ++k) {
    around_.begin[k] -= points_ - 1, around_.end[k] += points_ - 1;
    count *= static_cast<std::size_t>(around_.size(k));
  }
  struct Image {
    Node node;        ///< of the lattice
    Vec<D> place;     ///< of the node itself, wrapped along periodic axes: so it is the same in all blocks
    double sign = 1;  ///< -1 beyond a plane wall, by that of the velocity there
  };
  const auto image = [&](std::size_t i) {
    Image found;
    for (int k = 0; k < D; ++k) {
      const auto size = static_cast<std::size_t>(around_.size(k));
      const int at = around_.begin[k] + static_cast<int>(i % size), wrapped = domain.wrapped(k, at);
      i /= size;
      const bool beyond = wrapped < 0;
      // A thin lattice has walls nearer to each other than a stencil is wide.
      found.node[k] = beyond ? std::clamp(mirrored(at, domain.size[k]), 0, domain.size[k] - 1) : wrapped;
      found.place[k] = beyond ? at : wrapped;
      if (beyond) found.sign = -found.sign;
    }
    return found;
  };
  solid_.resize(count);
  for (std::size_t i = 0; i < count; ++i) solid_[i] = solid.at(image(i).node) ? 1 : 0;
  touches_ = grown(solid_, true);
  const std::vector<char> reached = grown(touches_, false);
  const RegionPointer<D> between = between_walls(domain);
  const auto distance = [&](const Vec<D>& place) {
    return std::min(region.distance(place).value, between->distance(place).value);
  };
  distance_.resize(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (reached[i] == 0) continue;
    const Image at = image(i);
    Vec<D> of_node;
    for (int k = 0; k < D; ++k) of_node[k] = at.node[k];
    distance_[i] = solid_[i] != 0 ? distance(at.place) : at.sign * distance(of_node);
  }
}

template <int D>
std::vector<char> WallReach<D>::grown(std::vector<char> marks, bool down) const {
  std::ptrdiff_t stride = 1;
  for (int k = 0; k < D; ++k) {
    const int size = around_.size(k);
    std::vector<char> next(marks.size());
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (marks[i] == 0) continue;
      const int at = static_cast<int>(static_cast<std::ptrdiff_t>(i) / stride % size);
      const int steps = std::min(points_ - 1, down ? at : size - 1 - at);
      for (int step = 0; step <= steps; ++step)
        next[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + (down ? -step : step) * stride)] = 1;
    }
    marks = std::move(next);
    stride *= size;
  }
  return marks;
}

template <int D>
double WallReach<D>::factor(const Stencil& stencil) const {
  const auto [all, of_fluid] = sums(stencil, [this](std::size_t place) { return distance_[place]; });
  if (!(of_fluid > 0)) return 1;
  constexpr double most = 1.5;  // with weights that are negative in the solid
  return std::min(std::abs(all) / of_fluid, all > 0 ? most : 1);
}

template <int D>
Vec<D> WallReach<D>::carried(const Stencil& stencil, double factor) const {
  const double of_fluid = sums(stencil, [](std::size_t) { return 1; }).second;
  Vec<D> middle = Vec<D>::Zero();
  for (int k = 0; k < D; ++k)
    for (int i = 0; i < points_; ++i)
      middle[k] += stencil[k].weight[static_cast<std::size_t>(i)] * (stencil[k].first + i);
  return (1 - factor * of_fluid) * time_ * region_->velocity(middle);
}

template <int D>
void WallReach<D>::add_share(const std::array<double, D>& force, const Stencil& stencil, WallForceSums<D>& sums) const {
  using Sums = WallForceSums<D>;
  const double k = factor(stencil);
  double lower = 0, upper = 0, all = 0;
  for_rows(stencil, [&](const Node& row, std::size_t place, double of_row) {
    double sign = 1;
    for (int axis = 1; axis < D; ++axis)
      if (domain_.wrapped(axis, row[axis]) < 0) sign = -sign;
    for (int x = 0; x < points_; ++x) {
      const std::size_t at = static_cast<std::size_t>(x);
      const double weight = of_row * stencil[0].weight[at];
      all += solid_[place + at] != 0 ? weight : (1 - k * sign) * weight;
      // Beyond a wall across y the velocity is sign u - 2 sign u_wall, with u = 0 in the solid.
      if (domain_.wrapped(1, row[1]) < 0) (row[1] < 0 ? lower : upper) -= 2 * k * sign * weight;
    }
  });
  for (int axis = 0; axis < D; ++axis) {
    sums.add(Sums::lower, axis, lower * force[axis]);
    sums.add(Sums::upper, axis, upper * force[axis]);
    sums.add(Sums::other, axis, (all - lower - upper) * force[axis]);
  }
}

template class WallReach<2>;
template class WallReach<3>;

}  // namespace rouleau::core
