// Cells that overlap for certain, found by their centres before any of them is placed.
#pragma once

#include <optional>
#include <vector>

#include "rigid_body.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// Balls within balls, each around a part of a set of points or triangles.
class BallTree {
 public:
  /// Of items whose balls these are.
  BallTree() = default;
  BallTree(const std::vector<Place<3>>& centers, const std::vector<double>& radii);

  /// Whether visit(item) holds for all items, in an order that the tree has; those within a ball for which
  /// skip(center, radius) holds are not asked.
  template <class Skip, class Visit>
  bool all(const Skip& skip, const Visit& visit) const {
    // Balls stand before those within them, so that `next` is where to go on behind all of these.
    for (std::size_t k = 0; k < balls_.size();) {
      const Ball& ball = balls_[k];
      if (skip(ball.center, ball.radius)) {
        k = ball.next;
        continue;
      }
      for (int i = ball.first; i < ball.end; ++i) {
        if (!visit(order_[i])) return false;
      }
      ++k;
    }
    return true;
  }

 private:
  struct Ball {
    Place<3> center;
    double radius;
    int first, end;  ///< in order_: its items; none if it has balls
    std::size_t next;
  };
  void add(const std::vector<Place<3>>& centers, const std::vector<double>& radii, int first, int end);

  std::vector<int> order_;
  std::vector<Ball> balls_;
};

struct CrowdedPair {
  int cell, other;  ///< indices into Scene::cells
  double distance;  ///< between their centres, or those of their images, m
};

/// Two cells whose centres are nearer than the circles around them that fit into the cells allow. Takes time and memory
/// for the centres alone, so that a million cells on top of each other are found at once.
std::optional<CrowdedPair> find_crowded_pair(const scene::Scene& scene);

}  // namespace rouleau::shape
