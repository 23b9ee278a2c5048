#include "middle_sections.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rouleau::files {

namespace {

using Edge = std::pair<int, int>;  // nodes, the smaller number first

struct Point {
  double x, y, tension;
};

/// The loops in which the plane cuts a surface, each as the edges that it goes through one after another.
std::vector<std::vector<Edge>> loops_of(const std::vector<std::array<int, 3>>& triangles, const std::vector<double>& z,
                                        double plane) {
  std::map<Edge, std::vector<Edge>> next;
  const auto above = [&](int node) { return z[node] >= plane; };
  for (const auto& corners : triangles) {
    std::vector<Edge> crossed;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      if (above(a) != above(b)) crossed.emplace_back(std::minmax(a, b));
    }
    if (crossed.size() != 2) continue;
    next[crossed[0]].push_back(crossed[1]);
    next[crossed[1]].push_back(crossed[0]);
  }
  std::vector<std::vector<Edge>> loops;
  while (!next.empty()) {
    std::vector<Edge>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      const std::vector<Edge> ways = std::move(at->second);
      loop.push_back(at->first);
      next.erase(at);
      at = next.end();
      for (const Edge& way : ways)
        if (at == next.end()) at = next.find(way);
    }
  }
  return loops;
}

double length_of(const std::vector<Point>& loop) {
  double length = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point &a = loop[i], &b = loop[(i + 1) % loop.size()];
    length += std::hypot(b.x - a.x, b.y - a.y);
  }
  return length;
}

/// Counter-clockwise, from the point farthest along x on.
void arrange(std::vector<Point>& loop) {
  double twice_area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point &a = loop[i], &b = loop[(i + 1) % loop.size()];
    twice_area += a.x * b.y - a.y * b.x;
  }
  if (twice_area < 0) std::reverse(loop.begin(), loop.end());
  const auto first =
      std::max_element(loop.begin(), loop.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
  std::rotate(loop.begin(), first, loop.end());
}

}  // namespace

observe::OutlineSnapshot middle_sections(const observe::OutlineSnapshot& s, int points) {
  observe::OutlineSnapshot sections;
  sections.cell = s.cell;
  sections.first.push_back(0);
  auto triangle = s.triangles.begin();
  for (std::size_t cell = 0; cell + 1 < s.first.size(); ++cell) {
    const int begin = s.first[cell], end = s.first[cell + 1];
    std::vector<std::array<int, 3>> own;
    for (; triangle != s.triangles.end() && (*triangle)[0] < end; ++triangle) own.push_back(*triangle);
    const auto [least, most] = std::minmax_element(s.z.begin() + begin, s.z.begin() + end);
    std::vector<Point> longest{{s.x[begin], s.y[begin], 0}};  // of what has blown up
    const double plane = (*least + *most) / 2;
    for (const std::vector<Edge>& edges : loops_of(own, s.z, plane)) {
      std::vector<Point> loop;
      for (const Edge& edge : edges) {
        const int a = edge.first, b = edge.second;
        const double share = (plane - s.z[a]) / (s.z[b] - s.z[a]);
        const auto between = [&](const std::vector<double>& values) {
          return values[a] + share * (values[b] - values[a]);
        };
        loop.push_back({between(s.x), between(s.y), between(s.tension)});
      }
      if (length_of(loop) > length_of(longest)) longest = std::move(loop);
    }
    arrange(longest);
    const double step = length_of(longest) / points;
    double passed = 0;  // from the first point to the present one
    std::size_t at = 0;
    for (int i = 0; i < points; ++i) {
      const auto piece = [&] {
        const Point &a = longest[at % longest.size()], &b = longest[(at + 1) % longest.size()];
        return std::hypot(b.x - a.x, b.y - a.y);
      };
      while (at + 1 < longest.size() && passed + piece() < i * step) passed += piece(), ++at;
      const Point &a = longest[at], &b = longest[(at + 1) % longest.size()];
      const double share = piece() > 0 ? std::clamp((i * step - passed) / piece(), 0.0, 1.0) : 0;
      sections.x.push_back(a.x + share * (b.x - a.x));
      sections.y.push_back(a.y + share * (b.y - a.y));
      sections.tension.push_back(a.tension + share * (b.tension - a.tension));
    }
    sections.first.push_back(static_cast<int>(sections.x.size()));
  }
  return sections;
}

}  // namespace rouleau::files
