#include "indicator.hpp"

#include <algorithm>

#include "geometry.hpp"
#include "rounding.hpp"

namespace rouleau::host {

namespace {

/// Nodes may move this far before the next update; the marks allow for a whole spacing.
constexpr double displacement_limit = 0.1;

}  // namespace

template <class T>
Indicator<T>::Indicator(const Membranes& membranes, std::vector<double> viscosity_ratio, double relaxation_rate, int nx,
                        int ny, bool periodic_y)
    : ratio_(std::move(viscosity_ratio)),
      plain_rate_(relaxation_rate),
      nx_(nx),
      ny_(ny),
      periodic_y_(periodic_y),
      watch_(membranes, displacement_limit),
      coverage_(membranes.cells.size()),
      touched_(static_cast<std::size_t>(ny)) {
  for (const CellRange& cell : membranes.cells) varies_ |= ratio_[static_cast<std::size_t>(cell.type)] != 1;
}

template <class T>
int Indicator<T>::lattice_row(int y) const {
  if (periodic_y_) return wrapped(y, ny_);
  return y >= 0 && y < ny_ ? y : -1;
}

template <class T>
void Indicator<T>::update(Worker worker, const Membranes& membranes, Field<T>& relaxation_rate, Activity& activity) {
  if (!worker.first()) return;
  if (varies_) {
    if (!filled_) {
      if (!relaxation_rate.allocated()) relaxation_rate = Field<T>(nx_, ny_);
      for (int y = -Field<T>::halo; y < ny_ + Field<T>::halo; ++y) {
        T* row = relaxation_rate.row(y);
        std::fill(row - Field<T>::halo, row + nx_ + Field<T>::halo, static_cast<T>(plain_rate_));
      }
      filled_ = true;
    }
    set_rates(membranes, relaxation_rate);
  }
  activity.clear();
  for (std::size_t cell = 0; cell < membranes.cells.size(); ++cell) mark(membranes, cell, activity);
  activity.rebuild_runs();
  watch_.remember(Worker{}, membranes);
}

template <class T>
void Indicator<T>::set_rates(const Membranes& membranes, Field<T>& rate) {
  const T plain = static_cast<T>(plain_rate_);
  for_touched(rate, [&](T& value) { value = plain; });
  for (auto& intervals : touched_) intervals.clear();

  for (std::size_t c = 0; c < membranes.cells.size(); ++c) {
    if (ratio_[static_cast<std::size_t>(membranes.cells[c].type)] == 1) continue;
    cover(membranes, membranes.cells[c], coverage_[c]);
    smooth(coverage_[c], scratch_);
    touch(coverage_[c]);
  }
  // The field holds sum (ratio - 1) I until every cell has been added.
  for_touched(rate, [](T& value) { value = 0; });
  for (std::size_t c = 0; c < membranes.cells.size(); ++c) {
    const double excess = ratio_[static_cast<std::size_t>(membranes.cells[c].type)] - 1;
    if (excess != 0) add(coverage_[c], excess, rate);
  }
  const T outside = static_cast<T>(1 / plain_rate_ - 0.5);
  for_touched(rate, [=](T& value) { value = value == T(0) ? plain : T(1) / (T(0.5) + outside * (T(1) + value)); });
}

template <class T>
template <class Function>
void Indicator<T>::for_touched(Field<T>& field, Function function) const {
  for (int y = 0; y < ny_; ++y) {
    for (const Interval& interval : touched_[static_cast<std::size_t>(y)]) {
      T* row = field.row(y);
      for (int x = interval.begin; x < interval.end; ++x) function(row[x]);
    }
  }
}

template <class T>
void Indicator<T>::touch(const Coverage& coverage) {
  for (int j = 0; j < coverage.height; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const int y = lattice_row(coverage.y0 + j);
    const int width = std::min(coverage.end[at] - coverage.begin[at], nx_);
    if (y < 0 || width <= 0) continue;
    const int begin = wrapped(coverage.x0 + coverage.begin[at], nx_);
    const auto include = [&](Interval added) {
      // Intervals of a row stay disjoint, since what is done to them is not to be done twice.
      std::vector<Interval>& row = touched_[static_cast<std::size_t>(y)];
      for (std::size_t k = 0; k < row.size();) {
        if (row[k].end < added.begin || added.end < row[k].begin) {
          ++k;
          continue;
        }
        added = {std::min(added.begin, row[k].begin), std::max(added.end, row[k].end)};
        row[k] = row.back();
        row.pop_back();
      }
      row.push_back(added);
    };
    include({begin, std::min(begin + width, nx_)});
    if (begin + width > nx_) include({0, begin + width - nx_});
  }
}

template <class T>
void Indicator<T>::add(const Coverage& coverage, double excess, Field<T>& sum) const {
  for (int j = 0; j < coverage.height; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const int y = lattice_row(coverage.y0 + j);
    if (y < 0) continue;
    T* row = sum.row(y);
    for (int c = coverage.begin[at]; c < coverage.end[at];) {
      const int x = wrapped(coverage.x0 + c, nx_);
      const int count = std::min(coverage.end[at] - c, nx_ - x);
      const double* from = coverage.row(j) + c;
      for (int k = 0; k < count; ++k) row[x + k] += static_cast<T>(excess * from[k]);
      c += count;
    }
  }
}

// A node at (X, Y) reaches columns floor(X) - 1 ... floor(X) + 2 and the same rows; one more each for its motion.
template <class T>
void Indicator<T>::mark(const Membranes& membranes, std::size_t cell, Activity& activity) {
  const CellRange& range = membranes.cells[cell];
  const Bounds box = bounds(membranes, range);
  if (!box.usable()) return;
  const Coverage& coverage = coverage_[cell];  // empty if the cell's viscosity does not differ
  int first = floor_int(box.y_min) - 2, last = floor_int(box.y_max) + 3;
  if (coverage.height > 0) {
    first = std::min(first, coverage.y0);
    last = std::max(last, coverage.y0 + coverage.height - 1);
  }
  const auto rows = static_cast<std::size_t>(last - first + 1);
  const Interval none{1 << 30, -(1 << 30)};
  const auto include = [](Interval& to, int begin, int end) {
    to = {std::min(to.begin, begin), std::max(to.end, end)};
  };
  columns_.assign(rows, none);
  for (int i = range.first; i < range.end(); ++i) {
    const int x = floor_int(membranes.x[static_cast<std::size_t>(i)]);
    const int y = floor_int(membranes.y[static_cast<std::size_t>(i)]);
    include(columns_[static_cast<std::size_t>(y - first)], x - 2, x + 4);
  }
  reach_.assign(rows, none);
  for (int r = 0; r < static_cast<int>(rows); ++r) {
    for (int k = std::max(0, r - 3); k <= std::min(static_cast<int>(rows) - 1, r + 2); ++k) {
      include(reach_[static_cast<std::size_t>(r)], columns_[static_cast<std::size_t>(k)].begin,
              columns_[static_cast<std::size_t>(k)].end);
    }
  }
  for (int j = 0; j < coverage.height; ++j) {
    const auto at = static_cast<std::size_t>(j);
    if (coverage.begin[at] >= coverage.end[at]) continue;
    include(reach_[static_cast<std::size_t>(coverage.y0 + j - first)], coverage.x0 + coverage.begin[at],
            coverage.x0 + coverage.end[at]);
  }
  for (int r = 0; r < static_cast<int>(rows); ++r) {
    const Interval columns = reach_[static_cast<std::size_t>(r)];
    const int y = lattice_row(first + r);
    if (y >= 0 && columns.begin < columns.end) activity.mark(y, columns.begin, columns.end);
  }
}

template class Indicator<float>;
template class Indicator<double>;

}  // namespace rouleau::host
