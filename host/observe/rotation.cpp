#include "rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <tuple>

namespace rouleau::observe {

namespace {

/// Shift of every cell that brings it beside its neighbours in the aggregate; the cell with the smallest index stays.
struct Unwrapping {
  std::vector<core::ImageShift> shift;  ///< of each of the cells that there are
  std::set<int> endless;  ///< labels: some way along the contacts leads back to an image of where it began
};

Unwrapping unwrap(const std::vector<CellContact>& contacts, const Aggregates& aggregates) {
  const std::size_t cells = aggregates.label.size();
  struct Step {
    std::size_t to;
    core::ImageShift image;
  };
  std::vector<std::vector<Step>> steps(cells);
  for (const CellContact& c : contacts) {
    const std::size_t a = place_of(c.cell_a, aggregates.cells), b = place_of(c.cell_b, aggregates.cells);
    steps[a].push_back({b, c.image});
    steps[b].push_back({a, -c.image});
  }
  Unwrapping result{std::vector<core::ImageShift>(cells), {}};
  std::vector<bool> reached(cells, false);
  for (std::size_t root = 0; root < cells; ++root) {
    if (reached[root]) continue;
    reached[root] = true;
    for (std::vector<std::size_t> open{root}; !open.empty();) {
      const std::size_t cell = open.back();
      open.pop_back();
      for (const Step& step : steps[cell]) {
        const core::ImageShift own = result.shift[cell], there{own.x + step.image.x, own.y + step.image.y};
        if (!reached[step.to]) {
          reached[step.to] = true;
          result.shift[step.to] = there;
          open.push_back(step.to);
        } else if (!(result.shift[step.to] == there)) {
          result.endless.insert(aggregates.label[cell]);
        }
      }
    }
  }
  return result;
}

/// Indices of points among which the two are that lie farthest apart, in their order: the corners of the convex hull,
/// by its lower and its upper chain (Andrew 1979), and all of few.
std::vector<std::size_t> outermost(const std::vector<Eigen::Vector2d>& points) {
  constexpr std::size_t few = 32;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (points.size() <= few) return order;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::tuple(points[i].x(), points[i].y(), i) < std::tuple(points[j].x(), points[j].y(), j);
  });
  std::vector<std::size_t> corners;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t first = corners.size();
    for (auto next = begin; next != end; ++next) {
      const auto turns_back = [&] {
        const Eigen::Vector2d &a = points[corners.end()[-2]], &b = points[corners.back()];
        const Eigen::Vector2d along = b - a, on = points[*next] - b;
        return along.x() * on.y() - along.y() * on.x() <= 0;
      };
      while (corners.size() >= first + 2 && turns_back()) corners.pop_back();
      corners.push_back(*next);
    }
  };
  add_chain(order.begin(), order.end());
  add_chain(order.rbegin(), order.rend());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Angle of the line through the two points that lie farthest apart, in (-pi/2, pi/2].
double angle_of_longest(const std::vector<Eigen::Vector2d>& all) {
  std::vector<Eigen::Vector2d> points;
  for (const std::size_t i : outermost(all)) points.push_back(all[i]);
  Eigen::Vector2d longest = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const Eigen::Vector2d line = points[j] - points[i];
      if (line.squaredNorm() > longest.squaredNorm()) longest = line;
    }
  }
  const double angle = std::atan2(longest.y(), longest.x());
  if (angle > std::numbers::pi / 2) return angle - std::numbers::pi;
  return angle <= -std::numbers::pi / 2 ? angle + std::numbers::pi : angle;
}

}  // namespace

std::map<int, double> Rotation::follow(const std::vector<CellContact>& contacts, const Aggregates& aggregates,
                                       const std::vector<Eigen::Vector2d>& centers, const core::Domain<2>& domain) {
  const Unwrapping unwrapped = unwrap(contacts, aggregates);
  std::map<int, std::vector<int>> members;
  for (std::size_t i = 0; i < aggregates.label.size(); ++i) members[aggregates.label[i]].push_back(aggregates.cells[i]);
  std::map<int, double> angles;
  std::map<std::vector<int>, double> now;
  for (auto& [label, cells] : members) {
    if (cells.size() < 2 || unwrapped.endless.contains(label)) continue;
    std::vector<Eigen::Vector2d> points;
    for (const int cell : cells) {
      const std::size_t k = place_of(cell, aggregates.cells);
      const Eigen::Vector2d shift(unwrapped.shift[k].x * domain.period(0), unwrapped.shift[k].y * domain.period(1));
      points.emplace_back(centers[k] + shift);
    }
    double angle = angle_of_longest(points);
    const auto before = last_.find(cells);
    if (before != last_.end()) angle += std::numbers::pi * std::round((before->second - angle) / std::numbers::pi);
    angles[label] = angle;
    now.emplace(std::move(cells), angle);
  }
  last_ = std::move(now);
  return angles;
}

double largest_rotation(const Snapshot& snapshot) {
  std::map<int, int> sizes;
  for (const CellSnapshot& cell : snapshot.cells) ++sizes[cell.aggregate];
  int most = 0, largest = -1;
  for (const auto& [label, size] : sizes) {
    if (size <= most) continue;
    most = size;
    largest = label;
  }
  const auto found = snapshot.rotation.find(largest);
  return found != snapshot.rotation.end() ? found->second : std::nan("");
}

}  // namespace rouleau::observe
