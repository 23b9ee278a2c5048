// The box around some points of the lattice's space, and how near two of them come over periodic borders.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "domain.hpp"

namespace rouleau::core {

template <int D>
struct BoundingBox {
  std::array<double, D> least, most;

  /// Of no known place; not usable.
  static BoundingBox unknown() {
    BoundingBox box;
    box.least.fill(std::numeric_limits<double>::quiet_NaN());
    box.most = box.least;
    return box;
  }

  /// False for the positions of a simulation that has just blown up (not finite, or absurdly large). The checks of the
  /// run will report them; until then nothing may crash or hang on them.
  [[nodiscard]] bool usable() const {
    constexpr double far = 1e9, large = 1e5;
    for (int k = 0; k < D; ++k) {
      if (!(least[k] > -far && most[k] < far && most[k] - least[k] < large)) return false;
    }
    return true;
  }
};

/// The largest of the distances along the axes of a box and the nearest image of another. Who asks for (b, a) gets the
/// same bits only if both ask in one order.
template <int D>
double distance_along_axes(const BoundingBox<D>& a, const BoundingBox<D>& b, const Domain<D>& domain) {
  double largest = 0;
  for (int k = 0; k < D; ++k) {
    double between;
    if (const double period = domain.period(k); period > 0) {
      const double whole = b.least[k] - a.least[k], start = whole - period * std::floor(whole / period);
      const double above = start - (a.most[k] - a.least[k]), below = period - start - (b.most[k] - b.least[k]);
      between = std::min(above, below);
    } else {
      between = std::max(b.least[k] - a.most[k], a.least[k] - b.most[k]);
    }
    largest = std::max(largest, between);
  }
  return largest;
}

/// The nodes of the lattice that lie within a reach of a box, along the first axis in whole groups of so many nodes: in
/// one box for each part over a periodic border; beyond walls there are none, and what has left the domain is taken for
/// the nodes beside the wall. Calls function(Box).
template <int D, class Function>
void for_nodes_near(const BoundingBox<D>& box, double reach, int group, const Domain<D>& domain, Function function) {
  Box<D> part[2];  // along each axis, and whether there is a second one
  bool two[D];
  for (int k = 0; k < D; ++k) {
    const int size = domain.size[k], grain = k == 0 ? group : 1;
    int begin = static_cast<int>(std::floor(box.least[k] - reach)),
        end = static_cast<int>(std::ceil(box.most[k] + reach)) + 1;
    two[k] = false;
    if (domain.periodic[k] && end - begin < size) {
      const int shift = domain.wrapped(k, begin) - begin;
      begin += shift, end += shift;
      two[k] = end > size;
      part[1].begin[k] = 0, part[1].end[k] = std::min((end - size + grain - 1) / grain * grain, size);
    } else if (domain.periodic[k]) {
      begin = 0, end = size;
    } else {
      begin = std::clamp(begin, 0, size - 1), end = std::clamp(end, begin + 1, size);
    }
    part[0].begin[k] = begin / grain * grain;
    part[0].end[k] = std::min((end + grain - 1) / grain * grain, size);
  }
  for (int which = 0; which < (1 << D); ++which) {
    Box<D> product;
    bool there = true;
    for (int k = 0; k < D; ++k) {
      const int second = which >> k & 1;
      there = there && (second == 0 || two[k]);
      product.begin[k] = part[second].begin[k], product.end[k] = part[second].end[k];
    }
    if (there) function(product);
  }
}

}  // namespace rouleau::core
