#include "cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rouleau::core {

namespace {

constexpr int most_bins = 1024;  // along an axis: more would cost memory and save no time

double middle(double least, double most) { return 0.5 * (least + most); }

}  // namespace

CellGrid::Axis CellGrid::make_axis(double least, double most, double width, double period) {
  Axis axis;
  axis.periodic = period > 0;
  axis.origin = axis.periodic ? 0 : least;
  const double length = axis.periodic ? period : most - least;
  if (width > 0 && length > width)
    axis.count = static_cast<int>(std::min<double>(most_bins, std::floor(length / width)));
  if (length > 0) axis.width = length / axis.count;
  return axis;
}

int CellGrid::Axis::bin(double middle) const {
  const double place = std::floor((middle - origin) / width);
  if (!periodic) return static_cast<int>(std::clamp(place, 0.0, count - 1.0));
  const int rest = static_cast<int>(std::fmod(place, count));
  return rest < 0 ? rest + count : rest;
}

template <class Function>
void CellGrid::for_around(const Axis& axis, int bin, Function function) {
  if (axis.count <= 3) {
    for (int k = 0; k < axis.count; ++k) function(k);
    return;
  }
  for (int k = bin - 1; k <= bin + 1; ++k) {
    if (axis.periodic) {
      function((k + axis.count) % axis.count);
    } else if (k >= 0 && k < axis.count) {
      function(k);
    }
  }
}

CellGrid::CellGrid(const std::vector<Bounds>& bounds, double reach, const Domain<2>& domain) : bin_(bounds.size(), -1) {
  const double far = std::numeric_limits<double>::infinity();
  Bounds middles{far, -far, far, -far};
  double width = 0, height = 0;
  for (const Bounds& b : bounds) {
    if (!b.usable()) continue;
    const double x = middle(b.x_min, b.x_max), y = middle(b.y_min, b.y_max);
    middles = {std::min(middles.x_min, x), std::max(middles.x_max, x), std::min(middles.y_min, y),
               std::max(middles.y_max, y)};
    width = std::max(width, b.x_max - b.x_min);
    height = std::max(height, b.y_max - b.y_min);
  }
  // Room for rounding: a pair at exactly the reach must not fall between two bins.
  const double room = reach * (1 + 1e-9) + 1e-6;
  x_ = make_axis(middles.x_min, middles.x_max, width + room, domain.period(0));
  y_ = make_axis(middles.y_min, middles.y_max, height + room, domain.period(1));

  begin_.assign(static_cast<std::size_t>(x_.count) * y_.count + 1, 0);
  for (std::size_t c = 0; c < bounds.size(); ++c) {
    const Bounds& b = bounds[c];
    if (!b.usable()) continue;
    bin_[c] = y_.bin(middle(b.y_min, b.y_max)) * x_.count + x_.bin(middle(b.x_min, b.x_max));
    ++begin_[static_cast<std::size_t>(bin_[c]) + 1];
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  cells_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t c = 0; c < bounds.size(); ++c) {
    if (bin_[c] >= 0) cells_[next[bin_[c]]++] = static_cast<int>(c);
  }
}

void CellGrid::find(int cell, std::vector<int>& near) const {
  near.clear();
  const int own = bin_[cell];
  if (own < 0) return;
  for_around(y_, own / x_.count, [&](int y) {
    for_around(x_, own % x_.count, [&](int x) {
      const auto bin = static_cast<std::size_t>(y * x_.count + x);
      near.insert(near.end(), cells_.begin() + begin_[bin], cells_.begin() + begin_[bin + 1]);
    });
  });
}

}  // namespace rouleau::core
