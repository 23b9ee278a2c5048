#include "viscosity_field.hpp"

#include <algorithm>
#include <cmath>

#include "core/fluid/layers.hpp"
#include "core/membrane/geometry.hpp"
#include "core/membrane/rounding.hpp"
#include "disjoint.hpp"

namespace rouleau::core {

namespace {

/// Nodes may move this far before the next update; the marks allow for a whole spacing.
constexpr double displacement_limit = 0.1;

}  // namespace

template <class T>
ViscosityField<T>::ViscosityField(const Membranes& membranes, std::vector<double> viscosity_ratio, ViscosityMean mean,
                                  double reach_beyond, double relaxation_rate, const Domain<2>& domain,
                                  std::vector<double> viscosity_of_rows, bool smoothed)
    : ratio_(std::move(viscosity_ratio)),
      mean_(mean),
      smoothed_(smoothed),
      margin_(static_cast<int>(std::ceil(reach_beyond))),
      plain_rate_(relaxation_rate),
      viscosity_of_rows_(std::move(viscosity_of_rows)),
      domain_(domain),
      watch_(membranes),
      cells_(membranes.cells.size()),
      changed_(static_cast<std::size_t>(domain.block.size(1))) {
  for (const CellRange& cell : membranes.cells) varies_ |= differs(cell.type);
}

template <class T>
template <class Function>
void ViscosityField<T>::for_rows(const Rows& rows, Range own, Function function) const {
  for (std::size_t k = 0; k < rows.columns.size(); ++k) {
    const int row = domain_.wrapped(1, rows.first + static_cast<int>(k)), y = row - domain_.block.begin[1];
    if (row >= 0 && y >= own.begin && y < own.end) function(y, rows.columns[k], static_cast<int>(k));
  }
}

template <class T>
template <class Function>
void ViscosityField<T>::for_pieces(Interval columns, Function function) const {
  for (int begin = columns.begin; begin < columns.end;) {
    const int x = domain_.wrapped(0, begin);
    const int end = std::min(columns.end, begin + domain_.size[0] - x);
    const int first = std::max(x, domain_.block.begin[0]), last = std::min(x + end - begin, domain_.block.end[0]);
    if (first < last) function(first - domain_.block.begin[0], begin + first - x, begin + last - x);
    begin = end;
  }
}

template <class T>
void ViscosityField<T>::cover(Worker worker, const Membranes& membranes) {
  const CellNumbers cells = membranes.known_cells(worker);
  std::vector<double> scratch;
  for (const int c : cells) {
    if (!watch_.moved(c)) continue;
    const CellRange& cell = membranes.cells[c];
    Reach& reach = cells_[c];
    std::swap(reach.covered, reach.covered_before);
    reach.covered.columns.clear();
    if (differs(cell.type)) {
      AreaFraction& fraction = reach.fraction;
      core::cover(membranes, cell, fraction);
      if (smoothed_) smooth(fraction, scratch);
      reach.covered.first = fraction.y0;
      for (int j = 0; j < fraction.height; ++j) {
        const auto at = static_cast<std::size_t>(j);
        reach.covered.columns.push_back({fraction.x0 + fraction.begin[at], fraction.x0 + fraction.end[at]});
      }
    }
    find_reach(membranes, cell, reach);
    watch_.remember(c, membranes, displacement_limit);
  }
}

// A node at (X, Y) reaches columns floor(X) - 1 ... floor(X) + 2 and the same rows; one more each for its motion, and
// the margin.
template <class T>
void ViscosityField<T>::find_reach(const Membranes& membranes, const CellRange& cell, Reach& reach) const {
  Rows& reached = reach.reached;
  reached.columns.clear();
  const BoundingBox<2> box = box_of<2>(membranes, cell);
  if (!box.usable()) return;
  const Rows& covered = reach.covered;
  int first = core::floor_int(box.least[1]) - 2 - margin_, last = core::floor_int(box.most[1]) + 3 + margin_;
  if (!covered.columns.empty()) {
    first = std::min(first, covered.first);
    last = std::max(last, covered.first + static_cast<int>(covered.columns.size()) - 1);
  }
  const auto rows = static_cast<std::size_t>(last - first + 1);
  const Interval none{1 << 30, -(1 << 30)};
  const auto include = [](Interval& to, int begin, int end) {
    to = {std::min(to.begin, begin), std::max(to.end, end)};
  };
  std::vector<Interval> columns(rows, none);  // of the nodes between this row and the next
  for (int i = cell.first; i < cell.end(); ++i) {
    const int x = core::floor_int(membranes.position[0][i]);
    const int y = core::floor_int(membranes.position[1][i]);
    include(columns[y - first], x - 2 - margin_, x + 4 + margin_);
  }
  reached.first = first;
  reached.columns.assign(rows, none);
  for (int r = 0; r < static_cast<int>(rows); ++r) {
    Interval& to = reached.columns[r];
    for (int k = std::max(0, r - 3 - margin_); k <= std::min(static_cast<int>(rows) - 1, r + 2 + margin_); ++k) {
      include(to, columns[k].begin, columns[k].end);
    }
  }
  for (std::size_t j = 0; j < covered.columns.size(); ++j) {
    const Interval& added = covered.columns[j];
    if (added.begin >= added.end) continue;
    include(reached.columns[static_cast<std::size_t>(covered.first - first) + j], added.begin, added.end);
  }
}

template <class T>
void ViscosityField<T>::update(Worker worker, const Membranes& membranes, Field<T, 2>& relaxation_rate,
                               NodeMask& mask) {
  const Range own = worker.share(domain_.block.size(1));
  if (varies_) {
    collect_changes(membranes, own);
    set_rates(membranes, own, relaxation_rate);
  }
  mask.clear(own.begin, own.end);
  for (const int c : membranes.known_cells()) {
    if (!membranes.reaches(c)) continue;
    const Reach& reach = cells_[c];
    for_rows(reach.reached, own, [&](int y, Interval columns, int) { mask.mark(y, columns.begin, columns.end); });
  }
}

template <class T>
void ViscosityField<T>::restore(DisplacementWatch::Memory memory, Membranes& membranes, Field<T, 2>& relaxation_rate,
                                NodeMask& mask) {
  watch_.recall(std::move(memory), membranes, [&] {
    cover(Worker{}, membranes);
    update(Worker{}, membranes, relaxation_rate, mask);
  });
}

template <class T>
void ViscosityField<T>::collect_changes(const Membranes& membranes, Range own) {
  for (int y = own.begin; y < own.end; ++y) changed_[y].clear();
  const auto include = [&](int y, Interval columns, int) {
    columns.end = std::min(columns.end, columns.begin + domain_.size[0]);
    for_pieces(columns, [&](int x, int begin, int end) {
      // Intervals of a row stay disjoint, since what is done to them is not to be done twice.
      add_disjoint(changed_[y], {x, x + end - begin});
    });
  };
  for (const int c : membranes.known_cells()) {
    if (!watch_.moved(c)) continue;
    for_rows(cells_[c].covered_before, own, include);
    for_rows(cells_[c].covered, own, include);
  }
}

template <class T>
void ViscosityField<T>::set_rates(const Membranes& membranes, Range own, Field<T, 2>& rate) {
  const bool harmonic = mean_ == ViscosityMean::harmonic;
  const auto averaged = [=](double viscosity) { return harmonic ? 1 / viscosity : viscosity; };
  // The field holds the sum over cells of (mu_inside - mu_row) I, or that of 1/mu, until every cell has been added.
  for (int y = own.begin; y < own.end; ++y) {
    for (const Interval& interval : changed_[y])
      std::fill(rate.row(y) + interval.begin, rate.row(y) + interval.end, T(0));
  }
  for (const int c : membranes.known_cells()) {
    const int type = membranes.cells[c].type;
    if (!differs(type) || !membranes.reaches(c)) continue;
    const double inside = averaged(ratio_[type]);
    const AreaFraction& fraction = cells_[c].fraction;
    for_rows(cells_[c].covered, own, [&](int y, Interval columns, int place) {
      if (changed_[y].empty()) return;
      const double excess = inside - averaged(viscosity_of_row(y));
      const double* from = fraction.row(place);
      T* row = rate.row(y);
      for_pieces(columns, [&](int x, int begin, int end) {
        for (const Interval& interval : changed_[y]) {
          const int first = std::max(x, interval.begin), last = std::min(x + end - begin, interval.end);
          const double* value = from + (begin - fraction.x0) - x;
          for (int k = first; k < last; ++k) row[k] += static_cast<T>(excess * value[k]);
        }
      });
    });
  }
  const T outside = static_cast<T>(1 / plain_rate_ - 0.5);
  for (int y = own.begin; y < own.end; ++y) {
    const double viscosity = viscosity_of_row(y);
    const T plain = static_cast<T>(rate_of_layer(plain_rate_, viscosity)), of_row = static_cast<T>(averaged(viscosity));
    T* row = rate.row(y);
    for (const Interval& interval : changed_[y]) {
      for (int x = interval.begin; x < interval.end; ++x) {
        if (row[x] == T(0)) {
          row[x] = plain;
        } else {
          row[x] = T(1) / (T(0.5) + (harmonic ? outside / (of_row + row[x]) : outside * (of_row + row[x])));
        }
      }
    }
  }
}

template class ViscosityField<float>;
template class ViscosityField<double>;

}  // namespace rouleau::core
