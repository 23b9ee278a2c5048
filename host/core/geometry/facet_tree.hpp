// Boxes in a tree: which of many things may be nearest to a place.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/domain/bounding_box.hpp"
#include "core/domain/vec.hpp"

namespace rouleau::core {

/// Halves of halves, by the middles of boxes along the longest side.
template <int D>
class FacetTree {
 public:
  /// At least one box.
  explicit FacetTree(const std::vector<BoundingBox<D>>& boxes) : order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    grow(boxes, 0, static_cast<int>(boxes.size()));
  }

  /// Calls `square = visit(i, square)` for boxes i that come nearer than the root of `square`, near halves first;
  /// `visit` returns the square of the least distance so far. Which order boxes that are as near come in does not
  /// depend on the place alone.
  template <class Visit>
  void nearest(const Vec<D>& place, double square, Visit visit) const {
    descend(place, 0, square, visit);
  }

 private:
  static constexpr int few = 4;
  struct Half {
    BoundingBox<D> box;
    int begin, end;  ///< of order_, where it has no halves
    int second;      ///< the first one follows; 0: none
  };

  int grow(const std::vector<BoundingBox<D>>& boxes, int begin, int end) {
    BoundingBox<D> around = boxes[order_[begin]];
    for (int i = begin + 1; i < end; ++i) {
      for (int k = 0; k < D; ++k) {
        around.least[k] = std::min(around.least[k], boxes[order_[i]].least[k]);
        around.most[k] = std::max(around.most[k], boxes[order_[i]].most[k]);
      }
    }
    const int own = static_cast<int>(halves_.size());
    halves_.push_back({around, begin, end, 0});
    if (end - begin <= few) return own;
    int longest = 0;
    for (int k = 1; k < D; ++k) {
      if (around.most[k] - around.least[k] > around.most[longest] - around.least[longest]) longest = k;
    }
    const auto middle = [&](int i) { return boxes[i].least[longest] + boxes[i].most[longest]; };
    const int half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](int a, int b) { return std::pair(middle(a), a) < std::pair(middle(b), b); });
    grow(boxes, begin, half);
    const int second = grow(boxes, half, end);
    halves_[own].second = second;
    return own;
  }

  [[nodiscard]] double square_to(const Vec<D>& place, const BoundingBox<D>& box) const {
    double square = 0;
    for (int k = 0; k < D; ++k) {
      const double away = std::max({box.least[k] - place[k], 0.0, place[k] - box.most[k]});
      square += away * away;
    }
    return square;
  }

  template <class Visit>
  void descend(const Vec<D>& place, int at, double& square, Visit& visit) const {
    const Half& half = halves_[at];
    if (half.second == 0) {
      for (int i = half.begin; i < half.end; ++i) square = visit(order_[i], square);
      return;
    }
    int near = at + 1, far = half.second;
    double to_near = square_to(place, halves_[near].box), to_far = square_to(place, halves_[far].box);
    if (to_far < to_near) std::swap(near, far), std::swap(to_near, to_far);
    if (to_near <= square) descend(place, near, square, visit);
    if (to_far <= square) descend(place, far, square, visit);
  }

  std::vector<int> order_;
  std::vector<Half> halves_;
};

}  // namespace rouleau::core
