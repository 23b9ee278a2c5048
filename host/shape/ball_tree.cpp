#include "ball_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rouleau::shape {

namespace {
constexpr int items_of_ball = 4;  ///< of a tree's smallest balls
}

BallTree::BallTree(const std::vector<Place<3>>& centers, const std::vector<double>& radii) : order_(centers.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  add(centers, radii, 0, static_cast<int>(order_.size()));
}

void BallTree::add(const std::vector<Place<3>>& centers, const std::vector<double>& radii, int first, int end) {
  Place<3> least = centers[order_[first]], most = least;
  for (int i = first; i < end; ++i) {
    for (int k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], centers[order_[i]][k]);
      most[k] = std::max(most[k], centers[order_[i]][k]);
    }
  }
  Ball ball{{}, 0, first, end, 0};
  for (int k = 0; k < 3; ++k) ball.center[k] = 0.5 * (least[k] + most[k]);
  for (int i = first; i < end; ++i) {
    const int item = order_[i];
    ball.radius = std::max(ball.radius, norm(minus(centers[item], ball.center)) + radii[item]);
  }
  const bool whole = end - first <= items_of_ball;
  if (!whole) ball.end = first;
  const std::size_t place = balls_.size();
  balls_.push_back(ball);
  if (!whole) {
    const Place<3> width = minus(most, least);
    const auto axis = std::max_element(width.begin(), width.end()) - width.begin();
    std::sort(order_.begin() + first, order_.begin() + end,
              [&](int a, int b) { return std::pair(centers[a][axis], a) < std::pair(centers[b][axis], b); });
    const int middle = first + (end - first) / 2;
    add(centers, radii, first, middle);
    add(centers, radii, middle, end);
  }
  balls_[place].next = balls_.size();
}

}  // namespace rouleau::shape
