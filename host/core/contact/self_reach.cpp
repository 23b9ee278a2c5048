#include "self_reach.hpp"

#include <algorithm>
#include <numbers>
#include <queue>

namespace rouleau::core {

namespace {

struct Way {
  int to;
  double length;
};

/// From each node: along its edges, and across the edges that lie opposite to it, in a straight line over both
/// triangles.
std::vector<std::vector<Way>> ways_of(const RestSurface& rest) {
  const Mesh& mesh = rest.mesh;
  const auto edge_length = [&](int i, int j) { return (rest.nodes()[i] - rest.nodes()[j]).norm(); };
  std::vector<std::vector<Way>> ways(static_cast<std::size_t>(mesh.node_count()));
  const auto join = [&](int i, int j, double length) {
    ways[i].push_back({j, length});
    ways[j].push_back({i, length});
  };
  for (const Mesh::Edge& edge : mesh.edges()) {
    const double along = edge_length(edge.a, edge.b);
    join(edge.a, edge.b, along);
    const auto opposite = [&](int triangle) {
      const auto& [i, j, k] = mesh.triangles()[triangle];
      return i != edge.a && i != edge.b ? i : (j != edge.a && j != edge.b ? j : k);
    };
    const int left = opposite(edge.left), right = opposite(edge.right);
    // Both triangles unfolded into a plane: a at 0, b at `along`, the other corners above and below.
    const auto unfolded = [&](int corner) {
      const double from_a = edge_length(edge.a, corner), from_b = edge_length(edge.b, corner);
      const double x = (from_a * from_a - from_b * from_b + along * along) / (2 * along);
      return std::pair{x, std::sqrt(std::max(0.0, from_a * from_a - x * x))};
    };
    const auto [left_x, left_y] = unfolded(left);
    const auto [right_x, right_y] = unfolded(right);
    const double crossing = left_x + (right_x - left_x) * left_y / (left_y + right_y);
    if (crossing > 0 && crossing < along) join(left, right, std::hypot(right_x - left_x, left_y + right_y));
  }
  return ways;
}

}  // namespace

SelfReach::SelfReach(const RestSurface& rest, double cutoff)
    : cutoff_(cutoff),
      triangles_(static_cast<std::size_t>(rest.mesh.triangle_count())),
      allowed_(static_cast<std::size_t>(rest.mesh.node_count()) * triangles_, true) {
  constexpr double too_long = 1.04;
  const double apart = too_long * std::numbers::pi / 2 * cutoff;
  const std::vector<std::vector<Way>> ways = ways_of(rest);
  const Mesh::Rings& corners = rest.mesh.corners();
  using Reached = std::pair<double, int>;  // how far, and which node
  std::vector<double> distance(ways.size(), apart);
  std::vector<int> near;
  for (int node = 0; node < rest.mesh.node_count(); ++node) {
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
    distance[node] = 0;
    near.assign(1, node);
    next.emplace(0, node);
    while (!next.empty()) {
      const auto [far, at] = next.top();
      next.pop();
      if (far > distance[at]) continue;
      for (const auto& [to, length] : ways[at]) {
        if (!(far + length < distance[to])) continue;
        if (distance[to] == apart) near.push_back(to);
        distance[to] = far + length;
        next.emplace(distance[to], to);
      }
    }
    for (const int i : near) {
      for (int c = corners.first[i]; c < corners.first[i + 1]; ++c)
        allowed_[static_cast<std::size_t>(node) * triangles_ + static_cast<std::size_t>(corners.entry[c] / 3)] = false;
      distance[i] = apart;
    }
  }
}

}  // namespace rouleau::core
