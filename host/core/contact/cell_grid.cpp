#include "cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rouleau::core {

namespace {

double middle(double least, double most) { return 0.5 * (least + most); }

}  // namespace

template <int D>
typename CellGrid<D>::Axis CellGrid<D>::make_axis(double least, double most, double width, double period) {
  constexpr int most_bins = D == 2 ? 1024 : 128;  // more would cost memory and save no time
  Axis axis;
  axis.periodic = period > 0;
  axis.origin = axis.periodic ? 0 : least;
  const double length = axis.periodic ? period : most - least;
  if (width > 0 && length > width)
    axis.count = static_cast<int>(std::min<double>(most_bins, std::floor(length / width)));
  if (length > 0) axis.width = length / axis.count;
  return axis;
}

template <int D>
int CellGrid<D>::Axis::bin(double middle) const {
  const double place = std::floor((middle - origin) / width);
  if (!periodic) return static_cast<int>(std::clamp(place, 0.0, count - 1.0));
  const int rest = static_cast<int>(std::fmod(place, count));
  return rest < 0 ? rest + count : rest;
}

template <int D>
template <class Function>
void CellGrid<D>::for_around(const Axis& axis, int bin, Function function) {
  if (axis.count <= 3) {
    for (int k = 0; k < axis.count; ++k) function(k);
    return;
  }
  for (int k = bin - 1; k <= bin + 1; ++k)
    if (axis.periodic)
      function((k + axis.count) % axis.count);
    else if (k >= 0 && k < axis.count)
      function(k);
}

template <int D>
CellGrid<D>::CellGrid(const std::vector<BoundingBox<D>>& boxes, double reach, const Domain<D>& domain)
    : bin_(boxes.size(), -1) {
  const double far = std::numeric_limits<double>::infinity();
  // Room for rounding: a pair at exactly the reach must not fall between two bins.
  const double room = reach * (1 + 1e-9) + 1e-6;
  std::size_t bins = 1;
  for (int k = 0; k < D; ++k) {
    double least = far, most = -far, width = 0;
    for (const BoundingBox<D>& box : boxes) {
      if (!box.usable()) continue;
      const double place = middle(box.least[k], box.most[k]);
      least = std::min(least, place), most = std::max(most, place);
      width = std::max(width, box.most[k] - box.least[k]);
    }
    axes_[k] = make_axis(least, most, width + room, domain.period(k));
    bins *= static_cast<std::size_t>(axes_[k].count);
  }
  begin_.assign(bins + 1, 0);
  for (std::size_t c = 0; c < boxes.size(); ++c) {
    if (!boxes[c].usable()) continue;
    int bin = 0;
    for (int k = D - 1; k >= 0; --k)
      bin = bin * axes_[k].count + axes_[k].bin(middle(boxes[c].least[k], boxes[c].most[k]));
    bin_[c] = bin;
    ++begin_[static_cast<std::size_t>(bin) + 1];
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  cells_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t c = 0; c < boxes.size(); ++c)
    if (bin_[c] >= 0) cells_[next[bin_[c]]++] = static_cast<int>(c);
}

template <int D>
void CellGrid<D>::find(int cell, std::vector<int>& near) const {
  near.clear();
  if (bin_[cell] >= 0) append(D - 1, bin_[cell], 0, near);
}

template <int D>
void CellGrid<D>::append(int axis, int bin, int first, std::vector<int>& near) const {
  int below = 1;  // bins of one of this axis
  for (int k = 0; k < axis; ++k) below *= axes_[k].count;
  for_around(axes_[axis], bin / below, [&](int k) {
    const int at = first + k * below;
    if (axis > 0) return append(axis - 1, bin % below, at, near);
    near.insert(near.end(), cells_.begin() + begin_[at], cells_.begin() + begin_[at + 1]);
  });
}

template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace rouleau::core
