#include "mesh_weld.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>

namespace rouleau::shape {

int weld(core::TriangleSurface& surface, double distance) {
  const int count = static_cast<int>(surface.nodes.size());
  const auto is_known = [&](int node) { return node >= 0 && node < count; };
  if (!std::all_of(surface.triangles.begin(), surface.triangles.end(),
                   [&](const auto& t) { return std::all_of(t.begin(), t.end(), is_known); }))
    return 0;
  std::vector<int> order(count), first(count);
  std::iota(order.begin(), order.end(), 0);
  std::iota(first.begin(), first.end(), 0);
  const auto first_of = [&](int node) {
    while (first[node] != node) node = first[node] = first[first[node]];
    return node;
  };
  // Along a direction in which few nodes of any usual mesh are level.
  const core::Vec<3> direction = core::Vec<3>(0.4812, 0.6021, 0.6371).normalized();
  std::vector<std::array<double, 4>> key;
  for (const core::Vec<3>& at : surface.nodes) key.push_back({direction.dot(at), at.x(), at.y(), at.z()});
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::tie(key[a], a) < std::tie(key[b], b); });
  std::vector<int> different;  // one of each place, the first
  for (const int node : order) {
    if (!different.empty() && surface.nodes[different.back()] == surface.nodes[node])
      first[node] = different.back();
    else
      different.push_back(node);
  }
  long compared = 0;
  for (std::size_t a = 0; a < different.size() && distance > 0; ++a) {
    const core::Vec<3>& from = surface.nodes[different[a]];
    for (std::size_t b = a + 1; b < different.size(); ++b) {
      const core::Vec<3> way = surface.nodes[different[b]] - from;
      if (direction.dot(way) > distance) break;
      if (++compared > 1000L * count) throw std::invalid_argument("too many of its nodes lie at nearly the same place");
      if (!(way.norm() <= distance)) continue;
      const auto [lower, higher] = std::minmax({first_of(different[a]), first_of(different[b])});
      first[higher] = lower;
    }
  }
  std::vector<core::Vec<3>> nodes;
  std::vector<int> renamed(count);
  for (int i = 0; i < count; ++i) {
    const int kept = first_of(i);
    renamed[i] = kept == i ? static_cast<int>(nodes.size()) : renamed[kept];
    if (kept == i) nodes.push_back(surface.nodes[i]);
  }
  for (auto& triangle : surface.triangles) {
    for (int& node : triangle) node = renamed[node];
  }
  std::erase_if(surface.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  surface.nodes = std::move(nodes);
  return count - static_cast<int>(surface.nodes.size());
}

}  // namespace rouleau::shape
